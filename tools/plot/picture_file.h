// Files of pictures: SVG as it is, PNG and PDF made from it.
#pragma once

#include <string>

namespace reeb::tools {

enum class PictureFormat { kSvg, kPng, kPdf };

// By the suffix of the name; SVG on standard output. THROWS: Error{kUsage} for another suffix.
PictureFormat picture_format(const std::string& output);

// THROWS: Error{kResource} if a program that it takes is missing.
void require_programs(PictureFormat format);

// The bytes of the file. A pixel of the SVG becomes kPngScale pixels of a PNG along each axis.
inline constexpr int kPngScale = 2;
std::string picture_bytes(std::string svg, PictureFormat format, const std::string& temp_folder);

}  // namespace reeb::tools
