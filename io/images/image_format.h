// The formats of images that are read: their names, and which of them a content is.
#pragma once

#include <optional>
#include <string_view>

namespace reeb::io {

enum class ImageFormat { kNrrd, kNifti, kMetaImage, kNumpy, kVti, kEsriGrid, kRaw };

// By one of these names: nrrd nifti mha npy vti asc raw.
std::optional<ImageFormat> image_format_named(std::string_view name);
// "a NIfTI-1 image".
std::string_view image_name(ImageFormat format);

// By the first bytes of the content; nothing if they are of no image, or of raw values.
std::optional<ImageFormat> image_format_of(std::string_view head);

}  // namespace reeb::io
