#include "tools/repair/write_repaired.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "io/file/content_source.h"
#include "io/formats/open_input.h"
#include "libreeb/base/error.h"
#include "tools/repair/mesh_output.h"

namespace reeb::tools {
namespace {

// How many coordinates of a vertex an undo file has. Formats such as PLY write a third one, 0, for a mesh of two.
std::size_t undo_coordinates(std::size_t dimension) { return std::max<std::size_t>(dimension, 3); }

void clear(MeshBatch& batch, std::size_t coordinates, std::size_t properties) {
  batch.clear();
  batch.vertex_count = 0;
  batch.coordinates.resize(coordinates);
  batch.properties.resize(properties);
  for (auto* columns : {&batch.coordinates, &batch.properties})
    for (auto& column : *columns) column.clear();
}

class RepairedCopy {
 public:
  RepairedCopy(const MeshSource& source, const MeshEdits& edits, std::uint64_t mesh_vertices,
               const WriteOptions& options)
      : source_(source),
        edits_(edits),
        mesh_vertices_(mesh_vertices),
        options_(options),
        input_(io::mesh_input(source.path, source.format)),
        renumbering_(edits.dropped) {
    for (const NewVertex& vertex : edits.vertices)
      for (const VertexRef& parent : vertex.parents)
        if (!parent.is_new) parents_.push_back(parent.number);
    std::sort(parents_.begin(), parents_.end());
    parents_.erase(std::unique(parents_.begin(), parents_.end()), parents_.end());
  }

  Written run(std::uint64_t mesh_triangles, const std::function<void(const Written&)>& before_commit) {
    const auto reader = open_for_copy(input_, source_, options_.output);
    properties_ = options_.output.empty() ? 0 : count_properties(*reader);
    writer_ = create_like(input_, *reader, options_.output, kept_vertices() + edits_.vertices.size(),
                          source_.temp_folder, options_.existing);
    count_columns(reader->info().dimension);
    parent_values_.resize(parents_.size() * properties_);
    input_.read([&] {
      MeshBatch batch;
      while (reader->read(batch)) {
        if (batch.has_cells()) refuse_cells(source_.path, reader->info().grid.has_value());
        copy(batch);
        if (vertex_ == mesh_vertices_ && !new_written_) write_new_vertices(reader->info().dimension);
        if (options_.progress) options_.progress(reader->bytes_read(), reader->info().file_bytes, triangle_);
      }
      if (vertex_ != mesh_vertices_ || triangle_ != mesh_triangles) throw input_changed();
      if (!new_written_) write_new_vertices(reader->info().dimension);
    });
    write_new_triangles(reader->info().dimension);
    written_.warnings = reader->warnings();
    finish_record();
    before_commit(written_);
    writer_->close();
    for (std::string& warning : writer_->warnings()) written_.warnings.push_back(std::move(warning));
    return std::move(written_);
  }

 private:
  std::uint64_t kept_vertices() const { return mesh_vertices_ - edits_.dropped.size(); }

  static std::size_t count_properties(const MeshReader& reader) { return reader.info().property_names.size(); }

  void count_columns(std::size_t dimension) {
    written_.undo.columns = static_cast<std::uint32_t>(undo_coordinates(dimension) + properties_);
  }

  void copy(MeshBatch& batch) {
    // Only PLY has columns for them.
    properties_ = batch.properties.size();
    parent_values_.resize(parents_.size() * properties_);
    count_columns(batch.coordinates.size());
    drop_vertices(batch);
    remove_triangles(batch);
    batch.finalized.clear();
    write(batch);
  }

  void drop_vertices(MeshBatch& batch) {
    const std::uint64_t first = vertex_;
    const std::size_t columns = batch.coordinates.size() + batch.properties.size();
    for (; parent_ < parents_.size() && parents_[parent_] < first + batch.vertex_count; ++parent_)
      for (std::size_t k = 0; k < properties_; ++k)
        parent_values_[parent_ * properties_ + k] = batch.properties[k][parents_[parent_] - first];
    std::size_t end = dropped_;
    while (end < edits_.dropped.size() && edits_.dropped[end] < first + batch.vertex_count) ++end;
    if (options_.keep_undo)
      for (std::size_t i = dropped_; i < end; ++i) keep_values(batch, edits_.dropped[i] - first);
    if (end > dropped_) {
      for (std::size_t k = 0; k < columns; ++k) {
        std::vector<double>& column = batch.column(k);
        std::size_t next = dropped_, to = 0;
        for (std::size_t i = 0; i < batch.vertex_count; ++i) {
          if (next < end && edits_.dropped[next] == first + i)
            ++next;
          else
            column[to++] = column[i];
        }
        column.resize(to);
      }
    }
    vertex_ += batch.vertex_count;
    batch.first_vertex = VertexId(first - dropped_);
    batch.vertex_count -= end - dropped_;
    dropped_ = end;
  }

