#include "io/export/swc_samples.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/export/line_points.h"
#include "libreeb/base/printable.h"

namespace reeb::io {
namespace {

// The arcs at each node: those of node n are arcs[first[n]] .. arcs[first[n + 1] - 1].
struct ArcsAtNodes {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> arcs;
};

ArcsAtNodes arcs_at_nodes(const ReebGraph& graph) {
  ArcsAtNodes at{std::vector<std::size_t>(graph.node_count() + 1), std::vector<std::uint32_t>(2 * graph.arc_count())};
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    ++at.first[graph.lo[arc].value()];
    ++at.first[graph.hi[arc].value()];
  }
  std::size_t sum = 0;
  for (std::size_t& first : at.first) first = sum += first;
  for (std::size_t arc = graph.arc_count(); arc-- > 0;)
    for (const NodeId node : {graph.lo[arc], graph.hi[arc]})
      at.arcs[--at.first[node.value()]] = static_cast<std::uint32_t>(arc);
  return at;
}

// The number of the first point of each arc between its nodes.
std::vector<std::uint64_t> first_inner_points(const GraphView& view) {
  std::vector<std::uint64_t> first(view.graph.arc_count());
  std::uint64_t next = view.graph.node_count();
  for (std::size_t arc = 0; arc < first.size(); ++arc) {
    first[arc] = next;
    next += inner_points(view, arc);
  }
  return first;
}

class SwcWriter {
 public:
  SwcWriter(const GraphView& view, OutputBuffer& out)
      : view_(view),
        out_(out),
        radii_(all_radii(view)),
        at_(arcs_at_nodes(view.graph)),
        first_inner_(first_inner_points(view)),
        sample_(view.graph.node_count()),
        done_(view.graph.arc_count()) {}

  void write() {
    for (std::size_t node = 0; node < sample_.size(); ++node)
      if (sample_[node] == 0) write_tree(node);
  }

 private:
  void write_tree(std::size_t root) {
    sample_[root] = write_node(root, -1);
    std::vector<std::size_t> open{root};
    while (!open.empty()) {
      const std::size_t node = open.back();
      open.pop_back();
      for (std::size_t i = at_.first[node]; i < at_.first[node + 1]; ++i) {
        const std::uint32_t arc = at_.arcs[i];
        if (done_[arc]) continue;
        done_[arc] = true;
        const std::size_t other = write_arc(arc, node);
        if (sample_[other] != 0) {
          write_node(other, last_);
          continue;
        }
        sample_[other] = write_node(other, last_);
        open.push_back(other);
      }
    }
  }

  // Writes the points from this node of the arc to the other node, which it returns.
  std::size_t write_arc(std::uint32_t arc, std::size_t from) {
    const std::size_t lo = view_.graph.lo[arc].value(), hi = view_.graph.hi[arc].value();
    line_.clear();
    if (!view_.buckets.empty()) draw_arc(view_, arc, line_);
    last_ = sample_[from];
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const std::size_t at = from == lo ? i : line_.size() - 1 - i;
      last_ = write_sample(line_[at], radii_[first_inner_[arc] + at], last_);
    }
    return from == lo ? hi : lo;
  }

  std::int64_t write_node(std::size_t node, std::int64_t parent) {
    return write_sample(node_position(view_.graph, node), radii_[node], parent);
  }

  std::int64_t write_sample(const std::array<double, 3>& point, double radius, std::int64_t parent) {
    out_ << ++samples_ << " 0 " << Shortest{point[0]} << ' ' << Shortest{point[1]} << ' ' << Shortest{point[2]} << ' '
         << Shortest{radius} << ' ' << parent << '\n';
    return samples_;
  }

  const GraphView& view_;
  OutputBuffer& out_;
  std::vector<double> radii_;  // of all points
  ArcsAtNodes at_;
  std::vector<std::uint64_t> first_inner_;
  std::vector<std::int64_t> sample_;  // of each node; 0: none yet
  std::vector<bool> done_;            // arcs
  std::vector<std::array<double, 3>> line_;
  std::int64_t samples_ = 0, last_ = -1;
};

}  // namespace

void write_swc(const GraphView& view, OutputBuffer& out) {
  out << "# the Reeb graph of " << printable(view.function) << "\n# id type x y z radius parent\n";
  SwcWriter(view, out).write();
}

}  // namespace reeb::io
