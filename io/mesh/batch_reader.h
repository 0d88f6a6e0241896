// What all mesh readers share: batches with a bounded number of events.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class BatchReader : public MeshReader {
 public:
  const MeshInfo& info() const final { return info_; }

  // Sets the size of later batches.
  void set_batch_events(std::size_t count) { options_.batch_events = std::max<std::size_t>(count, 1); }

  bool read(MeshBatch& batch) final {
    batch.clear();
    batch.first_vertex = VertexId(vertices_read_);
    batch.coordinates.resize(info_.dimension);
    batch.properties.resize(options_.properties.size());
    paused_ = false;
    fill(batch);
    return paused_ || !batch.empty();
  }

 protected:
  explicit BatchReader(ReadOptions options) : options_(std::move(options)) { set_batch_events(options_.batch_events); }

  // Call it when info_ is known, if the format has properties.
  void name_all_properties() {
    if (!options_.all_properties) return;
    requested_ = std::move(options_.properties);
    options_.properties = info_.property_names;
  }
  // Whether nobody named this property, so that it is delivered for a copy of the mesh only.
  bool is_carried(const std::string& property) const {
    return options_.all_properties && std::ranges::find(requested_, property) == requested_.end();
  }

  // Adds events in the order of the file while room() is left. Adds none only at the end, or after pause().
  virtual void fill(MeshBatch& batch) = 0;

  // For a reader that adds simplices up to dimension kMost.
  template <std::size_t kMost = 2>
  std::size_t room(const MeshBatch& batch) const {
    const std::size_t used = batch.vertex_count + batch.simplex_count<kMost>();
    return options_.batch_events - std::min(used, options_.batch_events);
  }

  // The batch may be empty, but the mesh goes on.
  void pause() { paused_ = true; }

  // Counts vertices after their columns were filled.
  void count_vertices(MeshBatch& batch, std::size_t count) {
    batch.vertex_count += count;
    vertices_read_ += count;
  }
  std::uint64_t vertices_read() const { return vertices_read_; }

  const ReadOptions& options() const { return options_; }
  // What is added to each number: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing.
  double zero() const { return options_.signed_zeros ? -0.0 : 0.0; }

  MeshInfo info_;

 private:
  ReadOptions options_;
  std::vector<std::string> requested_;  // properties, if all are delivered
  std::uint64_t vertices_read_ = 0;
  bool paused_ = false;
};

// For formats whose vertices have nothing but coordinates.
// THROWS: Error{kBadInput} if a property is requested.
void refuse_properties(const ReadOptions& options, const std::string& format, const std::string& file);

}  // namespace reeb::io
