#include "ooc/chunks/last_use_sidecar.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/input_file.h"
#include "io/file/zstd_codec.h"
#include "libreeb/base/byte_planes.h"
#include "libreeb/base/error.h"
#include "libreeb/base/state_stream.h"
#include "ooc/states/state_file.h"

// Bytes, all little-endian:
//   Header, then Header::samples 64-bit numbers (the live profile), then XXH64 of both;
//   for each kBlockEntries table entries (fewer in the last): BlockHeader, then the entries as
//   differences to the one before, in four byte planes, zstd-compressed. Nothing follows.

namespace reeb::ooc {

namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

constexpr std::array<char, 8> kMagic = {'R', 'E', 'E', 'B', 'F', 'I', 'N', '\n'};
constexpr std::uint64_t kVersion = 3;
constexpr std::size_t kBlockEntries = 16 << 10;
constexpr std::uint64_t kSamplesLimit = 4096;
constexpr int kLevel = 1;
constexpr std::size_t kBufferBytes = 64 << 10;
constexpr std::size_t kProbeBytes = 64 << 10;
constexpr std::uint64_t kProbes = 16;

struct Header {
  std::array<char, 8> magic;
  std::uint64_t version;
  std::uint64_t mesh_bytes;
  std::int64_t mesh_changed_ns;
  std::uint64_t mesh_digest;
  std::uint64_t vertex_count, unused_vertices;
  std::uint64_t triangle_count, degenerate_triangles;
  std::uint64_t block_triangles, block_count;
  std::uint64_t max_live_vertices;
  std::uint64_t triangles_digest;
  std::uint64_t samples;
};
static_assert(sizeof(Header) == std::size_t{14} * 8);

struct BlockHeader {
  std::uint64_t packed_bytes;
  std::uint64_t checksum;  // XXH64 of the packed bytes
};

// Entries become differences.
void to_planes(std::span<std::uint32_t> entries, std::vector<std::byte>& planes) {
  std::adjacent_difference(entries.begin(), entries.end(), entries.begin());
  planes.resize(entries.size_bytes());
  split_planes(entries, planes.data());
}

void from_planes(std::span<const std::byte> planes, std::span<std::uint32_t> entries) {
  std::array<const std::byte*, sizeof(std::uint32_t)> places;
  for (std::size_t p = 0; p < places.size(); ++p) places[p] = planes.data() + p * entries.size();
  join_planes(places, entries);
  std::partial_sum(entries.begin(), entries.end(), entries.begin());
}

void write_sidecar(io::BufferedWriter& out, const MeshIdentity& mesh, LastUse& uses) {
  const UseSummary& s = uses.summary();
  const Header header{kMagic,
                      kVersion,
                      mesh.bytes,
                      mesh.changed_ns,
                      mesh.digest,
                      s.vertex_count,
                      s.unused_vertices,
                      s.triangle_count,
                      s.degenerate_triangles,
                      s.block_triangles,
                      s.block_count,
                      s.max_live_vertices,
                      s.digest,
                      s.live_profile.size()};
  const auto profile = std::as_bytes(std::span(s.live_profile));
  out.append(io::object_bytes(header));
  out.append(profile);
  out.append(io::object_bytes(io::checksum(profile, io::checksum(io::object_bytes(header)))));
  std::vector<std::uint32_t> entries(kBlockEntries);
  std::vector<std::byte> planes, packed;
  for (std::uint64_t first = 0; first < s.vertex_count; first += kBlockEntries) {
    entries.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockEntries, s.vertex_count - first)));
    uses.read(VertexId(first), entries);
    to_planes(entries, planes);
    packed.clear();
    io::zstd_compress(planes, kLevel, packed);
    out.append(io::object_bytes(BlockHeader{packed.size(), io::checksum(packed)}));
    out.append(packed);
  }
}

UseSummary read_summary(StateReader& in, const Header& header) {
  const std::uint64_t triangles = header.triangle_count, block = header.block_triangles;
  if (header.samples > kSamplesLimit || header.block_count > UseEntry::kMostBlocks || block == 0 ||
      header.block_count != triangles / block + (triangles % block == 0 ? 0 : 1) ||
      header.max_live_vertices > header.vertex_count || header.degenerate_triangles > triangles)
    throw DamagedState();
  UseSummary s;
  s.live_profile.resize(static_cast<std::size_t>(header.samples));
  const auto profile = std::as_writable_bytes(std::span(s.live_profile));
  in.read(profile);
  if (in.get<std::uint64_t>() != io::checksum(profile, io::checksum(io::object_bytes(header)))) throw DamagedState();
  s.vertex_count = header.vertex_count;
  s.unused_vertices = header.unused_vertices;
  s.triangle_count = header.triangle_count;
  s.degenerate_triangles = header.degenerate_triangles;
  s.block_triangles = header.block_triangles;
  s.block_count = header.block_count;
  s.max_live_vertices = header.max_live_vertices;
  s.digest = header.triangles_digest;
  if (!has_usual_blocks(s)) throw DamagedState();
  return s;
}

