#include "io/formats/open_input.h"

#include <optional>
#include <utility>

#include "io/cells/medit_reader.h"
#include "io/cells/msh_reader.h"
#include "io/cells/tetgen_reader.h"
#include "io/file/content_source.h"
#include "io/file/file_name.h"
#include "io/file/input_file.h"
#include "io/formats/cx_reader.h"
#include "io/formats/foreign_format.h"
#include "io/formats/format_detection.h"
#include "io/formats/format_names.h"
#include "io/formats/obj_reader.h"
#include "io/formats/off_reader.h"
#include "io/formats/open_grid.h"
#include "io/formats/stl_reader.h"
#include "io/grids/grid_mesh.h"
#include "io/ply/ply_reader.h"
#include "io/streaming/open_stream.h"
#include "io/streaming/stream_mesh_reader.h"
#include "io/vtk/vtk_reader.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr const char* kFormatsRead =
    "PLY, OBJ, OFF, STL, VTK (.vtk, .vtu, .vtp), MSH, Medit, TetGen (as NAME.ele), CX (as NAME.cx), streaming meshes "
    "(SMA, SMB, SMC, SVA, SVB) and images (NRRD, NIfTI-1, MetaImage, VTI, NPY, ESRI ASCII as NAME.asc) are read, plain "
    "or packed with gzip or zstd";

// The vertices of a TetGen mesh; empty for other meshes.
std::string node_file(const std::string& path, const std::string& format) {
  const bool tetgen = format == "tetgen" || (format.empty() && is_tetgen_name(path));
  return tetgen ? tetgen_nodes(path) : std::string();
}

// The format of an image that is told by other than its content.
std::optional<ImageFormat> told_format(const std::string& path, const std::string& format, const ImageOptions& image) {
  if (image.is_raw() || (format.empty() && content_suffix(path) == ".raw")) return ImageFormat::kRaw;
  return image_format_named(format);
}

// Options of raw files without --grid, which only a raw file needs: the content can be another one.
// THROWS: Error{kUsage} if it is.
void refuse_raw_options(ContentSource& source, const std::string& path, const std::string& format,
                        const ImageOptions& image) {
  if (!image.is_raw() || !image.grid.empty()) return;
  const bool of_spacing = !image.spacing.empty();
  const std::string option = of_spacing ? "--spacing" : !image.type.empty() ? "--type" : "--skip";
  const auto known = format.empty() ? image_format_of(source.view(0)) : image_format_named(format);
  if (known == ImageFormat::kNumpy && of_spacing)
    throw Error(ErrorKind::kUsage, "--spacing is for raw images; the vertices of a NumPy array are 1 apart",
                "leave it out; an NRRD or NIfTI image can have another spacing")
        .at(path);
  if (known && *known != ImageFormat::kRaw)
    throw Error(ErrorKind::kUsage,
                option + " is for raw images; " + std::string(image_name(*known)) + " says this in its header",
                "leave it out, or change the header")
        .at(path);
  if (content_suffix(path) == ".raw" || known) return;
  const MeshFormat kind = format.empty() ? detect_format(source, path) : chosen_format(format, source);
  if (kind != MeshFormat::kUnknown)
    throw Error(ErrorKind::kUsage, option + " is for raw images, and this is a mesh", "leave it out").at(path);
}

}  // namespace

Input mesh_input(const std::string& path, const std::string& format) {
  const std::string nodes = node_file(path, format);
  // CX and OBJ have no header: a mesh without vertices can be a file without bytes. Streaming meshes have their own
  // error.
  const std::string name = name_for_streams(path, format);
  const std::string suffix = content_suffix(name);
  const bool may_be_empty = suffix == ".cx" || suffix == ".obj" || is_streaming_name(name);
  return {path, nodes.empty() ? std::vector<std::string>{} : std::vector{nodes},
          may_be_empty ? Empty::kAllowed : Empty::kRefused};
}

std::vector<std::string> files_beside(const std::string& path, const std::string& format, const ImageOptions& image) {
  if (std::string nodes = node_file(path, format); !nodes.empty()) return {std::move(nodes)};
  const auto told = told_format(path, format, image);
  if (told == ImageFormat::kRaw || (!told && !format.empty())) return {};
  const Input input = mesh_input(path, format);
  if (!input.can_reopen()) return {};
  std::string data = grid_data_file(*input.open(), path, told);
  return data.empty() ? std::vector<std::string>() : std::vector{std::move(data)};
}

