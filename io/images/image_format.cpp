#include "io/images/image_format.h"

#include <algorithm>

#include "io/images/esri_grid.h"
#include "io/images/meta_image.h"
#include "io/images/nifti.h"
#include "io/images/nrrd.h"
#include "io/images/numpy.h"
#include "io/images/vti.h"

namespace reeb::io {
namespace {

struct KnownFormat {
  ImageFormat format;
  std::string_view name, text;
  bool (*is_it)(std::string_view head);  // null: nothing tells
};
constexpr KnownFormat kFormats[] = {{ImageFormat::kNrrd, "nrrd", "an NRRD image", is_nrrd},
                                    {ImageFormat::kNifti, "nifti", "a NIfTI-1 image", is_nifti},
                                    {ImageFormat::kMetaImage, "mha", "a MetaImage", is_meta_image},
                                    {ImageFormat::kNumpy, "npy", "a NumPy array", is_numpy},
                                    {ImageFormat::kVti, "vti", "a VTK XML image", is_vti},
                                    {ImageFormat::kEsriGrid, "asc", "an ESRI ASCII grid", is_esri_grid},
                                    {ImageFormat::kRaw, "raw", "a raw image", nullptr}};

}  // namespace

std::optional<ImageFormat> image_format_named(std::string_view name) {
  for (const KnownFormat& known : kFormats)
    if (name == known.name) return known.format;
  return std::nullopt;
}

std::string_view image_name(ImageFormat format) {
  return std::ranges::find(kFormats, format, &KnownFormat::format)->text;
}

std::optional<ImageFormat> image_format_of(std::string_view head) {
  for (const KnownFormat& known : kFormats)
    if (known.is_it != nullptr && known.is_it(head)) return known.format;
  return std::nullopt;
}

}  // namespace reeb::io