  void keep_values(const MeshBatch& batch, std::size_t vertex) {
    std::vector<double>& values = written_.undo.values;
    for (const auto& column : batch.coordinates) values.push_back(column[vertex]);
    values.insert(values.end(), undo_coordinates(batch.coordinates.size()) - batch.coordinates.size(), 0.0);
    for (const auto& column : batch.properties) values.push_back(column[vertex]);
  }

  void remove_triangles(MeshBatch& batch) {
    auto& corners = batch.triangles();
    const std::size_t count = corners.size() / 3;
    if (removed_ < edits_.removed.size() && edits_.removed[removed_] < triangle_ + count) {
      std::size_t to = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (removed_ < edits_.removed.size() && edits_.removed[removed_] == triangle_ + i) {
          ++removed_;
          if (options_.keep_undo)
            for (std::size_t k = 0; k < 3; ++k) written_.undo.corners.push_back(corners[3 * i + k].value());
          continue;
        }
        for (std::size_t k = 0; k < 3; ++k) corners[to++] = corners[3 * i + k];
      }
      corners.resize(to);
    }
    triangle_ += count;
    if (renumbering_.is_identity()) return;
    for (auto& simplices : batch.simplices)
      for (VertexId& v : simplices) v = VertexId(renumbering_.after(v.value()));
  }

  std::uint64_t number(const VertexRef& ref) const {
    return ref.is_new ? kept_vertices() + ref.number : renumbering_.after(ref.number);
  }

  void write_new_vertices(unsigned dimension) {
    new_written_ = true;
    if (edits_.vertices.empty()) return;
    MeshBatch batch;
    clear(batch, dimension, properties_);
    batch.first_vertex = VertexId(kept_vertices());
    batch.vertex_count = edits_.vertices.size();
    for (const NewVertex& vertex : edits_.vertices) {
      for (unsigned k = 0; k < dimension; ++k) batch.coordinates[k].push_back(k < 3 ? vertex.position[k] + 0.0 : 0.0);
      for (std::size_t k = 0; k < properties_; ++k) {
        double sum = 0;
        for (const VertexRef& parent : vertex.parents) {
          const auto place = std::ranges::lower_bound(parents_, parent.number) - parents_.begin();
          sum += parent.is_new ? batch.properties[k][parent.number]
                               : parent_values_[static_cast<std::size_t>(place) * properties_ + k];
        }
        batch.properties[k].push_back(sum / 3);
      }
    }
    write(batch);
  }

  void write_new_triangles(unsigned dimension) {
    MeshBatch batch;
    clear(batch, dimension, properties_);
    batch.first_vertex = VertexId(written_.vertices);
    for (const auto& corners : edits_.triangles)
      for (const VertexRef& corner : corners) batch.triangles().emplace_back(number(corner));
    if (!batch.triangles().empty()) write(batch);
  }

  void write(const MeshBatch& batch) {
    written_.vertices += batch.vertex_count;
    written_.triangles += batch.triangle_count();
    if (options_.keep_undo) digest_.add(batch);
    writer_->write(batch);
  }

  void finish_record() {
    if (!options_.keep_undo) return;
    UndoRecord& undo = written_.undo;
    undo.vertices = written_.vertices;
    undo.triangles = written_.triangles;
    undo.new_vertices = edits_.vertices.size();
    undo.new_triangles = edits_.triangles.size();
    undo.digest = digest_.value();
    undo.dropped = edits_.dropped;
    undo.removed = edits_.removed;
  }

  const MeshSource& source_;
  const MeshEdits& edits_;
  const std::uint64_t mesh_vertices_;
  const WriteOptions& options_;
  io::Input input_;
  Renumbering renumbering_;
  std::unique_ptr<MeshWriter> writer_;
  std::vector<std::uint64_t> parents_;  // vertices of the mesh between which new ones are
  std::vector<double> parent_values_;
  std::size_t properties_ = 0;
  std::size_t dropped_ = 0, removed_ = 0, parent_ = 0;  // so far
  std::uint64_t vertex_ = 0, triangle_ = 0;             // of the mesh, so far
  bool new_written_ = false;
  MeshDigest digest_;
  Written written_;
};

// Makes the mesh before a repair of the mesh after it.
class Restoration {
 public:
  Restoration(const UndoRecord& undo, unsigned dimension)
      : undo_(undo), dimension_(dimension), renumbering_(undo.dropped) {}

