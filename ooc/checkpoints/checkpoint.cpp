#include "ooc/checkpoints/checkpoint.h"

#include <algorithm>
#include <array>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/file.h"
#include "io/file/input_file.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/states/state_file.h"

namespace reeb::ooc {
namespace {

constexpr std::array<char, 8> kMagic = {'R', 'E', 'E', 'B', 'C', 'K', 'P', '\n'};
constexpr std::uint64_t kVersion = 21;
constexpr std::size_t kBufferBytes = 64 << 10;

struct Header {
  std::array<char, 8> magic;
  std::uint64_t version;
  std::uint64_t mesh, functions, settings, changed;  // RunIdentity
  std::uint64_t block_triangles;
  std::uint64_t origin;
  std::uint64_t chunk_first, chunk_most, chunk_most_vertices;
  std::uint64_t triangles;
  std::uint64_t next_vertex;
  std::uint64_t batches;
  std::uint64_t chunk_blocks;
  std::uint64_t digest, completed;
};
static_assert(sizeof(Header) == 17 * 8);

template <class T>
std::uint64_t digest_of(const T& object, std::uint64_t seed) {
  return io::checksum(io::object_bytes(object), seed);
}

// Adds the file to the digests: what it is, and when anything about it changed last.
void add_file(const std::string& path, std::uint64_t& content, std::uint64_t& changed) {
  const io::File file = io::File::open_for_reading(path);
  const MeshIdentity identity = identify_mesh(file);
  content =
      digest_of(std::array{identity.bytes, static_cast<std::uint64_t>(identity.changed_ns), identity.digest}, content);
  changed = digest_of(io::state_of(file).changed_ns, changed);
}

// A checkpoint that is open. The checksum of all before it is at the end.
class Reader : public StateReader {
 public:
  explicit Reader(const std::string& path)
      : file_(io::File::open_for_reading(path)),
        end_(std::max<std::uint64_t>(file_.size(), sizeof(std::uint64_t)) - sizeof(std::uint64_t)),
        in_(file_, 0, end_) {}

  void read(std::span<std::byte> bytes) override { in_.read(bytes); }
  std::uint64_t left() const override { return in_.left(); }

  bool is_whole() const {
    std::uint64_t expected = 0;
    if (file_.size() < sizeof(expected)) return false;
    file_.read_at(end_, std::as_writable_bytes(std::span(&expected, 1)));
    return io::checksum_of(file_, 0, end_) == expected;
  }

 private:
  io::File file_;
  std::uint64_t end_;
  StateFileReader in_;
};

}  // namespace

RunIdentity identify_run(const std::string& mesh, std::span<VertexFunction* const> functions,
                         const RunSettings& settings) {
  RunIdentity run;
  run.settings = digest_of(settings, 0);
  add_file(mesh, run.mesh, run.changed);
  for (const VertexFunction* function : functions) {
    const std::string name = function->name();
    run.functions = digest_of(std::uint64_t{name.size()}, run.functions);
    run.functions = io::checksum(std::as_bytes(std::span(name)), run.functions);
    if (const std::string file = function->source_file(); !file.empty()) add_file(file, run.functions, run.changed);
  }
  return run;
}

void write_checkpoint(const std::string& path, const RunIdentity& run, const Checkpoint& checkpoint,
                      const std::function<void(StateWriter&)>& save) {
  const ChunkPlace& place = checkpoint.place;
  io::AtomicFile file(path, {.existing = io::Existing::kReplace, .buffer_bytes = kBufferBytes});
  StateFileWriter out(file.out());
  out.put(Header{kMagic, kVersion, run.mesh, run.functions, run.settings, run.changed, checkpoint.block_triangles,
                 static_cast<std::uint64_t>(checkpoint.origin), checkpoint.chunk.first, checkpoint.chunk.most,
                 checkpoint.chunk.most_vertices, place.triangles, place.next_vertex, place.batches, place.chunk_blocks,
                 place.digest, place.completed});
  out.put_array(place.ranges);
  save(out);
  io::sync_folder(io::folder_of(path));  // the names of the files that `save` has made
  out.put(out.checksum());
  file.commit();
}

CheckpointLoad load_checkpoint(const std::string& path, const RunIdentity& run) {
  const auto useless = [](const char* why) {
    CheckpointLoad none;
    none.note = std::string("the checkpoint ") + why + ", so the run starts from the beginning";
    return none;
  };
  try {
    auto in = std::make_unique<Reader>(path);
    if (!in->is_whole()) return useless("is damaged");
    const auto header = in->get<Header>();
    if (header.magic != kMagic || header.version != kVersion) return useless("is of another version");
    const auto of_another = [&](const char* why) {
      CheckpointLoad load = useless(why);
      load.is_of_another_run = true;
      return load;
    };
    if (header.mesh != run.mesh) return of_another("is of another mesh, or of this one before it was changed");
    if (header.functions != run.functions) return of_another("is of other functions");
    if (header.settings != run.settings) return of_another("is of other options");
    if (header.changed != run.changed)
      throw input_changed("an input may have changed since the interrupted run: its time of change is another",
                          "start again with --force and without --resume");
    if (header.origin > static_cast<std::uint64_t>(ChunkOrigin::kMaskedGrid)) return useless("is damaged");
    Checkpoint checkpoint{
        .place = {.triangles = header.triangles,
                  .next_vertex = header.next_vertex,
                  .batches = header.batches,
                  .chunk_blocks = header.chunk_blocks,
                  .digest = header.digest,
                  .completed = header.completed,
                  .ranges = {}},
        .block_triangles = header.block_triangles,
        .origin = static_cast<ChunkOrigin>(header.origin),
        .chunk = {.first = header.chunk_first, .most = header.chunk_most, .most_vertices = header.chunk_most_vertices}};
    in->get_array(checkpoint.place.ranges);
    return {std::move(checkpoint), std::move(in), {}};
  } catch (const DamagedState&) {
    return useless("is damaged");
  } catch (const Error& error) {
    if (error.cause() == ErrorCause::kMissing) return {};
    throw;  // it may be readable the next time
  }
}

}  // namespace reeb::ooc