void read_table(StateReader& in, const UseSummary& summary, PagedTable<std::uint32_t>& table) {
  std::vector<std::uint32_t> entries;
  std::vector<std::byte> planes, packed;
  std::uint64_t unused = 0;
  for (std::uint64_t first = 0; first < summary.vertex_count; first += kBlockEntries) {
    entries.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockEntries, summary.vertex_count - first)));
    const auto header = in.get<BlockHeader>();
    if (header.packed_bytes > 8 * kBlockEntries) throw DamagedState();
    packed.resize(static_cast<std::size_t>(header.packed_bytes));
    in.read(packed);
    planes.resize(4 * entries.size());
    if (io::checksum(packed) != header.checksum || !io::zstd_decompress(packed, planes)) throw DamagedState();
    from_planes(planes, entries);
    for (const std::uint32_t entry : entries) {
      unused += UseEntry(entry).unused() ? 1u : 0u;
      if (!UseEntry(entry).unused() && UseEntry(entry).last_block() >= summary.block_count) throw DamagedState();
    }
    table.write(first, entries);
  }
  if (in.left() != 0 || unused != summary.unused_vertices) throw DamagedState();
}

}  // namespace

MeshIdentity identify_mesh(const std::string& path) { return identify_mesh(io::File::open_for_reading(path)); }

MeshIdentity identify_mesh(const io::File& file) {
  const io::FileState state = io::state_of(file);
  MeshIdentity identity;
  identity.bytes = state.bytes;
  identity.changed_ns = state.modified_ns;
  std::vector<std::byte> probe(static_cast<std::size_t>(std::min<std::uint64_t>(kProbeBytes, identity.bytes)));
  for (std::uint64_t k = 0; k < kProbes; ++k) {
    const std::uint64_t room = identity.bytes - probe.size();
    file.read_at(room / (kProbes - 1) * k + room % (kProbes - 1) * k / (kProbes - 1), probe);
    identity.digest = io::checksum(probe, identity.digest);
    if (room == 0) break;
  }
  return identity;
}

bool is_sidecar(const std::string& path) {
  if (!io::is_regular_file(path)) return false;
  try {
    const io::File file = io::File::open_for_reading(path);
    std::array<char, 8> magic{};
    if (file.size() < sizeof magic) return false;
    file.read_at(0, std::as_writable_bytes(std::span(magic)));
    return magic == kMagic;
  } catch (const Error&) {
    return false;
  }
}

void save_sidecar(const std::string& path, const MeshIdentity& mesh, LastUse& uses) {
  try {
    io::AtomicFile file(path, {.existing = io::Existing::kReplace, .buffer_bytes = kBufferBytes});
    write_sidecar(file.out(), mesh, uses);
    file.commit();
  } catch (const Error& e) {
    throw e.with_hint("make room in the folder of the mesh, or leave out --sidecar");
  }
}

SidecarLoad load_sidecar(const std::string& path, const MeshIdentity& mesh, std::uint64_t vertex_count,
                         const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes) {
  if (::access(path.c_str(), F_OK) != 0) return {};
  const auto ignored = [&](const std::string& why) { return SidecarLoad{{}, ignored_sidecar(path, why)}; };
  try {
    const io::File file = io::File::open_for_reading(path);
    StateFileReader in(file, 0, file.size());
    const auto header = in.get<Header>();
    if (header.magic != kMagic) return ignored("it is not a finalization file");
    if (header.version != kVersion)
      return ignored("it is of version " + std::to_string(header.version) + ", which this program does not know");
    if (MeshIdentity{header.mesh_bytes, header.mesh_changed_ns, header.mesh_digest} != mesh ||
        header.vertex_count != vertex_count)
      return ignored("it was made for another state of the mesh");
    UseSummary summary = read_summary(in, header);
    PagedTable<std::uint32_t> table("last uses", temp, budget, allowance_bytes, UseEntry::kUnused);
    read_table(in, summary, table);
    return {LastUse(std::move(summary), std::move(table)), {}};
  } catch (const DamagedState&) {
    return ignored("it is damaged");
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kBadInput) throw;
    return ignored("it cannot be read");
  }
}

std::string ignored_sidecar(const std::string& path, const std::string& why) {
  return path + " is ignored, since " + why;
}

}  // namespace reeb::ooc
