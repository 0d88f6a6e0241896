#include "tools/repair/undo_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "io/file/checksum.h"
#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "libreeb/base/state_stream.h"

namespace reeb::tools {
namespace {

constexpr std::string_view kMagic = "reebundo";
// Version 1 does not count the third coordinate that an output has and its mesh has not.
constexpr std::uint32_t kVersion = 2;

bool ascends(const std::vector<std::uint64_t>& list) {
  return std::ranges::adjacent_find(list, std::greater_equal<>()) == list.end();
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::kBadInput, what, "name a file that reeb repair --undo wrote").at(path);
}

[[noreturn]] void refuse_version(const std::string& path, std::uint32_t version) {
  throw Error(ErrorKind::kBadInput, "this undo file has version " + std::to_string(version) + " of the format",
              "use the version of the program that wrote it, or repair the mesh again")
      .at(path);
}

// Both versions are the same for meshes with three coordinates or more.
bool lacks_coordinate(const UndoRecord& undo) {
  return undo.vertices != 0 && undo.digest[2] == io::RunningDigest().value();
}

// Whether the four arrays and the checksum end where the file ends.
bool is_filled_by_arrays(const io::File& file) {
  constexpr std::uint64_t kHeadBytes = kMagic.size() + 2 * sizeof(std::uint32_t) + 8 * sizeof(std::uint64_t);
  const std::uint64_t end = file.size();
  std::uint64_t at = kHeadBytes;
  for (int k = 0; k < 4; ++k) {
    std::array<std::uint64_t, 2> array{};  // how many elements, and the size of one
    if (end < at + sizeof array) return false;
    file.read_at(at, std::as_writable_bytes(std::span(array)));
    at += sizeof array;
    if (array[1] != sizeof(std::uint64_t) || array[0] > (end - at) / sizeof(std::uint64_t)) return false;
    at += array[0] * sizeof(std::uint64_t);
  }
  return at + sizeof(std::uint64_t) == end;
}

}  // namespace

void write_undo(const UndoRecord& undo, const std::string& path, io::Existing existing) {
  StateBytes out;
  out.write(std::as_bytes(std::span(kMagic)));
  out.put(kVersion);
  out.put(undo.columns);
  for (const std::uint64_t count : {undo.vertices, undo.triangles, undo.new_vertices, undo.new_triangles})
    out.put(count);
  out.put(undo.digest);
  out.put_array(undo.dropped);
  out.put_array(undo.values);
  out.put_array(undo.removed);
  out.put_array(undo.corners);
  const std::uint64_t sum = io::checksum(out.bytes());
  out.put(sum);
  io::AtomicFile file(path, {.existing = existing});
  file.out().append(out.bytes());
  file.commit();
}

UndoRecord read_undo(const std::string& path, MemoryBudget& budget) {
  const io::File file = io::File::open_for_reading(path);
  std::array<char, kMagic.size()> magic{};
  std::uint32_t version = 0;
  if (file.size() < magic.size() + sizeof version + 8) refuse(path, "this is not an undo file");
  file.read_at(0, std::as_writable_bytes(std::span(magic)));
  if (std::string_view(magic.data(), magic.size()) != kMagic) refuse(path, "this is not an undo file");
  file.read_at(magic.size(), std::as_writable_bytes(std::span(&version, 1)));
  if (version == 0 || version > kVersion) refuse_version(path, version);
  if (!is_filled_by_arrays(file)) refuse(path, "the file is damaged");
  Reservation memory = budget.reserve("undo file", 2 * file.size());
  std::vector<std::byte> bytes(file.size());
  file.read_at(0, bytes);
  StateBytes in(std::move(bytes));
  in.get(magic);
  in.get(version);
  std::uint64_t sum = 0;
  const auto content = std::span(in.bytes()).first(in.bytes().size() - sizeof sum);
  std::memcpy(&sum, content.data() + content.size(), sizeof sum);
  if (io::checksum(content) != sum) refuse(path, "the file is damaged");
  UndoRecord undo;
  undo.memory = std::move(memory);
  try {
    in.get(undo.columns);
    for (std::uint64_t* count : {&undo.vertices, &undo.triangles, &undo.new_vertices, &undo.new_triangles})
      in.get(*count);
    in.get(undo.digest);
    in.get_array(undo.dropped);
    in.get_array(undo.values);
    in.get_array(undo.removed);
    in.get_array(undo.corners);
  } catch (const DamagedState&) {
    refuse(path, "the file is damaged");
  }
  const std::uint64_t vertices = undo.vertices - undo.new_vertices + undo.dropped.size();
  const std::uint64_t triangles = undo.triangles - undo.new_triangles + undo.removed.size();
  const auto below = [](const std::vector<std::uint64_t>& list, std::uint64_t end) {
    return std::ranges::all_of(list, [&](std::uint64_t x) { return x < end; });
  };
  if (undo.new_vertices > undo.vertices || undo.new_triangles > undo.triangles ||
      undo.values.size() != undo.columns * undo.dropped.size() || undo.corners.size() != 3 * undo.removed.size() ||
      !ascends(undo.dropped) || !ascends(undo.removed) || !below(undo.dropped, vertices) ||
      !below(undo.removed, triangles) || !below(undo.corners, vertices))
    refuse(path, "the file is damaged");
  if (version == 1 && lacks_coordinate(undo)) refuse_version(path, version);
  return undo;
}

}  // namespace reeb::tools
