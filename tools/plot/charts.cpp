#include "tools/plot/charts.h"

#include <algorithm>
#include <vector>

#include "io/plot/diagram_chart.h"
#include "io/plot/dot_layout.h"
#include "io/plot/gnuplot_text.h"
#include "io/plot/graph_picture.h"
#include "io/plot/loop_chart.h"
#include "libreeb/base/count_text.h"
#include "tools/plot/child_program.h"

namespace reeb::tools {
namespace {

std::string run_gnuplot(const io::Heading& heading, const std::string& commands, const std::string& temp_folder) {
  return io::with_heading(run_program(kGnuplot, {"-d", "-"}, commands, temp_folder), heading);
}

struct LoopsOfFile {
  io::LoopSeries series;
  std::uint64_t loops = 0;
  std::string level;
};

std::string name_and_function(const ooc::ReebFile& file) {
  return graph_name(file) + ", f = " + file.header().function;
}

LoopsOfFile loops_of(const ooc::ReebFile& file, const LevelChoice& choice) {
  LoopsOfFile result;
  const ChosenLevel level = choose_level(file, choice);
  result.level = level.text;
  const double low = file.header().function_min / 2, range = file.header().function_max / 2 - low;
  for_each_pair_of(file, level.version, [&](const ooc::PairKeys& pair) {
    if (pair.type != PairType::kExt1) return;
    ++result.loops;
    const double persistence = pair.hi.value / 2 - pair.lo.value / 2;
    if (persistence > 0 && range > 0) result.series.percents.push_back(std::min(100 * (persistence / range), 100.0));
  });
  std::sort(result.series.percents.begin(), result.series.percents.end());
  return result;
}

// Why a picture of loops has no curve, if its level has this many loops.
std::string why_no_loops(std::span<const ooc::ReebFile> files, std::uint64_t loops, const LevelChoice& choice) {
  std::uint64_t nodes = 0, all = 0;
  for (const ooc::ReebFile& file : files) {
    nodes += file.header().nodes;
    all += file.header().loops;
  }
  if (nodes == 0) return "The graph is empty.";
  if (loops != 0) return "All loops have the persistence 0.";
  if (all == 0) return "There are no loops.";
  const std::string which = all == 1 ? "The only loop is" : "All " + count_of(all, "loop") + " are";
  return which + (choice.threshold.empty() ? " in finer levels." : " below the threshold.");
}

}  // namespace

std::string counts_text(const ReebGraph& graph) {
  const BettiNumbers betti = betti_numbers(graph);
  return count_of(graph.node_count(), "node") + ", " + count_of(graph.arc_count(), "arc") + ", " +
         count_of(betti.components, "component") + ", " + count_of(betti.loops, "loop");
}

std::string draw_loops(std::span<const ooc::ReebFile> files, const LevelChoice& choice,
                       const std::string& temp_folder) {
  find_program(kGnuplot);
  std::vector<io::LoopSeries> series;
  io::Heading heading;
  std::uint64_t loops = 0, shown = 0;
  std::vector<LoopsOfFile> all;
  for (const ooc::ReebFile& file : files) all.push_back(loops_of(file, choice));
  const bool same_level = std::ranges::all_of(all, [&](const LoopsOfFile& one) { return one.level == all[0].level; });
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ooc::ReebFile& file = files[i];
    LoopsOfFile& one = all[i];
    loops += one.loops;
    shown += one.series.percents.size();
    heading.subtitle = one.level + (files.size() > 1 ? "" : ", " + count_of(one.loops, "loop"));
    // Files of the same name are in different folders.
    const bool is_known = std::ranges::count(files, name_and_function(file), name_and_function) == 1;
    one.series.name = (is_known ? name_and_function(file) : file.path() + ", f = " + file.header().function) + ": " +
                      count_of(one.loops, "loop") + (same_level ? "" : ", " + one.level);
    series.push_back(std::move(one.series));
  }
  heading.title = files.size() > 1
                      ? "Loops above a persistence"
                      : graph_name(files[0]) + ", f = " + files[0].header().function + ": loops above a persistence";
  if (files.size() > 1)
    heading.subtitle = count_of(files.size(), "graph") + (same_level ? ", " + heading.subtitle + " of each" : "");
  if (shown == 0) return message_picture(heading, why_no_loops(files, loops, choice));
  if (shown != loops) heading.subtitle += "; without " + count_of(loops - shown, "loop") + " of persistence 0";
  return run_gnuplot(heading, io::loop_chart(series), temp_folder);
}

std::string draw_diagram(const ooc::ReebFile& file, const LevelChoice& choice, const std::string& temp_folder) {
  find_program(kGnuplot);
  const ChosenLevel level = choose_level(file, choice);
  const FileHeader& header = file.header();
  io::DiagramPoints points(header.pairs, header.function_min, header.function_max);
  std::uint64_t pairs = 0;
  for_each_pair_of(file, level.version, [&](const ooc::PairKeys& pair) {
    points.add(pair.type, pair.lo.value, pair.hi.value);
    ++pairs;
  });
  points.finish();
  io::Heading heading{graph_name(file) + ", f = " + header.function + ": persistence diagram",
                      level.text + ", " + count_of(pairs, "pair")};
  if (points.is_thinned()) heading.subtitle += "; of points that lie together one is drawn";
  if (pairs == 0) return message_picture(heading, "The graph is empty.");
  return run_gnuplot(heading, io::diagram_chart(header.function, points), temp_folder);
}

std::string draw_graph(const ooc::ReebFile& file, const LevelChoice& choice, const std::string& temp_folder) {
  const FileHeader& header = file.header();
  const bool is_too_large = choice.threshold.empty() && !choice.nodes && header.nodes > kMostNodesUnasked &&
                            !header.flags.graph_only && header.levels.front().nodes <= kMostNodesUnasked;
  const ChosenLevel level = choose_level(file, is_too_large ? LevelChoice{{}, kMostNodesUnasked} : choice);
  const ReebGraph graph = file.load_graph(level.version);
  const io::Heading heading{graph_name(file) + ", f = " + file.header().function + ": Reeb graph",
                            level.text + ", " + counts_text(graph)};
  if (graph.node_count() > kMostNodesOfDot)
    return graph_picture(graph, io::layered_layout(graph), file.header().function, heading);
  find_program(kDot);
  if (graph.nodes.empty()) return message_picture(heading, "The graph is empty.");
  const std::string plain = run_program(kDot, {"-Tplain"}, io::dot_text(graph), temp_folder);
  const auto layout = io::read_dot_layout(graph, plain);
  return graph_picture(graph, layout ? *layout : io::layered_layout(graph), file.header().function, heading);
}

}  // namespace reeb::tools
