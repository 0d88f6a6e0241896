#include "ooc/chunks/last_use_sidecar.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/zstd_codec.h"
#include "libreeb/base/error.h"

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

void to_planes(std::span<const std::uint32_t> entries, std::vector<std::byte>& planes) {
  const std::size_t count = entries.size();
  planes.resize(4 * count);
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t difference = entries[i] - before;
    before = entries[i];
    for (std::size_t b = 0; b < 4; ++b) planes[b * count + i] = static_cast<std::byte>(difference >> (8 * b));
  }
}

void from_planes(std::span<const std::byte> planes, std::span<std::uint32_t> entries) {
  const std::size_t count = entries.size();
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t difference = 0;
    for (std::size_t b = 0; b < 4; ++b) difference |= std::to_integer<std::uint32_t>(planes[b * count + i]) << (8 * b);
    entries[i] = value += difference;
  }
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

struct Damaged {};

// Reads from the start of the file. Throws Damaged where the file ends too early.
class Reader {
 public:
  explicit Reader(const std::string& path) : file_(io::File::open_for_reading(path)), size_(file_.size()) {}
  void take(std::span<std::byte> bytes) {
    if (bytes.size() > size_ - at_) throw Damaged();
    file_.read_at(at_, bytes);
    at_ += bytes.size();
  }
  template <class T>
  T take() {
    T object;
    take(std::as_writable_bytes(std::span(&object, 1)));
    return object;
  }
  std::uint64_t left() const { return size_ - at_; }

 private:
  io::File file_;
  std::uint64_t size_, at_ = 0;
};

UseSummary read_summary(Reader& in, const Header& header) {
  const std::uint64_t triangles = header.triangle_count, block = header.block_triangles;
  if (header.samples > kSamplesLimit || header.block_count > UseEntry::kMostBlocks || block == 0 ||
      header.block_count != triangles / block + (triangles % block == 0 ? 0 : 1) ||
      header.max_live_vertices > header.vertex_count || header.degenerate_triangles > triangles)
    throw Damaged();
  UseSummary s;
  s.live_profile.resize(static_cast<std::size_t>(header.samples));
  const auto profile = std::as_writable_bytes(std::span(s.live_profile));
  in.take(profile);
  if (in.take<std::uint64_t>() != io::checksum(profile, io::checksum(io::object_bytes(header)))) throw Damaged();
  s.vertex_count = header.vertex_count;
  s.unused_vertices = header.unused_vertices;
  s.triangle_count = header.triangle_count;
  s.degenerate_triangles = header.degenerate_triangles;
  s.block_triangles = header.block_triangles;
  s.block_count = header.block_count;
  s.max_live_vertices = header.max_live_vertices;
  s.digest = header.triangles_digest;
  if (!has_usual_blocks(s)) throw Damaged();
  return s;
}

void read_table(Reader& in, const UseSummary& summary, PagedTable<std::uint32_t>& table) {
  std::vector<std::uint32_t> entries;
  std::vector<std::byte> planes, packed;
  std::uint64_t unused = 0;
  for (std::uint64_t first = 0; first < summary.vertex_count; first += kBlockEntries) {
    entries.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockEntries, summary.vertex_count - first)));
    const auto header = in.take<BlockHeader>();
    if (header.packed_bytes > 8 * kBlockEntries) throw Damaged();
    packed.resize(static_cast<std::size_t>(header.packed_bytes));
    in.take(packed);
    planes.resize(4 * entries.size());
    if (io::checksum(packed) != header.checksum || !io::zstd_decompress(packed, planes)) throw Damaged();
    from_planes(planes, entries);
    for (const std::uint32_t entry : entries) {
      unused += UseEntry(entry).unused() ? 1u : 0u;
      if (!UseEntry(entry).unused() && UseEntry(entry).last_block() >= summary.block_count) throw Damaged();
    }
    table.write(first, entries);
  }
  if (in.left() != 0 || unused != summary.unused_vertices) throw Damaged();
}

}  // namespace

MeshIdentity identify_mesh(const std::string& path) {
  struct stat status {};
  const io::File file = io::File::open_for_reading(path);
  if (::stat(path.c_str(), &status) != 0)
    throw Error(ErrorKind::kBadInput, std::strerror(errno), "check the name").at(path);
  MeshIdentity identity;
  identity.bytes = file.size();
  identity.changed_ns = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
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
    throw Error(e.kind(), e.message(), "make room in the folder of the mesh, or leave out --sidecar")
        .at(e.file(), e.position());
  }
}

SidecarLoad load_sidecar(const std::string& path, const MeshIdentity& mesh, std::uint64_t vertex_count,
                         const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes) {
  if (::access(path.c_str(), F_OK) != 0) return {};
  const auto ignored = [&](const std::string& why) { return SidecarLoad{{}, ignored_sidecar(path, why)}; };
  try {
    Reader in(path);
    const auto header = in.take<Header>();
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
  } catch (const Damaged&) {
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
