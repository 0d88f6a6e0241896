#include "io/images/raw_grid.h"

#include <cmath>

#include "io/images/voxel_type.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

[[noreturn]] void refuse(const std::string& what, const std::string& hint) {
  throw Error(ErrorKind::kUsage, what, hint);
}

std::string type_text(const RawGrid& raw) {
  std::string text(type_name(raw.type));
  if (byte_size(raw.type) > 1) text += raw.big_endian ? "be" : "le";
  return text;
}

void parse_type(const std::string& text, RawGrid& raw) {
  std::string name = text;
  const bool ordered = name.ends_with("le") || name.ends_with("be");
  raw.big_endian = name.ends_with("be");
  if (ordered) name.resize(name.size() - 2);
  const auto type = type_named(name);
  if (!type || ordered != (byte_size(*type) > 1))
    refuse("--type \"" + text + "\" is not a type of values",
           "use u8, i8, or one of u16 i16 u32 i32 u64 i64 f32 f64 followed by le (little endian) or be");
  raw.type = *type;
}

[[noreturn]] void refuse_size(const std::string& grid) {
  refuse("--grid \"" + grid + "\" is not the size of a grid", "for example --grid 512x512 or --grid 256x256x100");
}

}  // namespace

std::vector<std::uint64_t> parse_grid_size(const std::string& grid) {
  std::vector<std::uint64_t> size;
  for (const std::string_view word : split(grid, 'x')) {
    const auto count = whole_number<std::uint64_t>(word);
    if (!count || *count == 0) refuse_size(grid);
    size.push_back(*count);
  }
  if (size.size() != 2 && size.size() != 3) refuse_size(grid);
  std::uint64_t room = kMostGridValues;
  for (const std::uint64_t count : size) {
    if (count > room)
      refuse("--grid " + grid + " has more than 2^56 vertices", "give the number of vertices along each axis");
    room /= count;
  }
  return size;
}

RawGrid parse_raw_grid(const std::string& grid, const std::string& type, const std::string& spacing,
                       std::uint64_t skip_bytes) {
  const std::string hint = "say what the file holds, for example --grid 256x256x100 --type u16le";
  if (grid.empty()) refuse("--grid is missing: --type, --spacing and --skip are for raw images", hint);
  if (type.empty()) refuse("--type is missing: --grid is for raw images", hint);
  RawGrid raw;
  raw.size = parse_grid_size(grid);
  parse_type(type, raw);
  raw.skip_bytes = skip_bytes;
  if (spacing.empty()) return raw;
  for (const std::string_view word : split(spacing, ',')) {
    const auto number = parse_number<double>(word);
    if (!number.ok || !std::isfinite(number.value))
      refuse("--spacing \"" + spacing + "\" is not a list of numbers", "for example --spacing 0.5,0.5,2");
    if (number.value == 0)
      refuse("--spacing \"" + spacing + "\" has a zero, which gives all vertices of an axis the same place",
             "for example --spacing 0.5,0.5,2");
    raw.spacing.push_back(number.value);
  }
  if (raw.spacing.size() != raw.size.size())
    refuse("--spacing \"" + spacing + "\" does not have one number for each axis of --grid " + grid,
           "for example --spacing 0.5,0.5,2 for three axes");
  return raw;
}

Image raw_image(const RawGrid& grid) {
  if (grid.size.empty())
    throw Error(ErrorKind::kUsage, "a raw file does not say what it holds",
                "say it, for example --grid 256x256x100 --type u16le");
  Image image;
  image.info.format = "raw " + type_text(grid);
  set_size(image.info, grid.size);
  for (std::size_t k = 0; k < grid.spacing.size(); ++k) image.info.step[k][k] = grid.spacing[k];
  image.info.has_spacing = !grid.spacing.empty();
  image.type = grid.type;
  image.big_endian = grid.big_endian;
  image.skip_bytes = grid.skip_bytes;
  image.must_end = true;
  return image;
}

}  // namespace reeb::io
