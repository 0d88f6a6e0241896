// Which arc of a Reeb graph each vertex of its mesh lies on (docs/SEMANTICS.md, Segmentation).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/run/compute.h"
#include "ooc/segmentation/surface_measures.h"

namespace reeb::ooc {

// Where a vertex lies: the position of its arc in the canonical order of the level's arcs; or -1 - the position of its
// node in the order of the nodes; or kDroppedVertex.
using ArcLabel = std::int64_t;
inline constexpr ArcLabel kDroppedVertex = std::int64_t{-1} << 63;

struct SegmentCounts {
  std::uint64_t on_arcs = 0, nodes = 0, dropped = 0;
  std::uint64_t absent = 0;  // vertices of a grid that are left out
};

// Computes the graph of the mesh again, follows every vertex to its arc, and delivers the labels by index.
class Segmentation {
 public:
  // The function is that of the file. `output` gives the folder for temporary files, and is not written. Of the
  // options, those of the result (embedding, noise, levels, checkpoints) have no effect.
  // `vertex_bound`: more than the index of any vertex.
  // THROWS: as compute(); Error{kBadInput} if the file is damaged, or is not that of this mesh, function and order.
  Segmentation(MeshInput input, VertexFunction& function, std::uint64_t vertex_bound, const ReebFile& file,
               std::uint32_t version, const std::string& output, ComputeOptions options);
  ~Segmentation();
  Segmentation(const Segmentation&) = delete;
  Segmentation& operator=(const Segmentation&) = delete;

  std::uint64_t vertex_bound() const;
  const SegmentCounts& counts() const;
  std::uint64_t nodes() const;  // of the level
  std::uint64_t arcs() const;

  // The labels and values of the next vertices, as many as the spans have. rewind() starts over.
  // A vertex of a grid that is left out has kDroppedVertex and NaN.
  // REQUIRES: not beyond vertex_bound().
  void read(std::span<ArcLabel> labels, std::span<double> values);
  void rewind();

  // Measures the parts of the surface on the arcs. `mesh` delivers the mesh again, from its beginning. If it has cells,
  // areas and lengths are NaN.
  // THROWS: Error of the mesh, the budget or the disk; InputChanged if the mesh has other vertices.
  MeasuredArcs measure(MeshReader& mesh);
  const ReebGraph& level() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reeb::ooc