  // Adds to `out` what `batch` has of the former mesh, and what comes before, between and after that. `written` counts
  // what came before. REQUIRES: `out` is empty.
  void restore(const MeshBatch& batch, const Written& written, MeshBatch& out) {
    add_dropped(written, out);
    add_removed(written, out);
    const std::uint64_t kept = undo_.vertices - undo_.new_vertices;
    for (std::size_t i = 0; i < batch.vertex_count; ++i, ++vertex_) {
      if (vertex_ >= kept) continue;
      for (std::size_t k = 0; k < dimension_ + batch.properties.size(); ++k)
        out.column(k).push_back(batch.column(k)[i]);
      ++out.vertex_count;
      add_dropped(written, out);
    }
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
      for (const VertexId v : batch.simplices[k]) out.simplices[k].emplace_back(renumbering_.before(v.value()));
    const auto& corners = batch.triangles();
    const std::uint64_t kept_triangles = undo_.triangles - undo_.new_triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3, ++triangle_) {
      if (triangle_ >= kept_triangles) continue;
      for (std::size_t k = 0; k < 3; ++k) out.triangles().emplace_back(renumbering_.before(corners[i + k].value()));
      add_removed(written, out);
    }
  }

  // Whether there was more, or as much, as the repaired mesh has.
  bool is_beyond() const { return vertex_ > undo_.vertices || triangle_ > undo_.triangles; }
  bool is_complete() const { return vertex_ == undo_.vertices && triangle_ == undo_.triangles; }

 private:
  // The vertices, and the triangles, that come next.
  void add_dropped(const Written& written, MeshBatch& out) {
    const std::size_t columns = dimension_ + out.properties.size();
    for (; dropped_ < undo_.dropped.size() && undo_.dropped[dropped_] == written.vertices + out.vertex_count;
         ++dropped_, ++out.vertex_count)
      for (std::size_t k = 0; k < columns; ++k) {
        const std::size_t kept = k < dimension_ ? k : undo_coordinates(dimension_) + k - dimension_;
        out.column(k).push_back(kept < undo_.columns ? undo_.values[dropped_ * undo_.columns + kept] : 0);
      }
  }
  void add_removed(const Written& written, MeshBatch& out) {
    for (; removed_ < undo_.removed.size() && undo_.removed[removed_] == written.triangles + out.triangles().size() / 3;
         ++removed_)
      for (std::size_t k = 0; k < 3; ++k) out.triangles().emplace_back(undo_.corners[3 * removed_ + k]);
  }

  const UndoRecord& undo_;
  const unsigned dimension_;
  const Renumbering renumbering_;
  std::uint64_t vertex_ = 0, triangle_ = 0;  // of the repaired mesh, so far
  std::size_t dropped_ = 0, removed_ = 0;    // put back so far
};

[[noreturn]] void refuse_other_mesh(const std::string& path) {
  throw Error(ErrorKind::kBadInput, "this is not the mesh that was written with the undo file",
              "name the output of that repair, unchanged")
      .at(path);
}

}  // namespace

Written write_repaired(const MeshSource& source, const MeshEdits& edits, std::uint64_t mesh_vertices,
                       std::uint64_t mesh_triangles, const WriteOptions& options,
                       const std::function<void(const Written&)>& before_commit) {
  return RepairedCopy(source, edits, mesh_vertices, options).run(mesh_triangles, before_commit);
}

Written write_undone(const MeshSource& source, const UndoRecord& undo, const WriteOptions& options) {
  const io::Input input = io::mesh_input(source.path, source.format);
  const auto reader = open_for_copy(input, source, options.output);
  const unsigned dimension = reader->info().dimension;
  const auto writer =
      create_like(input, *reader, options.output, undo.vertices - undo.new_vertices + undo.dropped.size(),
                  source.temp_folder, options.existing);
  Restoration restoration(undo, dimension);
  Written written;
  MeshDigest digest;
  MeshBatch batch, out;
  input.read([&] {
    while (true) {
      const bool more = reader->read(batch);
      if (more) {
        if (batch.has_cells()) refuse_cells(source.path, reader->info().grid.has_value());
        digest.add(batch);
      }
      const std::size_t properties = batch.properties.size();
      clear(out, dimension, properties);
      out.first_vertex = VertexId(written.vertices);
      restoration.restore(batch, written, out);
      if (restoration.is_beyond()) refuse_other_mesh(source.path);
      written.vertices += out.vertex_count;
      written.triangles += out.triangle_count();
      if (!out.empty()) writer->write(out);
      if (options.progress) options.progress(reader->bytes_read(), reader->info().file_bytes, written.triangles);
      if (!more) return;
    }
  });
  if (!restoration.is_complete() || digest.value() != undo.digest) refuse_other_mesh(source.path);
  writer->close();
  written.warnings = reader->warnings();
  for (std::string& warning : writer->warnings()) written.warnings.push_back(std::move(warning));
  return written;
}

}  // namespace reeb::tools
