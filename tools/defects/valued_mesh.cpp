#include "tools/defects/valued_mesh.h"

#include "io/formats/open_input.h"
#include "io/functions/function_source.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/spooled_mesh.h"

namespace reeb::tools {

void MeshSource::check_interruption() const {
  if (interrupted && interrupted()) throw Error(ErrorKind::kInterrupted, "interrupted", "run the same command again");
}

ValuedMesh::ValuedMesh(const MeshSource& source, std::span<const std::string> functions)
    : source_(source), input_(io::mesh_input(source.path, source.format)) {
  for (const std::string& function : functions) specs_.push_back(io::parse_function(function));
  properties_ = io::needed_properties(specs_);
  info_ = open()->info();
  fields_ = io::read_fields(
      specs_, [this] { return open(); }, source.path, source.temp_folder, source.memory_bytes);
}

std::unique_ptr<MeshReader> ValuedMesh::open() const {
  return io::open_mesh(input_, input_.open(), {.properties = properties_, .temp_folder = source_.temp_folder},
                       source_.image, source_.format);
}

void ValuedMesh::read(const Observe& observe) const {
  input_.read([&] {
    const auto reader = open();
    std::vector<std::unique_ptr<io::FunctionSource>> functions;
    for (std::size_t k = 0; k < specs_.size(); ++k) {
      functions.push_back(
          std::make_unique<io::FunctionSource>(specs_[k], reader->info(), properties_, source_.path, &fields_[k]));
      if (functions.back()->needs_lookup()) functions.back()->look_up(*open());
    }
    std::vector<std::vector<double>> values(specs_.size());
    MeshBatch batch;
    while (reader->read(batch)) {
      source_.check_interruption();
      for (std::size_t k = 0; k < specs_.size(); ++k) {
        values[k].resize(batch.vertex_count);
        functions[k]->evaluate(batch, values[k]);
      }
      observe(batch, values, reader->bytes_read(), reader->info().file_bytes);
    }
  });
}

void ValuedMesh::look_up(ooc::Workspace& space, const std::function<void(IndexedMesh&)>& use) const {
  input_.read([&] {
    const auto reader = open();
    auto mesh = reader->indexed();
    if (!mesh) mesh = ooc::spool(*reader, space.temp, space.budget);
    use(*mesh);
  });
}

void refuse_cells(const std::string& mesh, bool is_image) {
  throw Error(ErrorKind::kBadInput, "the mesh has cells, so it is not a surface",
              is_image ? "make an isosurface of the image with another program first"
                       : "extract its boundary with another program first")
      .at(mesh);
}

}  // namespace reeb::tools
