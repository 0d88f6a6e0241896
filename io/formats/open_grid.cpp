#include "io/formats/open_grid.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "io/file/file_name.h"
#include "io/formats/format_detection.h"
#include "io/images/esri_grid.h"
#include "io/images/image_reader.h"
#include "io/images/meta_image.h"
#include "io/images/nifti.h"
#include "io/images/nrrd.h"
#include "io/images/numpy.h"
#include "io/images/vti.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;

Image parse(ImageFormat format, ContentSource& source, const GridOptions& options) {
  switch (format) {
    case ImageFormat::kNrrd:
      return parse_nrrd(source);
    case ImageFormat::kNifti:
      return parse_nifti(source);
    case ImageFormat::kMetaImage:
      return parse_meta_image(source);
    case ImageFormat::kNumpy:
      return parse_numpy(source);
    case ImageFormat::kVti:
      return parse_vti(source);
    case ImageFormat::kEsriGrid:
      return parse_esri_grid(source);
    case ImageFormat::kRaw:
      break;
  }
  return raw_image(options.raw);
}

// A header of a stranger must not make the program read files elsewhere.
std::string data_path(const std::string& header, const std::string& data_file) {
  const fs::path name(data_file);
  if (name.is_absolute() || std::ranges::find(name, fs::path("..")) != name.end())
    throw Error(ErrorKind::kBadInput, "the data file \"" + data_file + "\" is not in the folder of the header",
                "put both into one folder, and name the data file without its folder in the header");
  const std::string path = (fs::path(header).parent_path() / name).string();
  std::error_code error;  // of a name that cannot be one; reading the file says so
  if (fs::exists(path, error)) return path;
  for (const char* suffix : {".gz", ".zst"})
    if (fs::exists(path + suffix, error)) return path + suffix;
  return path;
}

}  // namespace

std::optional<ImageFormat> detect_image(ContentSource& source, const std::string& path) {
  if (const auto format = image_format_of(source.view(0))) return format;
  const std::string suffix = content_suffix(path);
  if (suffix != ".raw" && suffix != ".asc") return std::nullopt;
  if (detect_format(source, path) != MeshFormat::kUnknown) return std::nullopt;
  return suffix == ".raw" ? ImageFormat::kRaw : ImageFormat::kEsriGrid;
}

std::string grid_data_file(ContentSource& source, const std::string& path, std::optional<ImageFormat> format) {
  if (!format) format = detect_image(source, path);
  constexpr std::array kWithDataFiles = {ImageFormat::kNrrd, ImageFormat::kNifti, ImageFormat::kMetaImage};
  if (!format || std::ranges::find(kWithDataFiles, *format) == kWithDataFiles.end()) return {};
  try {
    const Image image = parse(*format, source, {});
    return image.data_file.empty() ? std::string() : data_path(path, image.data_file);
  } catch (Error& error) {
    error.at(source.name());
    throw;
  }
}

std::unique_ptr<GridReader> open_grid(const Input& input, std::unique_ptr<ContentSource> source,
                                      const GridOptions& options) {
  const std::string name = source->name();
  try {
    const auto format = options.format ? options.format : detect_image(*source, input.path());
    if (!format)
      throw Error(ErrorKind::kBadInput, "this is not an image of a known format",
                  "NRRD, NIfTI-1, MetaImage, VTI, NumPy, ESRI ASCII and raw images are read")
          .at(name, "0");
    Image image = parse(*format, *source, options);
    if (image.from_start) {
      if (!input.can_reopen())
        throw Error(ErrorKind::kBadInput, "the header is too long for an input that can be read only once",
                    "write the image to a file, and name that")
            .at(name);
      source = input.open();
    }
    if (image.data_file.empty()) return read_image(std::move(image), input, std::move(source));
    // Which files a run reads is known before any work only if its header can be read twice.
    if (!input.can_reopen())
      throw Error(ErrorKind::kBadInput, "the data are in another file, which a pipe does not have",
                  "name the file of the header");
    Input data(data_path(input.path(), image.data_file));
    if (!data.can_reopen())
      throw Error(ErrorKind::kBadInput, "the data file of a header is not a regular file", "copy the data into a file")
          .at(data.path());
    source = data.open();
    // A file that is packed as a whole is unpacked already.
    if (source->file() == nullptr && image.packing == Packing::kZlib) image.packing = Packing::kPlain;
    return read_image(std::move(image), std::move(data), std::move(source));
  } catch (Error& error) {
    error.at(name);
    throw;
  }
}

std::unique_ptr<GridReader> open_grid(const std::string& path, const GridOptions& options) {
  const Input input(path);
  return open_grid(input, input.open(), options);
}

}  // namespace reeb::io
