// Opens an image or height field of any supported format as a regular grid.
//
// The formats are those of ImageFormat, by their content or by name (GridOptions::format); raw needs GridOptions::raw.
// Files packed with gzip and zstd are unpacked.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "io/file/content_source.h"
#include "io/images/image_format.h"
#include "io/images/raw_grid.h"
#include "libreeb/port/grid_reader.h"

namespace reeb::io {

// What the content is, or, where that is not a mesh either, what `path` says; nothing if it is none of these. On a pipe
// it waits for the first 64 KB.
std::optional<ImageFormat> detect_image(ContentSource& source, const std::string& path);

// The file of the data that the header in `source` names, as its reader finds it; empty if the data follow the header,
// or if this is no image. `format`: as in GridOptions. The file of the header, `path`, is a regular one.
// THROWS: as open_grid(), for the header.
std::string grid_data_file(ContentSource& source, const std::string& path, std::optional<ImageFormat> format);

struct GridOptions {
  std::optional<ImageFormat> format;  // nothing: detect it
  RawGrid raw;                        // what a raw file holds
};

// Reads the header. `source` is the content of `input`; views of its beginning may have been taken. A data file that
// the header names is opened, too: it must be in the folder of the header or below it.
// THROWS: Error{kBadInput} with file, position and a hint: unknown or damaged, or the file is too short for what the
//         header announces; Error{kUsage}: a raw file without its size.
std::unique_ptr<GridReader> open_grid(const Input& input, std::unique_ptr<ContentSource> source,
                                      const GridOptions& options = {});
std::unique_ptr<GridReader> open_grid(const std::string& path, const GridOptions& options = {});

}  // namespace reeb::io
