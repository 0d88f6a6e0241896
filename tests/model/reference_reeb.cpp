#include "tests/model/reference_reeb.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "tests/support/inputs/partition.h"

namespace reeb::test {
namespace {

// The 2-skeleton in terms of ranks: the vertices in the total order are 0, 1, 2, ..., and the function is the rank.
// Corners ascend.
struct RankedComplex {
  std::size_t vertex_count = 0;
  std::vector<std::array<std::size_t, 2>> edges;
  std::vector<std::array<std::size_t, 3>> triangles;  // as numbers of vertices
};

RankedComplex rank_vertices(const Complex& complex, const std::vector<std::uint64_t>& order) {
  std::vector<std::size_t> rank(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = r;
  RankedComplex ranked;
  ranked.vertex_count = order.size();
  const Skeleton skeleton = two_skeleton(complex);
  for (const auto& [a, b] : skeleton.edges)
    ranked.edges.push_back({std::min(rank[a], rank[b]), std::max(rank[a], rank[b])});
  for (const auto& [a, b, c] : skeleton.triangles) {
    std::array<std::size_t, 3> corners{rank[a], rank[b], rank[c]};
    std::sort(corners.begin(), corners.end());
    ranked.triangles.push_back(corners);
  }
  std::sort(ranked.edges.begin(), ranked.edges.end());
  return ranked;
}

// One level set, at height h / 2: for even h the level of vertex h / 2, for odd h a level between two vertices. Its
// points are the edges that cross the level, and the vertex on it. A triangle that crosses the level joins the two
// points where its boundary crosses it.
class LevelSet {
 public:
  LevelSet(const RankedComplex& complex, std::size_t height)
      : complex_(&complex), height_(height), sets_(complex.edges.size() + 1) {
    for (const auto& [a, b, c] : complex.triangles) {
      if (!crosses(a, c)) continue;
      const std::size_t opposite = point_of_edge(a, c);
      if (2 * b == height) sets_.unite(opposite, vertex_point());
      if (crosses(a, b)) sets_.unite(opposite, point_of_edge(a, b));
      if (crosses(b, c)) sets_.unite(opposite, point_of_edge(b, c));
    }
  }

  bool crosses(std::size_t a, std::size_t b) const { return 2 * a < height_ && height_ < 2 * b; }
  bool crosses(std::size_t edge) const { return crosses(complex_->edges[edge][0], complex_->edges[edge][1]); }
  std::size_t component_of_edge(std::size_t edge) { return sets_.find(edge); }
  // REQUIRES: the level of a vertex.
  std::size_t component_of_vertex() { return sets_.find(vertex_point()); }

 private:
  std::size_t vertex_point() const { return complex_->edges.size(); }
  std::size_t point_of_edge(std::size_t a, std::size_t b) const {
    const std::array<std::size_t, 2> edge{a, b};
    return static_cast<std::size_t>(std::lower_bound(complex_->edges.begin(), complex_->edges.end(), edge) -
                                    complex_->edges.begin());
  }

  const RankedComplex* complex_;
  std::size_t height_;
  Partition sets_;
};

// A contour at the level of a vertex: a point of the quotient.
struct Contour {
  std::optional<std::size_t> vertex;  // the rank of the vertex on it
  std::vector<std::size_t> down, up;  // the contours to which it is joined, one level below and one level above
  std::vector<std::size_t> strips;    // that lead up, by number
  bool regular() const { return down.size() == 1 && up.size() == 1; }
};

// The quotient, still with its (1, 1) points: contours at the levels of vertices are its points, contours between two
// such levels its segments.
class Quotient {
 public:
  explicit Quotient(const RankedComplex& complex) : complex_(complex) {
    if (complex.vertex_count == 0) return;
    LevelSet below(complex, 0);
    number_contours(below, 0);
    for (std::size_t r = 0; r + 1 < complex.vertex_count; ++r) {
      LevelSet between(complex, 2 * r + 1), above(complex, 2 * r + 2);
      number_contours(above, r + 1);
      join(below, between, above, r);
      below = std::move(above);
    }
  }

  const std::vector<Contour>& contours() const { return contours_; }
  // What leads from a contour of one level up to one of the next: the edges that cross, as ranks.
  struct Strip {
    std::size_t below;
    std::vector<std::array<std::size_t, 2>> edges;
  };
  const std::vector<Strip>& strips() const { return strips_; }

 private:
  using Numbers = std::map<std::size_t, std::size_t>;  // component of the level set -> contour

  void number_contours(LevelSet& level, std::size_t rank) {
    lower_ = std::move(upper_);
    upper_.clear();
    upper_[level.component_of_vertex()] = contours_.size();
    contours_.push_back({rank, {}, {}, {}});
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      if (!level.crosses(e)) continue;
      if (upper_.try_emplace(level.component_of_edge(e), contours_.size()).second) contours_.push_back({});
    }
  }

  // Each contour between the levels r and r + 1 leads to one contour at each of the two levels.
  void join(LevelSet& below, LevelSet& between, LevelSet& above, std::size_t r) {
    std::map<std::size_t, std::pair<std::size_t, std::size_t>> ends;
    Numbers strip;
    for (std::size_t e = 0; e < complex_.edges.size(); ++e) {
      if (!between.crosses(e)) continue;
      const auto [a, b] = complex_.edges[e];
      const std::size_t low = a == r ? below.component_of_vertex() : below.component_of_edge(e);
      const std::size_t high = b == r + 1 ? above.component_of_vertex() : above.component_of_edge(e);
      const std::pair<std::size_t, std::size_t> end{lower_.at(low), upper_.at(high)};
      const auto [it, is_new] = ends.try_emplace(between.component_of_edge(e), end);
      if (it->second != end) throw std::logic_error("a contour continues in two");
      const std::size_t number = strip.try_emplace(it->first, strips_.size()).first->second;
      if (is_new) strips_.push_back({r, {}});
      strips_[number].edges.push_back(complex_.edges[e]);
      if (!is_new) continue;
      contours_[end.first].strips.push_back(number);
      contours_[end.first].up.push_back(end.second);
      contours_[end.second].down.push_back(end.first);
    }
  }

  const RankedComplex& complex_;
  std::vector<Contour> contours_;
  std::vector<Strip> strips_;
  Numbers lower_, upper_;
};

}  // namespace

ReferenceArcs reference_arcs(const Complex& complex) {
  const std::vector<std::uint64_t> order = sweep_order(complex);
  const RankedComplex ranked = rank_vertices(complex, order);
  const Quotient quotient(ranked);
  const std::vector<Contour>& contours = quotient.contours();

  ReferenceArcs result;
  ReebGraph& graph = result.graph;
  std::map<std::size_t, NodeId> node_of;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    if (contours[c].regular()) continue;
    if (!contours[c].vertex) throw std::logic_error("a contour without a vertex is not regular");
    const std::uint64_t vertex = order[*contours[c].vertex];
    node_of[c] = NodeId(static_cast<std::uint32_t>(graph.nodes.size()));
    const double value = complex.values[vertex];
    graph.nodes.push_back({value == 0 ? 0.0 : value, VertexId(vertex)});
    graph.positions.push_back(complex.positions[vertex]);
  }
  struct Arc {
    NodeId lo, hi;
    std::vector<std::uint64_t> vertices;  // by index
    std::vector<ReferenceArcs::Strip> strips;
    // Parallel arcs by their first vertex, those without vertices last.
    std::tuple<NodeId, NodeId, std::uint64_t> place() const {
      return {lo, hi, vertices.empty() ? ~std::uint64_t{0} : vertices.front()};
    }
  };
  std::vector<Arc> arcs;
  for (const auto& [contour, node] : node_of)
    for (std::size_t i = 0; i < contours[contour].up.size(); ++i) {
      Arc arc{node, {}, {}, {}};
      const auto add_strip = [&](std::size_t number) {
        const Quotient::Strip& strip = quotient.strips()[number];
        ReferenceArcs::Strip& added = arc.strips.emplace_back();
        added.below = order[strip.below];
        added.above = order[strip.below + 1];
        for (const auto& [a, b] : strip.edges) added.edges.push_back({order[a], order[b]});
      };
      std::size_t next = contours[contour].up[i];
      add_strip(contours[contour].strips[i]);
      for (; contours[next].regular(); next = contours[next].up.front()) {
        if (contours[next].vertex) arc.vertices.push_back(order[*contours[next].vertex]);
        add_strip(contours[next].strips.front());
      }
      arc.hi = node_of.at(next);
      std::sort(arc.vertices.begin(), arc.vertices.end());
      arcs.push_back(std::move(arc));
    }
  std::sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) { return a.place() < b.place(); });
  for (Arc& arc : arcs) {
    graph.lo.push_back(arc.lo);
    graph.hi.push_back(arc.hi);
    result.vertices.push_back(std::move(arc.vertices));
    result.strips.push_back(std::move(arc.strips));
  }
  return result;
}

ReebGraph reference_reeb(const Complex& complex) { return reference_arcs(complex).graph; }

ReebGraph without_positions(ReebGraph graph) {
  graph.positions.clear();
  return graph;
}

std::string describe(const ReebGraph& graph) {
  std::ostringstream out;
  out.precision(17);
  for (const SweepKey& node : graph.nodes) out << "n " << node.vertex.value() << ' ' << node.value << '\n';
  for (std::size_t i = 0; i < graph.arc_count(); ++i)
    out << "a " << graph.nodes[graph.lo[i].value()].vertex.value() << ' '
        << graph.nodes[graph.hi[i].value()].vertex.value() << '\n';
  return out.str();
}

}  // namespace reeb::test
