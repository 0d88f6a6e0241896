// A reader that passes each call on to another reader. Derived classes override what they change.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb {

class WrappedReader : public MeshReader {
 public:
  explicit WrappedReader(std::unique_ptr<MeshReader> reader) : reader_(std::move(reader)) {}

  const MeshInfo& info() const override { return reader_->info(); }
  bool read(MeshBatch& batch) override { return reader_->read(batch); }
  std::unique_ptr<IndexedMesh> indexed() const override { return reader_->indexed(); }
  bool leave_out_simplices() override { return reader_->leave_out_simplices(); }
  std::uint64_t bytes_read() const override { return reader_->bytes_read(); }
  std::uint64_t memory_bytes() const override { return reader_->memory_bytes(); }
  std::string memory_hint() const override { return reader_->memory_hint(); }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }

 private:
  std::unique_ptr<MeshReader> reader_;
};

}  // namespace reeb
