#include "io/images/image.h"

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {

void set_size(GridInfo& info, std::span<const std::uint64_t> sizes) {
  if (sizes.size() != 2 && sizes.size() != 3)
    throw Error(ErrorKind::kBadInput, "the image has " + count_of(sizes.size(), "axis"),
                "images with 2 and 3 axes are read");
  std::uint64_t room = kMostGridValues / info.components;
  info.axes = static_cast<unsigned>(sizes.size());
  info.size = {1, 1, 1};
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k] == 0)
      throw Error(ErrorKind::kBadInput, "an axis of the image has size 0",
                  "write the sizes of all axes, each at least 1");
    if (sizes[k] > room)
      throw Error(ErrorKind::kBadInput, "the header announces more than 2^56 values", "check the sizes in the header");
    room /= sizes[k];
    info.size[k] = sizes[k];
  }
}

}  // namespace reeb::io
