#include "ooc/distributed/part_info.h"

#include <cmath>

#include "io/file/file.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/graph/bucket.h"
#include "ooc/chunks/last_use_sidecar.h"

namespace reeb::ooc {
namespace {

bool is_same(const WholeMeshInfo& a, const WholeMeshInfo& b) {
  return a.bytes == b.bytes && a.digest == b.digest && a.reading == b.reading &&
         a.shares.triangles == b.shares.triangles && a.shares.vertices == b.shares.vertices && a.numbers == b.numbers &&
         a.simplices == b.simplices;
}

}  // namespace

SweepOptions PartInfo::sweep() const {
  SweepOptions sweep;
  if (!denoise_is_share) sweep.noise_below = denoise;
  if (buckets != 0 && range.min <= range.max) sweep.bucket_exponent = bucket_exponent(range.min, range.max, buckets);
  return sweep;
}

WholeMeshInfo identify_whole_mesh(const MeshInput& input) {
  WholeMeshInfo info;
  info.reading = input.reading;
  if (!io::is_regular_file(input.path)) return info;
  const MeshIdentity identity = identify_mesh(input.path);
  info.bytes = identity.bytes;
  info.digest = identity.digest;
  return info;
}

std::string difference(const PartInfo& part, const PartInfo& first) {
  if (!is_same(part.mesh, first.mesh)) return "is of another mesh";
  if (part.function != first.function) return "is of another function, " + part.function;
  if (part.values_digest != first.values_digest) return "has its values from another file";
  if (part.mesh.shares.parts != first.mesh.shares.parts)
    return "is of " + std::to_string(part.mesh.shares.parts) + " parts, not of " +
           std::to_string(first.mesh.shares.parts);
  if (part.denoise != first.denoise || part.denoise_is_share != first.denoise_is_share)
    return "was made with another --denoise";
  if (part.buckets != first.buckets) return "was made with another number of --buckets";
  if (part.graph_only != first.graph_only)
    return std::string("was made ") + (part.graph_only ? "with" : "without") + " --graph-only";
  return {};
}

void write_info(StateWriter& out, const PartInfo& info) {
  const WholeMeshInfo& mesh = info.mesh;
  for (const std::uint64_t number : {mesh.bytes, mesh.digest, mesh.reading, mesh.shares.triangles, mesh.shares.vertices,
                                     mesh.numbers, std::uint64_t{mesh.shares.parts}})
    out.put(number);
  out.put(mesh.simplices);
  out.put_array(std::span<const char>(info.function));
  out.put(info.values_digest);
  out.put(info.denoise);
  for (const std::uint64_t number :
       {std::uint64_t{info.denoise_is_share}, std::uint64_t{info.buckets}, std::uint64_t{info.graph_only}})
    out.put(number);
  out.put_array(info.runs);
  out.put(info.range.min);
  out.put(info.range.max);
  for (const std::uint64_t number :
       {info.degenerate_triangles, info.unused_vertices, info.removed_pairs, info.settled_nodes, info.settled_arcs,
        info.live.vertices, info.live.edges, info.live.arcs})
    out.put(number);
}

PartInfo read_info(StateReader& in) {
  const auto number = [&] { return in.get<std::uint64_t>(); };
  PartInfo info;
  WholeMeshInfo& mesh = info.mesh;
  mesh.bytes = number();
  mesh.digest = number();
  mesh.reading = number();
  mesh.shares.triangles = number();
  mesh.shares.vertices = number();
  mesh.numbers = number();
  const std::uint64_t parts = number();
  require_state(parts != 0 && parts <= UseEntry::kMostBlocks);
  mesh.shares.parts = static_cast<std::uint32_t>(parts);
  in.get(mesh.simplices);
  std::vector<char> function;
  in.get_array(function);
  info.function.assign(function.begin(), function.end());
  info.values_digest = number();
  in.get(info.denoise);
  require_state(std::isfinite(info.denoise) && info.denoise >= 0);
  info.denoise_is_share = number() != 0;
  const std::uint64_t buckets = number();
  require_state(buckets <= kMostBuckets);
  info.buckets = static_cast<std::uint32_t>(buckets);
  info.graph_only = number() != 0;
  in.get_array(info.runs);
  require_state(!info.runs.empty());
  for (std::size_t i = 0; i < info.runs.size(); ++i)
    require_state(info.runs[i].first <= info.runs[i].last && info.runs[i].last < parts &&
                  (i == 0 || info.runs[i - 1].last < info.runs[i].first));
  in.get(info.range.min);
  in.get(info.range.max);
  require_state((std::isfinite(info.range.min) && std::isfinite(info.range.max)) || info.range.min > info.range.max);
  for (std::uint64_t* field :
       {&info.degenerate_triangles, &info.unused_vertices, &info.removed_pairs, &info.settled_nodes, &info.settled_arcs,
        &info.live.vertices, &info.live.edges, &info.live.arcs})
    in.get(*field);
  return info;
}

}  // namespace reeb::ooc
