// NIfTI-1: a binary header, then the data, in the same file or in a second one (x.hdr and x.img).
//
// Positions are those of the sform, else of the qform, else of pixdim; scl_slope and scl_inter are applied. An image of
// two dimensions has two coordinates if it lies in the plane z = 0, else three. RGB and complex images have components.
// Time steps and components in planes are not read.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

bool is_nifti(std::string_view head);

// THROWS: Error{kBadInput} with the byte offset.
Image parse_nifti(ContentSource& source);

}  // namespace reeb::io
