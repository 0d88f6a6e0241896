// NIfTI-1 files written by hand (the fields and their offsets are those of nifti1.h).
#pragma once

#include <algorithm>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {

struct NiftiHead {
  std::vector<std::int16_t> dim;
  std::int16_t datatype = 2;
  bool big_endian = false;
  bool sform = false, qform = false;  // with the fields below
  std::array<float, 4> pixdim = {1, 0.5F, 2, 3};
  std::array<float, 12> srow = {0.5F, 0, 0, 10, 0, 2, 0, -20, 0, 0, 3, 0.5F};
  std::array<float, 6> quaternion = {0, 0, 0, 10, -20, 0.5F};  // b, c, d, and the offset
  float slope = 0, intercept = 0, vox_offset = 352;
  std::string magic = "n+1";
};

inline std::string nifti(const NiftiHead& head, const std::string& data) {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    const std::string field = scalar_bytes(value, head.big_endian);
    std::ranges::copy(field, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  };
  put(0, std::int32_t{348});
  for (std::size_t k = 0; k < head.dim.size(); ++k) put(40 + 2 * k, head.dim[k]);
  put(70, head.datatype);
  for (std::size_t k = 0; k < 4; ++k) put(76 + 4 * k, head.pixdim[k]);
  put(108, head.vox_offset);
  put(112, head.slope);
  put(116, head.intercept);
  put(252, std::int16_t{head.qform});
  put(254, std::int16_t{head.sform});
  for (std::size_t k = 0; k < 6; ++k) put(256 + 4 * k, head.quaternion[k]);
  for (std::size_t k = 0; k < 12; ++k) put(280 + 4 * k, head.srow[k]);
  std::ranges::copy(head.magic, bytes.begin() + 344);
  return bytes + data;
}

}  // namespace reeb::io::testing
