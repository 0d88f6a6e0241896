// No vertex is lost and none is counted twice (docs/SEMANTICS.md, Conservation).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/levels.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::test {

inline std::uint64_t vertices_in_buckets(const ArcBuckets& buckets) {
  std::uint64_t vertices = 0;
  for (const Bucket& bucket : buckets.buckets) vertices += bucket.count;
  return vertices;
}

// Expects this number of vertices in nodes and buckets, and each bucket within the values of its arc.
inline std::uint64_t expect_vertices_placed(const ooc::Level& level, int exponent) {
  if (level.graph.arc_count() == 0) return level.graph.node_count();
  EXPECT_EQ(level.buckets.offsets.size(), level.graph.arc_count() + 1);
  for (std::size_t a = 0; a < level.graph.arc_count(); ++a) {
    const double lo = level.graph.nodes[level.graph.lo[a].value()].value;
    const double hi = level.graph.nodes[level.graph.hi[a].value()].value;
    const auto buckets = level.buckets.view().of(a);
    for (std::size_t i = 0; i < buckets.size(); ++i) {
      EXPECT_GT(buckets[i].count, 0u);
      EXPECT_GE(buckets[i].index, bucket_index(lo, exponent));
      EXPECT_LE(buckets[i].index, bucket_index(hi, exponent));
      if (i > 0) {
        EXPECT_LT(buckets[i - 1].index, buckets[i].index);
      }
    }
  }
  return vertices_in_buckets(level.buckets) + level.graph.node_count();
}

// Expects vertices in buckets + nodes + dropped vertices = vertices of the mesh, in version 0, where nothing was
// dropped, and in every version, or in some if there are many. Checks nothing if there is no embedding.
inline void expect_vertices_conserved(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  if (!header.flags.has_embedding) return;
  ooc::Level level = file.load();
  ASSERT_EQ(expect_vertices_placed(level, header.bucket_exponent), header.mesh_vertices);
  if (header.flags.graph_only) return;

  // A file does not record what was dropped, so the cancellations are repeated.
  const Hierarchy again = build_hierarchy(level.graph, level.buckets, header.bucket_exponent);
  ASSERT_EQ(again.persistence.size(), header.steps);

  constexpr std::uint32_t kVersions = 12;
  for (std::uint32_t version = 1; version <= header.steps; version += 1 + header.steps / kVersions) {
    std::uint64_t dropped = 0;
    for (const DroppedVertices& more : again.dropped) dropped += more.version <= version ? more.count : 0;
    ASSERT_EQ(expect_vertices_placed(file.load(version), header.bucket_exponent) + dropped, header.mesh_vertices)
        << "version " << version << " of " << header.steps;
  }
}

}  // namespace reeb::test
