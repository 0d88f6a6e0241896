#include "libreeb/port/mesh_writer.h"

namespace reeb {

void copy_mesh(MeshReader& reader, MeshWriter& writer) {
  for (MeshBatch batch; reader.read(batch);) writer.write(batch);
  writer.close();
}

}  // namespace reeb
