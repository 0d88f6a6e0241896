// The event model of streaming meshes (Isenburg and Lindstrom, Streaming Meshes, 2005).
//
// A streaming mesh is one sequence in which vertices, cells and finalizations are interleaved. In *pre-order* every
// vertex precedes the cells that use it. In *post-order* it follows all of them and is final as soon as it arrives. An
// EventReader delivers exactly the sequence of the file.
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

inline constexpr std::size_t kMaxFloats = 8;  // per vertex (with x, y, z) and per cell
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

// The head of a file. Counts are hints: they can be absent or wrong.
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

  // Complete from construction on.
  const StreamHeader& header() const { return header_; }

  // The next event, valid until the next call; null at the regular end of the stream.
  // THROWS: Error{kBadInput} whose message starts with the class of the fault ("BAD_INDEX: ...");
  //         all events before the fault are delivered first.
  const StreamEvent* next() { return at_ < count_ || refill() ? &queue_[at_++] : nullptr; }
  // Reads on for next(), but not longer than some events take. False if it takes longer, since many events are held
  // back (pre_order.h): then memory_bytes() has grown, and it can be called again. THROWS: as next().
  bool prepare();

  const std::string& name() const { return name_; }
  // Sets the name of the input in later error messages.
  void set_name(std::string name) { name_ = std::move(name); }

  // One line each, as "COUNT: ...". Complete once next() has returned null.
  virtual std::vector<std::string> warnings() const { return warnings_; }
  // Bytes of the input consumed so far, as stored on disk (before decompression).
  virtual std::uint64_t bytes_read() const = 0;
  // The memory that it holds so far and that grows with the stream.
  virtual std::uint64_t memory_bytes() const { return queue_.capacity() * sizeof(StreamEvent); }

 protected:
  // Appends the next events by push(), at least one unless the stream ends or pause() is called.
  virtual void fill() = 0;
  void pause() { paused_ = true; }

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
  bool paused_ = false;
  std::exception_ptr fault_;  // thrown after the queued events
  std::vector<std::string> warnings_;
};

}  // namespace reeb::io
