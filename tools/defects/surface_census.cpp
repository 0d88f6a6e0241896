#include "tools/defects/surface_census.h"

#include "io/file/content_source.h"
#include "io/formats/open_input.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::tools {

ooc::MeshCensus census_of(const MeshSource& source) {
  const io::Input input = io::mesh_input(source.path, source.format);
  return input.read([&] {
    ooc::Workspace space(source.temp_folder, source.memory_bytes);
    const auto open = [&] { return io::open_mesh(input, input.open(), {}, source.image, source.format); };
    const auto reader = open();
    ooc::CensusOptions census;
    census.progress = [&](const ooc::CensusProgress&) { source.check_interruption(); };
    census.read_again = open;
    if (const auto mesh = reader->indexed()) return ooc::take_census(*mesh, reader->info().dimension, space, census);
    return ooc::take_census(*reader, space, census);
  });
}

}  // namespace reeb::tools
