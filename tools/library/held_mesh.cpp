#include "tools/library/held_mesh.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/port/wrapped_reader.h"

namespace reeb {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::kBadInput, "the reader of the mesh is wrong: " + what,
              "mesh_reader.h says what a reader delivers");
}

class CheckedReader : public WrappedReader {
 public:
  CheckedReader(std::unique_ptr<MeshReader> reader, std::size_t properties)
      : WrappedReader(std::move(reader)), properties_(properties) {}

  bool read(MeshBatch& batch) override {
    if (!WrappedReader::read(batch)) return false;
    check_columns(batch);
    check_vertices(batch);
    return true;
  }

 private:
  void check_columns(const MeshBatch& batch) const {
    const auto check = [&](const std::vector<std::vector<double>>& columns, std::size_t count, const char* name) {
      if (batch.vertex_count != 0 && columns.size() != count)
        refuse("a batch has " + std::to_string(columns.size()) + " columns of " + name + ", not " +
               std::to_string(count));
      for (const auto& column : columns)
        if (column.size() != batch.vertex_count)
          refuse("a column of " + std::string(name) + " has " + std::to_string(column.size()) + " numbers for " +
                 std::to_string(batch.vertex_count) + " vertices");
    };
    check(batch.coordinates, info().dimension, "coordinates");
    check(batch.properties, properties_, "properties");
  }

  void check_vertices(const MeshBatch& batch) {
    if (batch.vertex_count != 0) {
      const std::uint64_t first = batch.first_vertex.value();
      const bool may_skip = info().number_count.has_value();
      if (first < vertices_ || (first > vertices_ && !may_skip) || batch.vertex_count > ~first)
        refuse("a batch begins with vertex " + std::to_string(first) + ", and the one before ends before vertex " +
               std::to_string(vertices_));
      vertices_ = first + batch.vertex_count;
    }
    for (std::size_t k = 0; k < batch.simplices.size(); ++k) {
      if (batch.simplices[k].size() % (k + 1) != 0)
        refuse("a simplex of dimension " + std::to_string(k) + " lacks corners");
      check_names(batch.simplices[k], "a simplex names");
    }
    check_names(batch.finalized, "what is final includes");
  }

  void check_names(const std::vector<VertexId>& ids, const char* what) const {
    const auto unknown = std::ranges::find_if(ids, [this](VertexId v) { return v.value() >= vertices_; });
    if (unknown != ids.end())
      refuse(std::string(what) + " vertex " + std::to_string(unknown->value()) + ", but so far there are " +
             std::to_string(vertices_));
  }

  std::size_t properties_;
  std::uint64_t vertices_ = 0;  // that were delivered, or skipped
};

}  // namespace

std::unique_ptr<MeshReader> open_held(const MeshOpener& open, const ReadOptions& options) {
  std::unique_ptr<MeshReader> reader = open(options);
  if (reader == nullptr) refuse("there is none");
  const MeshInfo& info = reader->info();
  if (info.dimension == 0) refuse("a mesh has at least one coordinate");
  for (const std::string& name : options.properties)
    if (std::ranges::find(info.property_names, name) == info.property_names.end())
      throw Error(ErrorKind::kBadInput, "the mesh has no vertex property \"" + name + "\"",
                  "name a property that MeshInfo::property_names lists");
  std::size_t properties = options.all_properties ? info.property_names.size() : options.properties.size();
  if (properties == 0 && options.value_of_image && info.grid) properties = 1;
  return std::make_unique<CheckedReader>(std::move(reader), properties);
}

}  // namespace reeb
