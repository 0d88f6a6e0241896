// What the header of a `.reeb` file says: the mesh, the function, the graph, and its levels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace reeb {

// Memory of a loaded level, as announced in the level table.
inline constexpr std::uint64_t kNodeMemoryBytes = 48;
inline constexpr std::uint64_t kArcMemoryBytes = 24;
inline constexpr std::uint64_t kBucketMemoryBytes = 56;

// Bytes of memory that a loaded level holds, by the constants above.
std::uint64_t level_memory(std::uint64_t nodes, std::uint64_t arcs, std::uint64_t buckets) noexcept;

struct FileFlags {
  bool graph_only = false;     // one version, no pairs
  bool has_positions = false;  // nodes have positions
  bool has_embedding = false;  // arcs have buckets
  bool has_spreads = false;    // buckets have spreads and rims; not so in embedded files of version 1
  friend bool operator==(const FileFlags&, const FileFlags&) = default;
};

// The flags of files that are written now.
constexpr FileFlags file_flags(bool graph_only, bool has_positions, bool has_embedding) {
  return {graph_only, has_positions, has_embedding, has_embedding};
}

// A version that can be loaded, and its size. Lines go from coarse to fine.
struct LevelLine {
  std::uint32_t version = 0;  // the number of cancellations
  std::uint32_t frames = 0;   // loading it takes this number of graph frames, from the first
  double threshold = 0;       // the least threshold that yields it; see level_threshold
  std::uint64_t nodes = 0, arcs = 0;
  std::uint64_t buckets = 0;       // of its arcs
  std::uint64_t file_bytes = 0;    // from the start of the file to the end of those frames
  std::uint64_t memory_bytes = 0;  // see level_memory
  friend bool operator==(const LevelLine&, const LevelLine&) = default;
};

struct FileHeader {
  FileFlags flags;
  std::string function;                       // as the user named it
  double function_min = 0, function_max = 0;  // over all vertices; both 0 without vertices
  std::uint64_t mesh_vertices = 0, mesh_triangles = 0;
  std::uint64_t nodes = 0, arcs = 0, components = 0, loops = 0;  // of version 0
  std::uint64_t records = 0;                                     // arc records in all frames
  std::uint64_t pairs = 0, kept_loops = 0;
  double denoise_threshold = 0;  // of the noise removal that came before the hierarchy
  std::uint64_t denoised_pairs = 0;
  std::int32_t bucket_exponent = 0;  // a bucket is 2^this wide
  std::uint32_t steps = 0;           // versions are 0..steps
  std::uint32_t graph_frames = 0, pair_frames = 0;
  std::uint64_t content_digest = 0;  // XXH64 of all uncompressed payloads, in file order
  std::vector<LevelLine> levels;

  // Size of the header region, its checksum included.
  std::uint64_t region_bytes() const;
  friend bool operator==(const FileHeader&, const FileHeader&) = default;
};

}  // namespace reeb
