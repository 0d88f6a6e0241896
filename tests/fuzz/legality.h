// The rules that every reader must follow in the events that it delivers, whatever its input is.
//
// A violation is printed and aborts the process, as a finding of a sanitizer does, so that all fuzzing tools treat it
// the same.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/events/stream_event.h"
#include "libreeb/base/error.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

[[noreturn]] void violation(const std::string& what);
void expect(bool holds, const char* promise);

// Expects that an error has a message and a hint, and that the user can fix its cause.
void expect_helpful(const Error& error);

// The message of the error that ends the reading, which must have a hint; empty if there is none.
template <class Reading>
std::string error_of(const Reading& reading) {
  try {
    reading();
    return {};
  } catch (const Error& error) {
    expect_helpful(error);
    return error.message();
  }
}

// What was delivered, without the order between vertices, simplices of each dimension and finalizations, which depends
// on the batch size.
struct Delivered {
  std::uint64_t vertices = 0, simplices = 0, finalized = 0;
  std::uint64_t vertex_digest = 0, final_digest = 0;
  std::array<std::uint64_t, kMaxSimplexDimension + 1> simplex_digests{};  // by dimension
  bool whole = false;                                                     // complete, up to the regular end of the mesh
  friend bool operator==(const Delivered&, const Delivered&) = default;
};

// The rules of libreeb/port/mesh_reader.h.
class BatchLegality {
 public:
  void add(const MeshBatch& batch, const MeshInfo& info, std::size_t properties);
  Delivered& delivered() { return delivered_; }

 private:
  void add_vertices(const MeshBatch& batch);
  void add_simplices(const std::vector<VertexId>& corners, std::size_t corners_each);

  Delivered delivered_;
  std::vector<bool> final_;
};

// The rules of a legal stream, in pre-order and in post-order (io/events/stream_event.h).
class EventLegality {
 public:
  void add(const StreamEvent& event, const StreamHeader& header);
  void end() const;
  std::uint64_t vertices() const { return final_.size(); }
  std::uint64_t cells() const { return cells_; }

 private:
  std::vector<bool> final_;
  std::uint64_t cells_ = 0, named_end_ = 0;
};

}  // namespace reeb::io
