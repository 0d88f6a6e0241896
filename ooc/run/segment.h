// Which arc of a Reeb graph each vertex of its mesh lies on (docs/SEMANTICS.md, Segmentation).
#pragma once

#include <cstdint>
#include <functional>
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

struct SegmentRequest {
  const ReebFile& file;
  std::uint32_t version = 0;       // of the level
  std::uint64_t vertex_bound = 0;  // more than the index of any vertex
  std::string output = {};         // gives the folder for temporary files, and is not written
  // Those of the result (embedding, noise, levels, checkpoints) have no effect.
  ComputeOptions options = {};
};

// The labels of all vertices, by index.
class Segmentation {
 public:
  Segmentation() = default;
  Segmentation(const Segmentation&) = delete;
  Segmentation& operator=(const Segmentation&) = delete;
  virtual ~Segmentation() = default;

  virtual std::uint64_t vertex_bound() const = 0;
  virtual const SegmentCounts& counts() const = 0;
  virtual const ReebGraph& level() const = 0;

  // The labels and values of the next vertices, as many as the spans have.
  // A vertex of a grid that is left out has kDroppedVertex and NaN.
  // REQUIRES: not beyond vertex_bound().
  virtual void read(std::span<ArcLabel> labels, std::span<double> values) = 0;

  // Measures the parts of the surface on the arcs. `mesh` delivers the mesh again, from its beginning; each batch is
  // shown to `observe`. If the mesh has cells, areas and lengths are NaN. REQUIRES: read() is not called afterwards.
  // THROWS: Error of the mesh, the budget or the disk; Error{kChanged} if the mesh has other vertices.
  virtual MeasuredArcs measure(MeshReader& mesh, const std::function<void(const MeshBatch&)>& observe) = 0;
};

// Computes the graph of the mesh again, and follows every vertex to its arc. The function is that of the file. It and
// the file must outlive the result.
// THROWS: as compute(); Error{kBadInput} if the file is damaged, or is not that of this mesh, function and order.
std::unique_ptr<Segmentation> segment_mesh(MeshInput input, VertexFunction& function, const SegmentRequest& request);

}  // namespace reeb::ooc
