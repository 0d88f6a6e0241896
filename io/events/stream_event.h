// The event model of streaming meshes (Isenburg and Lindstrom, Streaming Meshes, 2005).
//
// A streaming mesh is one sequence in which vertices, cells and finalizations are interleaved.
// In *pre-order* every vertex precedes the cells that use it; in *post-order* it follows them all
// and is final in the moment it arrives. An EventReader delivers exactly the sequence of the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace reeb::io {

enum class EventKind : std::uint8_t { kVertex, kTriangle, kTetrahedron, kFinalized };

inline constexpr std::size_t kMaxFloats = 8;  // of one vertex, x, y, z included, or of one cell
inline constexpr std::size_t kMaxInts = 8;

// Vertices are numbered from 0 in order of arrival; numbers fit in 31 bits.
struct StreamEvent {
  EventKind kind;
  std::uint32_t vertex;                  // kVertex, kFinalized
  std::array<std::uint32_t, 4> corners;  // kTriangle: three, kTetrahedron: four
  // The first StreamHeader::vertex_floats (or cell_floats) and vertex_ints (cell_ints) are set.
  std::array<float, kMaxFloats> floats;
  std::array<std::int32_t, kMaxInts> ints;
};

struct StreamBox {
  std::array<float, 3> min, max;
};

// What the head of a file says. Counts are hints: absent, or not to be trusted.
struct StreamHeader {
  std::string format;  // "SMA", "SMC version 3"
  bool volume = false;
  bool post_order = false;
  std::optional<std::uint32_t> vertex_count, cell_count;
  std::optional<StreamBox> box;
  std::vector<std::string> comments;
  unsigned vertex_floats = 3, vertex_ints = 0;  // x, y, z are the first three floats
  unsigned cell_floats = 0, cell_ints = 0;
};

class EventReader {
 public:
  EventReader() = default;
  EventReader(const EventReader&) = delete;
  EventReader& operator=(const EventReader&) = delete;
  virtual ~EventReader() = default;

  // Complete as soon as the reader exists.
  const StreamHeader& header() const { return header_; }

  // The next event, valid until the next call; null at the regular end of the stream.
  // THROWS: Error{kBadInput} whose message starts with the class of the fault ("BAD_INDEX: ...");
  //         all events before the fault are delivered first.
  const StreamEvent* next() { return at_ < count_ || refill() ? &queue_[at_++] : nullptr; }

  const std::string& name() const { return name_; }
  // What error messages call the input from now on.
  void set_name(std::string name) { name_ = std::move(name); }

  // "COUNT: ...", one line each. Final once next() has returned null.
  virtual std::vector<std::string> warnings() const { return warnings_; }
  // How much of the input was consumed, in bytes as it lies on disk.
  virtual std::uint64_t bytes_read() const = 0;

 protected:
  // Appends the next events by push(), at least one unless the stream ends.
  virtual void fill() = 0;

  StreamEvent& push(EventKind kind) {
    if (count_ == queue_.size()) queue_.resize(count_ == 0 ? 256 : 2 * count_);
    queue_[count_].kind = kind;
    return queue_[count_++];
  }
  void push_finalized(std::uint32_t vertex) { push(EventKind::kFinalized).vertex = vertex; }
  std::size_t queued() const { return count_; }
  void warn(std::string text) { warnings_.push_back(std::move(text)); }

  StreamHeader header_;

 private:
  bool refill();

  std::string name_;
  std::vector<StreamEvent> queue_;  // reused; only the first count_ entries are events
  std::size_t at_ = 0, count_ = 0;
  std::exception_ptr fault_;  // met after the queued events
  std::vector<std::string> warnings_;
};

}  // namespace reeb::io
