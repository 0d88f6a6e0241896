// Cuts a mesh along many curves, and closes boundaries: in patches around them, as many at a time as memory holds.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ooc/whole_mesh/workspace.h"
#include "tools/defects/curve_search.h"
#include "tools/defects/valued_mesh.h"
#include "tools/repair/mesh_edits.h"

namespace reeb::tools {

struct RepairJob {
  std::vector<VertexId> curve;  // closed, along edges
  double length = 0;
  std::array<Point, 2> box{};
  bool is_boundary = false;  // it is closed, and nothing is cut
};

struct JobResult {
  bool done = false;
  std::string why;  // it was not
  std::uint64_t removed = 0, added = 0;
  double volume = 0;
};

struct JobOptions {
  unsigned threads = 0;
  std::uint64_t patch_bytes = std::uint64_t{24} << 20;  // of patches at the same time, roughly
  bool float32 = false;                                 // positions of new vertices
  std::function<void(std::uint64_t done, std::uint64_t total)> progress{};
};

struct JobsDone {
  std::vector<JobResult> results;  // one for each job
  MeshEdits edits;
  std::uint64_t mesh_vertices = 0, mesh_triangles = 0;
};

// Jobs whose patches meet are done by length, each on the surface as the ones before left it. A curve that would divide
// a component of what is left then is not cut. Reads the mesh once for the patches; again where patches turn out to be
// too small; once for large triangles that reach into them; and once to see whether something was divided, where that
// is not known from the patches. REQUIRES: jobs are in the order of their lengths. What it holds is from the budget of
// `space`.
JobsDone run_jobs(const ValuedMesh& mesh, const std::vector<RepairJob>& jobs, const PatchScale& scale,
                  ooc::Workspace& space, const JobOptions& options);

}  // namespace reeb::tools
