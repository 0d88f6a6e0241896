// MESH.final: the finalization of a mesh, kept next to it for later runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file/file.h"
#include "ooc/chunks/last_use.h"

namespace reeb::ooc {

// Identifies the state of a mesh file that a sidecar belongs to: size, time of change, and XXH64 of up to 16 samples of
// 64 KiB. The samples are spread evenly over the file, from its first to its last bytes.
struct MeshIdentity {
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;
  std::uint64_t digest = 0;
  friend bool operator==(const MeshIdentity&, const MeshIdentity&) = default;
};

// THROWS: Error{kBadInput} if the file cannot be opened.
MeshIdentity identify_mesh(const std::string& path);
// The same of a file that is open, whatever has its name now.
MeshIdentity identify_mesh(const io::File& file);

// Whether the file `path` was made by save_sidecar(), of any version and for any mesh.
bool is_sidecar(const std::string& path);

// Writes the sidecar. It appears under its name only when it is whole; an older one stays until then.
// THROWS: Error{kResource} with a hint naming --sidecar.
void save_sidecar(const std::string& path, const MeshIdentity& mesh, LastUse& uses);

struct SidecarLoad {
  std::optional<LastUse> uses;
  std::string note;  // why an existing sidecar was not used; else empty
};

// Reads a sidecar. A missing, outdated or damaged one is not an error: the pass is done again. One whose checksums are
// right can still be of other content; the chunks that are made with it find that out (chunk_source.h).
// THROWS: Error{kResource} of the budget or the disk.
SidecarLoad load_sidecar(const std::string& path, const MeshIdentity& mesh, std::uint64_t vertex_count,
                         const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes);

// The note for a sidecar that was not used.
std::string ignored_sidecar(const std::string& path, const std::string& why);

}  // namespace reeb::ooc
