// `reeb fragment MESH --part K/N`: the graph of one part of a mesh, to be glued.
#include <fmt/core.h>

#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "tools/library/fragment.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/signals.h"
#include "tools/program/wrapping.h"
#include "tools/runs/fragment_commands.h"
#include "tools/runs/run_options.h"

namespace reeb::tools {
namespace {

struct FragmentArguments : RunArguments {
  std::string part, output;
  std::vector<std::string> shared;
  bool scan = false;
};

// THROWS: Error{kUsage}.
ooc::PartChoice parse_part(const std::string& text) {
  constexpr std::uint32_t kMostParts = 1000000;
  std::uint32_t part = 0, parts = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_part] = std::from_chars(text.data(), end, part);
  bool is_part = bad_part == std::errc() && slash != end && *slash == '/';
  if (is_part) {
    const auto [rest, bad_parts] = std::from_chars(slash + 1, end, parts);
    is_part = bad_parts == std::errc() && rest == end;
  }
  if (!is_part || part < 1 || part > parts || parts > kMostParts)
    throw Error(ErrorKind::kUsage, "--part " + text + ": --part needs K/N with 1 <= K <= N",
                "for instance --part 2/3, the second of three; there can be up to 1000000 parts");
  return {.part = part - 1, .parts = parts, .shared = {}};
}

std::vector<std::string> outputs_of(const FragmentArguments& arguments, const ooc::PartChoice& choice) {
  const std::string suffix = arguments.scan ? ".names" : ".fragment";
  std::string output = arguments.output;
  if (output.empty())
    output = stem_of(arguments.mesh) + "-" + std::to_string(choice.part + 1) + "-of-" + std::to_string(choice.parts) +
             suffix;
  if (arguments.scan) return {output};
  return output_names(output, arguments.functions, suffix);
}

void print_fragment(const ooc::FragmentResult& r, const ooc::PartChoice& choice) {
  const ooc::Shares& shares = r.info.mesh.shares;
  print_line(printable(fmt::format("part {} of {}, f = {}: {}", choice.part + 1, choice.parts, r.info.function,
                                   count_of(shares.end(choice.part) - shares.begin(choice.part), "triangle"))));
  print_line(fmt::format("  {} and {} have settled; {} open", count_of(r.info.settled_nodes, "node"),
                         count_of(r.info.settled_arcs, "arc"), count_of(r.open_vertices, "vertex")));
  for (const std::string& note : r.notes) print_line("  note: " + printable(note));
  print_line(fmt::format("  {:.2f} s", r.seconds.wall));
  if (!io::is_device(r.output)) print_line("  wrote " + printable(r.output));
}

void run_fragment(FragmentArguments arguments) {
  ComputeOptions& options = arguments.options;
  ooc::PartChoice choice = parse_part(arguments.part);
  choice.shared = arguments.shared;
  if (arguments.functions.empty()) arguments.functions.emplace_back();
  if (arguments.scan && !choice.shared.empty())
    throw Error(ErrorKind::kUsage, "--scan and --shared exclude each other",
                "make the names of all parts with --scan, then each fragment with --shared");
  check_functions(arguments.functions);
  const std::vector<std::string> outputs = outputs_of(arguments, choice);
  if (!arguments.quiet)
    for (const std::string& output : outputs)
      note_other_suffix(output, {arguments.scan ? ".names" : ".fragment"},
                        arguments.scan ? "a file of names" : "a fragment");
  take_denoise(arguments);
  options.opened = [&](const MeshInfo& info) {
    if (!arguments.quiet) print_line(printable(arguments.mesh + ": " + describe(info)));
  };
  ProgressBar bar(arguments.quiet);
  options.progress = [&](const ComputeProgress& p) { bar.update(pass_of(p.phase), p.done, p.total, p.triangles); };
  if (io::is_regular_file(arguments.mesh)) options.interrupted = watch_signals();
  if (arguments.scan) {
    const std::uint64_t names = scan_names(arguments.mesh, outputs[0], options, choice);
    bar.clear();
    if (!arguments.quiet)
      print_line(printable(fmt::format("part {} of {} names {}; wrote {}", choice.part + 1, choice.parts,
                                       count_of(names, "vertex"), outputs[0])));
    return;
  }
  const auto results = compute_fragments(arguments.mesh, arguments.functions, outputs, options, choice);
  bar.clear();
  if (!arguments.quiet)
    for (const ooc::FragmentResult& result : results) print_fragment(result, choice);
}

}  // namespace

void add_fragment(Program& program) {
  auto arguments = std::make_shared<FragmentArguments>();
  Command command = program.add_command("fragment", "Compute a part of a mesh, for `reeb glue`");
  command.add_option("MESH", arguments->mesh, "Mesh or image of any format, also as .gz and .zst")
      .required()
      .type_name("");
  command.add_option("--part", arguments->part, "The K-th of N parts with the same number of triangles, from 1")
      .required()
      .type_name("K/N");
  command
      .add_option("-o,--output", arguments->output,
                  "File to write; with several functions OUT-FUNC.fragment (default: the name of the mesh with "
                  "-K-of-N.fragment, in the current folder)")
      .type_name("FILE");
  command.add_flag("--scan", arguments->scan, "Write only which vertices the part names (default name: -K-of-N.names)");
  command
      .add_option("--shared", arguments->shared,
                  "Files that --scan wrote, of all parts, so that the whole mesh need not be read")
      .type_name("FILE");
  add_run_options(command, *arguments);
  refuse_whole_mesh_options(command);
  command.refuse_option("--report", "there is no report of a fragment",
                        "`reeb info` describes fragments, and `reeb glue --report` the graph");
  command.footer("Example:\n  reeb fragment scan.ply --part 1/2 -o p1.fragment");
  command.callback([arguments] { run_fragment(*arguments); });
}

}  // namespace reeb::tools
