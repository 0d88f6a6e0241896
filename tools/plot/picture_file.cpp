#include "tools/plot/picture_file.h"

#include "io/file/file_name.h"
#include "libreeb/base/error.h"
#include "tools/plot/child_program.h"

namespace reeb::tools {

PictureFormat picture_format(const std::string& output) {
  if (output == "-") return PictureFormat::kSvg;
  const std::string suffix = io::name_suffix(output);
  if (suffix == ".svg") return PictureFormat::kSvg;
  if (suffix == ".png") return PictureFormat::kPng;
  if (suffix == ".pdf") return PictureFormat::kPdf;
  throw Error(ErrorKind::kUsage, "cannot tell the format of the picture from this name",
              "end the name in .svg, .png or .pdf")
      .at(output);
}

void require_programs(PictureFormat format) {
  if (format != PictureFormat::kSvg) find_program(kRsvgConvert);
}

std::string picture_bytes(std::string svg, PictureFormat format, const std::string& temp_folder) {
  switch (format) {
    case PictureFormat::kSvg:
      return svg;
    case PictureFormat::kPng:
      return run_program(kRsvgConvert, {"-f", "png", "-z", std::to_string(kPngScale)}, svg, temp_folder);
    case PictureFormat::kPdf:
      return run_program(kRsvgConvert, {"--format=pdf"}, svg, temp_folder);
  }
  return svg;
}

}  // namespace reeb::tools
