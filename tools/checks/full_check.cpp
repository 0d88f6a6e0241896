#include "tools/checks/full_check.h"

#include <fmt/core.h>

#include <algorithm>

#include "libreeb/base/error.h"
#include "tools/library/compute.h"
#include "tools/library/temp_folder.h"

namespace reeb::tools {
namespace {

[[noreturn]] void fail(const ooc::ReebFile& file, const std::string& what) {
  throw Error(ErrorKind::kBadInput, what, "name the mesh that the file was computed from, or compute the file again")
      .at(file.path());
}

std::string describe(const SweepKey& node) {
  return fmt::format("vertex {} with the value {:.17g}", node.vertex.value(), node.value);
}

// Compares item i of both lists for every i, then the counts.
template <class Describe>
void compare_lists(const ooc::ReebFile& file, const char* item, std::size_t in_file, std::size_t in_mesh,
                   const Describe& describe_item) {
  for (std::size_t i = 0; i < std::min(in_file, in_mesh); ++i) {
    const auto [of_file, of_mesh] = describe_item(i);
    if (of_file != of_mesh)
      fail(file, fmt::format("{} {} is {}, but {} in the graph of the mesh", item, i, of_file, of_mesh));
  }
  if (in_file != in_mesh)
    fail(file, fmt::format("there are {} {}s, but {} in the graph of the mesh", in_file, item, in_mesh));
}

void compare_graphs(const ooc::ReebFile& file, const ooc::ReebFile& again) {
  const ReebGraph a = file.load(0).graph, b = again.load(0).graph;
  // Texts are made only where something differs.
  const auto texts = [](bool differ, const auto& left, const auto& right) {
    return differ ? std::pair(left(), right()) : std::pair<std::string, std::string>();
  };
  compare_lists(file, "node", a.node_count(), b.node_count(), [&](std::size_t i) {
    return texts(
        a.nodes[i] != b.nodes[i], [&] { return describe(a.nodes[i]); }, [&] { return describe(b.nodes[i]); });
  });
  const auto ends = [](const ReebGraph& graph, std::size_t i) {
    return fmt::format("from vertex {} to vertex {}", graph.nodes[graph.lo[i].value()].vertex.value(),
                       graph.nodes[graph.hi[i].value()].vertex.value());
  };
  compare_lists(file, "arc", a.arc_count(), b.arc_count(), [&](std::size_t i) {
    return texts(
        a.lo[i] != b.lo[i] || a.hi[i] != b.hi[i], [&] { return ends(a, i); }, [&] { return ends(b, i); });
  });
}

void compare_pairs(const ooc::ReebFile& file, const ooc::ReebFile& again) {
  const auto a = file.pairs(), b = again.pairs();
  const auto text = [](const ooc::PairRow& pair) {
    return fmt::format("{} of vertex {} and vertex {}{}", name_of(pair.type), pair.lo.key.vertex.value(),
                       pair.hi.key.vertex.value(), pair.kept ? ", kept" : "");
  };
  compare_lists(file, "pair", a.size(), b.size(), [&](std::size_t i) {
    const bool same =
        a[i].type == b[i].type && a[i].kept == b[i].kept && a[i].lo.key == b[i].lo.key && a[i].hi.key == b[i].hi.key;
    return same ? std::pair<std::string, std::string>() : std::pair(text(a[i]), text(b[i]));
  });
}

}  // namespace

void check_fully(const ooc::ReebFile& file, const FullCheckOptions& options) {
  const FileHeader& header = file.header();
  const TempFolder folder(options.temp_folder);
  const std::string output = folder.path() + "/again.reeb";
  ComputeOptions run;
  run.memory_bytes = options.memory_bytes;
  run.threads = options.threads;
  run.format = options.format;
  run.image = options.image;
  run.temp_dir = folder.path();
  run.graph_only = header.flags.graph_only;
  run.buckets = 0;
  run.denoise = header.denoise_threshold;
  run.keeps_checkpoints = false;
  run.interrupted = options.interrupted;
  compute(options.mesh, header.function, output, run);
  const ooc::ReebFile again(output);
  compare_graphs(file, again);
  if (!header.flags.graph_only) compare_pairs(file, again);
}

}  // namespace reeb::tools
