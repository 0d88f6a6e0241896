// The files that a command reads and writes, checked before any work: nothing that is read is overwritten, no two
// outputs are one file, and every output can be written.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_spec.h"
#include "tools/library/compute.h"

namespace reeb {

// Two names are one file if they lead to the same file, by whatever links or paths; or, as long as there is no file, to
// the same name in the same folder. "-" is standard input or standard output.
class RunFiles {
 public:
  // `what` is part of messages: "the mesh".
  void add_input(std::string path, std::string what);
  // The mesh or image, and the files that are read with it (io::files_beside).
  // THROWS: Error of a mesh that cannot be opened.
  void add_mesh(const std::string& path, const std::string& format, const io::ImageOptions& image);
  // The file of values of this function, if it has one.
  void add_values_of(const io::FunctionSpec& function);
  // `how` says in hints how to choose another folder for it.
  void add_output(std::string path, std::string what, io::Existing existing, const char* how = "with -o FILE");
  // What is printed: nothing is overwritten by it, but a file that standard output is appended to grows.
  void add_standard_output(std::string what = "the output");
  // Files STEM-000001.reeb, STEM-000002.reeb and so on, of any number.
  void add_snapshots(const std::string& stem, io::Existing existing);
  // Outputs of any number in one folder: those whose names, without the folder, `has_name` knows. Whether the folder
  // can be written is not checked.
  struct Series {
    std::string folder, what;
    std::function<bool(std::string_view name)> has_name;
    io::Existing existing = io::Existing::kReplace;
  };
  void add_series(Series series);
  // Why an output is not replaced, for its hint.
  void explain_existing(std::string why) { why_existing_ = std::move(why); }

  // THROWS: Error{kBadInput} for an output that is an input or another output, whatever may be replaced, and for one
  //         that exists and may not be replaced; Error{kResource} for one that cannot be written.
  void check() const;

 private:
  struct File {
    std::string path, what;
    // Of an output:
    io::Existing existing = io::Existing::kReplace;
    const char* how = "with -o FILE";
  };

  std::vector<File> outputs() const;
  void check_names_of_series() const;

  std::vector<File> inputs_, outputs_;
  std::vector<Series> series_;
  std::vector<std::string> first_snapshots_;
  std::string why_existing_;
};

// THROWS: Error{kUsage} unless there is at least one function, and an output for each.
void require_an_output_each(std::span<const std::string> functions, std::span<const std::string> outputs);

// The files of a run of compute(), without a report.
// THROWS: Error{kBadInput} if the mesh is a Reeb graph; Error{kUsage} for snapshots beside a device; as
//         RunFiles::add_mesh().
RunFiles files_of_run(const std::string& mesh, std::span<const io::FunctionSpec> functions,
                      std::span<const std::string> outputs, const ComputeOptions& options);

// THROWS: Error{kUsage} if the output is standard output or a device: nothing can be written beside it.
void require_room_for_several(const std::string& output);

// The output without ".reeb".
std::string snapshot_stem(const std::string& output);
// The name of a snapshot; numbers have at least six digits.
std::string snapshot_name(const std::string& stem, std::uint64_t number);
// The numbers of the snapshots of this stem that exist, ascending.
std::vector<std::uint64_t> existing_snapshots(const std::string& stem);

}  // namespace reeb
