// A mesh that is read for the first time while chunks are cut from it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "io/file/checksum.h"
#include "libreeb/base/ids.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/chunks/spooled_mesh.h"

namespace reeb::ooc {

class FirstReading {
 public:
  FirstReading() = default;
  FirstReading(const FirstReading&) = delete;
  FirstReading& operator=(const FirstReading&) = delete;
  virtual ~FirstReading() = default;

  // The next triangles, three corners each, at most `most` of them; none at the end. Valid until the next call.
  virtual std::span<const VertexId> next(std::size_t most) = 0;
  // Looks up the vertices of all triangles so far. REQUIRES: next() was called.
  virtual IndexedMesh& mesh() = 0;
  virtual std::uint64_t digest() const = 0;  // of what was read so far
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t bytes_total() const = 0;
};

// A mesh that a Spooler reads and stores.
class SpooledReading : public FirstReading {
 public:
  explicit SpooledReading(Spooler& spooler) : spooler_(spooler) {}

  std::span<const VertexId> next(std::size_t most) override {
    while (!ended_ && taken_ == spooler_.triangles().size()) {
      taken_ = 0;
      ended_ = !spooler_.read();
    }
    if (ended_) return {};
    const auto rest = std::span(spooler_.triangles()).subspan(taken_);
    const auto triangles = rest.first(std::min(3 * most, rest.size()));
    taken_ += triangles.size();
    return triangles;
  }
  IndexedMesh& mesh() override { return spooler_.mesh(); }
  std::uint64_t digest() const override { return spooler_.digest(); }
  std::uint64_t bytes_read() const override { return spooler_.reader().bytes_read(); }
  std::uint64_t bytes_total() const override { return spooler_.reader().info().file_bytes; }

 private:
  Spooler& spooler_;
  std::size_t taken_ = 0;  // corners of the spooler's batch that were delivered
  bool ended_ = false;
};

// A mesh that can be looked up where it is.
class ReadingInPlace : public FirstReading {
 public:
  explicit ReadingInPlace(IndexedMesh& mesh) : mesh_(mesh) { mesh_.rewind(); }

  std::span<const VertexId> next(std::size_t most) override {
    if (!mesh_.read(corners_, most)) return {};
    if (corners_.size() > 3 * most) throw std::logic_error("a mesh gave more triangles than were asked for");
    digest_.add(std::as_bytes(std::span(corners_)));
    return corners_;
  }
  IndexedMesh& mesh() override { return mesh_; }
  std::uint64_t digest() const override { return digest_.value(); }
  std::uint64_t bytes_read() const override { return mesh_.bytes_read(); }
  std::uint64_t bytes_total() const override { return mesh_.bytes_total(); }

 private:
  IndexedMesh& mesh_;
  std::vector<VertexId> corners_;
  io::RunningDigest digest_;
};

}  // namespace reeb::ooc
