// Programs of the system that make pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace reeb::tools {

struct ChildProgram {
  const char* name;
  const char* package;  // of Debian
};
inline constexpr ChildProgram kGnuplot{"gnuplot", "gnuplot-nox"}, kDot{"dot", "graphviz"},
    kRsvgConvert{"rsvg-convert", "librsvg2-bin"};

// Its path, by PATH. THROWS: Error{kResource} that names the package, if it is not there.
std::string find_program(const ChildProgram& program);

// Runs it with `input` as its standard input, and returns its standard output. No shell is involved, and input and
// output are files without a name in `temp_folder`. A signal that ends this process ends it, too.
// THROWS: Error{kResource} with what the program said, if it fails or writes nothing.
std::string run_program(const ChildProgram& program, const std::vector<std::string>& arguments, std::string_view input,
                        const std::string& temp_folder);

}  // namespace reeb::tools