// On a pipe a streaming mesh is recognized from fewer bytes than an image.
std::unique_ptr<MeshReader> open_mesh(const Input& input, std::unique_ptr<ContentSource> source,
                                      const ReadOptions& options, const ImageOptions& image,
                                      const std::string& format) {
  GridOptions grid;
  grid.format = told_format(input.path(), format, image);
  refuse_raw_options(*source, input.path(), format, image);
  if (image.is_raw()) grid.raw = parse_raw_grid(image.grid, image.type, image.spacing, image.skip_bytes);
  if (!grid.format) {
    const bool may_be_image =
        format.empty() && (input.can_reopen() || detect_format(*source, input.path()) == MeshFormat::kUnknown);
    if (!may_be_image || !detect_image(*source, input.path())) {
      auto mesh = open_mesh(std::move(source), input.path(), options, format);
      if (image.skip_nodata)
        throw Error(ErrorKind::kUsage, "--nodata is for images, and this is a mesh", "leave it out").at(input.path());
      return mesh;
    }
  }
  try {
    return make_grid_mesh(open_grid(input, std::move(source), grid), options,
                          {.skip_nodata = image.skip_nodata, .renumber = image.renumber});
  } catch (Error& error) {
    error.at(input.path());
    throw;
  }
}

std::unique_ptr<MeshReader> open_mesh(std::unique_ptr<ContentSource> source, const std::string& path,
                                      const ReadOptions& options, const std::string& format) {
  const std::string name = source->name();
  const MeshFormat kind = format.empty() ? detect_format(*source, path) : chosen_format(format, *source);
  const auto cr = kind == MeshFormat::kUnknown ? std::nullopt : bare_return(*source, kind);
  if (cr)
    throw Error(ErrorKind::kBadInput,
                (kind == MeshFormat::kStreaming ? "UNSUPPORTED: " : "") +
                    std::string("its lines end with CR alone, as on old Macs"),
                "end them with LF or CR LF; for a file that is all text: tr '\\r' '\\n' <OLD >NEW")
        .at(name, "1:" + std::to_string(*cr + 1));
  switch (kind) {
    case MeshFormat::kPly:
      return open_ply(std::move(source), options);
    case MeshFormat::kOff:
      return open_off(std::move(source), options);
    case MeshFormat::kObj:
      return std::make_unique<ObjReader>(std::move(source), options);
    case MeshFormat::kAsciiStl:
      return std::make_unique<AsciiStlReader>(std::move(source), options);
    case MeshFormat::kBinaryStl:
      return std::make_unique<BinaryStlReader>(std::move(source), options);
    case MeshFormat::kStreaming: {
      const std::uint64_t bytes = source->file_bytes();
      return make_stream_mesh_reader(open_stream(std::move(source), name_for_streams(path, format)), options, bytes);
    }
    case MeshFormat::kCx:
      return std::make_unique<CxReader>(std::move(source), options);
    case MeshFormat::kVtkLegacy:
      return open_vtk_legacy(make_reopenable(std::move(source), options.temp_folder), options);
    case MeshFormat::kVtkXml:
      return open_vtk_xml(make_reopenable(std::move(source), options.temp_folder), options);
    case MeshFormat::kMsh:
      return open_msh(make_reopenable(std::move(source), options.temp_folder), options);
    case MeshFormat::kMedit:
      return open_medit(make_reopenable(std::move(source), options.temp_folder), options);
    case MeshFormat::kTetgen:
      return open_tetgen(make_reopenable(std::move(source), options.temp_folder), path, options);
    case MeshFormat::kUnknown:
      break;
  }
  if (const auto image = detect_image(*source, path))
    throw Error(ErrorKind::kBadInput, "this is " + std::string(image_name(*image)) + ", a grid of values, not a mesh",
                kFormatsRead)
        .at(name, "0");
  const ForeignFormat known = foreign_format(source->view(0));
  std::string what = "unknown file format";
  if (!known.name.empty())
    what = "this is " + std::string(known.name) + (known.may_be_mesh ? ", which is not read yet" : ", not a mesh");
  throw Error(ErrorKind::kBadInput, what, known.advice.empty() ? kFormatsRead : std::string(known.advice))
      .at(name, "0");
}

}  // namespace reeb::io
