#include "tools/arguments/image_options.h"

#include <string>

#include "libreeb/base/error.h"
#include "tools/arguments/options.h"

namespace reeb::tools {

void add_image_options(Command command, io::ImageOptions& image) {
  command.add_option("--grid", image.grid, "Vertices of a raw image along each axis: 512x512x300")
      .type_name("NXxNY[xNZ]");
  command
      .add_option("--type", image.type,
                  "Values of a raw image: u8, i8, or u16, i16, u32, i32, u64, i64, f32 or f64 followed by le or be")
      .type_name("TYPE");
  command.add_option("--spacing", image.spacing, "Spacing of a raw image along each axis: 1,1,2.5 (default: 1)")
      .type_name("A,B[,C]");
  add_count(command, "--skip", image.skip_bytes, "Bytes before the values of a raw image (default: 0)");
  command
      .add_option(
          "--nodata",
          [&image](const std::string& text) {
            if (text != "skip")
              throw Error(ErrorKind::kUsage, "--nodata takes skip, not '" + text + "'",
                          "--nodata skip leaves out vertices without data");
            image.skip_nodata = true;
          },
          "Leave out vertices of an image without data (NaN, or what the header says)")
      .type_name("skip");
}

void refuse_image_options(const io::ImageOptions& image) {
  if (image.is_raw() || image.skip_nodata)
    throw Error(ErrorKind::kUsage, "--grid, --type, --spacing, --skip and --nodata say how a mesh is read",
                "name it with --mesh MESH, or leave them out");
}

}  // namespace reeb::tools
