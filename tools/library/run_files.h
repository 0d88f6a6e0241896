// The files that a command reads and writes, checked before any work: nothing that is read is overwritten, no two
// outputs are one file, and every output can be written.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/functions/function_source.h"
#include "tools/library/compute.h"

namespace reeb {

// Two names are one file if they lead to the same file, by whatever links or paths; or, as long as there is no file, to
// the same name in the same folder. "-" is standard input or standard output.
class RunFiles {
 public:
  // `what` is part of messages: "the mesh".
  void add_input(std::string path, std::string what);
  void add_output(std::string path, std::string what, io::Existing existing);
  // Files STEM-000001.reeb, STEM-000002.reeb and so on, of any number.
  void add_snapshots(std::string stem, io::Existing existing);

  // THROWS: Error{kBadInput} for an output that is an input or another output, whatever may be replaced, and for one
  //         that exists and may not be replaced; Error{kResource} for one that cannot be written.
  void check() const;

 private:
  struct File {
    std::string path, what;
    io::Existing existing = io::Existing::kReplace;  // of an output
  };

  std::vector<File> outputs() const;
  void check_snapshot_names() const;

  std::vector<File> inputs_, outputs_, snapshots_;  // of the last: stems
};

// THROWS: Error{kUsage} unless there is at least one function, and an output for each.
void require_an_output_each(std::span<const std::string> functions, std::span<const std::string> outputs);

// The files of a run of compute(), without a report. THROWS: Error{kBadInput} if the mesh is a Reeb graph.
RunFiles files_of_run(const std::string& mesh, std::span<const io::FunctionSpec> functions,
                      std::span<const std::string> outputs, const ComputeOptions& options);

// The output without ".reeb".
std::string snapshot_stem(const std::string& output);
// The name of a snapshot; numbers have at least six digits.
std::string snapshot_name(const std::string& stem, std::uint64_t number);
// The numbers of the snapshots of this stem that exist, ascending.
std::vector<std::uint64_t> existing_snapshots(const std::string& stem);

}  // namespace reeb
