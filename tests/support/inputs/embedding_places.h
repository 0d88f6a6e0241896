// Where the vertices of an embedding are, as far as that does not depend on how the mesh was cut into chunks
// (docs/SEMANTICS.md, Determinism).
//
// A node of a later chunk cuts the bucket that contains its value. The vertices of that bucket are no longer known one
// by one, so some can be counted on another arc of the node. Take all arcs that are connected through nodes within the
// same bucket: the content of that bucket on all of them together does not depend on the chunks.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "libreeb/containers/union_find.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::test {

struct Contents {
  std::uint64_t count = 0;
  std::array<double, 3> sum{};
};

// By bucket and by the first of the arcs that are connected there. Parallel arcs count as one, since nothing
// distinguishes them.
using Places = std::map<std::pair<std::int64_t, std::size_t>, Contents>;

inline Places places_of(const ooc::Level& level, int exponent) {
  const ReebGraph& graph = level.graph;
  const auto index_of_node = [&](NodeId n) { return bucket_index(graph.nodes[n.value()].value, exponent); };
  std::vector<std::size_t> first(graph.arc_count());  // the first of the arcs that are parallel to it
  for (std::size_t a = 0; a < graph.arc_count(); ++a)
    first[a] = a > 0 && graph.lo[a] == graph.lo[a - 1] && graph.hi[a] == graph.hi[a - 1] ? first[a - 1] : a;

  // The arcs at a node are connected in its bucket. An arc has two ends, so it is represented by another arc in two
  // buckets at most.
  std::map<std::pair<std::int64_t, std::size_t>, std::uint32_t> elements;
  UnionFind united;
  const auto element = [&](std::int64_t index, std::size_t arc) {
    const auto [at, is_new] = elements.try_emplace({index, arc}, static_cast<std::uint32_t>(elements.size()));
    if (is_new) united.add();
    return at->second;
  };
  std::vector<std::size_t> any_arc(graph.node_count(), graph.arc_count());
  for (std::size_t a = 0; a < graph.arc_count(); ++a)
    for (const NodeId end : {graph.lo[a], graph.hi[a]}) {
      std::size_t& any = any_arc[end.value()];
      if (any == graph.arc_count()) any = first[a];
      const std::int64_t index = index_of_node(end);
      united.unite(element(index, any), element(index, first[a]));
    }
  std::map<std::uint32_t, std::size_t> arc_of_class;
  for (const auto& [place, number] : elements) arc_of_class.try_emplace(united.find(number), place.second);

  Places places;
  for (std::size_t a = 0; a < graph.arc_count(); ++a)
    for (const Bucket& bucket : level.buckets.view().of(a)) {
      const auto at = elements.find({bucket.index, first[a]});
      Contents& contents =
          places[{bucket.index, at == elements.end() ? first[a] : arc_of_class[united.find(at->second)]}];
      contents.count += bucket.count;
      for (std::size_t k = 0; k < 3; ++k) contents.sum[k] += static_cast<double>(bucket.count) * bucket.mean[k];
    }
  return places;
}

// `size`: the size of coordinates.
// REQUIRES: both are of the same graph, with buckets of this exponent.
inline void expect_same_places(const ooc::Level& level, const ooc::Level& other, int exponent, double size) {
  ASSERT_EQ(level.graph, other.graph);
  const Places places = places_of(level, exponent), others = places_of(other, exponent);
  ASSERT_EQ(places.size(), others.size());
  for (const auto& [place, contents] : places) {
    const auto found = others.find(place);
    ASSERT_NE(found, others.end()) << "nothing in bucket " << place.first << " at arc " << place.second;
    ASSERT_EQ(contents.count, found->second.count) << "bucket " << place.first << " at arc " << place.second;
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(contents.sum[k], found->second.sum[k], 1e-9 * size * static_cast<double>(contents.count));
  }
}

}  // namespace reeb::test
