#include "io/formats/foreign_format.h"

#include <cstddef>
#include <cstdint>

#include "io/mesh/scalar_bytes.h"
#include "io/text/text_cursor.h"

namespace reeb::io {
namespace {

using namespace std::string_view_literals;

struct Mark {
  std::string_view bytes;
  ForeignFormat format;
  std::size_t offset = 0;
};

constexpr ForeignFormat other(std::string_view name, std::string_view advice = {}) { return {name, false, advice}; }

constexpr const char* kAsImage = "convert it to NPY or NRRD";

constexpr ForeignFormat kUtf16 = other("text in UTF-16", "save it as UTF-8 or ASCII text first");

constexpr Mark kMarks[] = {
    {"n+2\0"sv, {"a NIfTI-2 image"}, 4},
    {"ni2\0"sv, {"a NIfTI-2 header"}, 4},
    {"glTF"sv, {"a binary glTF scene"}},
    {"Kaydara FBX Binary"sv, {"an FBX scene"}},
    {"\x89HDF\r\n"sv, {"an HDF5 file"}},
    {"\x89REEB\r\n"sv,
     other("a Reeb graph",
           "name the mesh that it was computed from; `reeb info FILE` and `reeb extract FILE` read Reeb graphs")},
    {"REEBFRG\n"sv, other("a fragment", "`reeb glue` makes a Reeb graph of the fragments of all parts")},
    {"REEBNAM\n"sv, other("a file of names of `reeb fragment --scan`", "`reeb fragment --shared` reads it")},
    {"version https://git-lfs.github.com/"sv,
     other("a Git LFS pointer, without the content of the file", "fetch the content with `git lfs pull`")},
    {"\xFF\xFE"sv, kUtf16},
    {"\xFE\xFF"sv, kUtf16},
    {"\x89PNG\r\n"sv, other("a PNG picture", kAsImage)},
    {"\xFF\xD8\xFF"sv, other("a JPEG picture", kAsImage)},
    {"II*\0"sv, other("a TIFF picture", kAsImage)},
    {"MM\0*"sv, other("a TIFF picture", kAsImage)},
    {"%PDF-"sv, other("a PDF document")},
    {"PK\3\4"sv, other("a ZIP archive", "unpack it first")},
    {"7z\xBC\xAF\x27\x1C"sv, other("a 7-Zip archive", "unpack it first")},
    {"\xFD\x37zXZ"sv, other("packed with xz", "unpack it first")},
    {"BZh"sv, other("packed with bzip2", "unpack it first")},
    {"\x04\x22\x4D\x18"sv, other("packed with LZ4", "unpack it first")},
    {"DICM"sv, other("a DICOM slice", "convert the series to NRRD or NIfTI"), 128},
    {"ustar"sv, other("a tar archive", "unpack it first"), 257},
};

std::string_view without_leading_blanks(std::string_view text) {
  while (!text.empty() && is_blank_or_line_end(text.front())) text.remove_prefix(1);
  return text;
}

// XML says in its first element what it is.
ForeignFormat xml_format(std::string_view text) {
  if (!text.starts_with('<')) return {};
  if (text.find("<VTKFile") != std::string_view::npos) return {"a VTK XML file of another kind"};
  if (text.find("<COLLADA") != std::string_view::npos) return {"a COLLADA scene"};
  if (text.starts_with("<!DOCTYPE html") || text.starts_with("<html")) return other("a web page");
  return text.starts_with("<?xml") ? other("an XML file") : ForeignFormat{};
}

// Binary Medit meshes begin with the number 1, their version, 1 to 4, and the keyword "dimension", 3.
bool is_binary_medit(std::string_view head) {
  if (head.size() < 12) return false;
  for (const bool big : {false, true}) {
    const auto word = [&](std::size_t at) { return load_scalar<std::uint32_t>(head.data() + at, big); };
    if (word(0) == 1 && word(4) >= 1 && word(4) <= 4 && word(8) == 3) return true;
  }
  return false;
}

}  // namespace

ForeignFormat foreign_format(std::string_view head) {
  for (const Mark& mark : kMarks)
    if (head.size() >= mark.offset && head.substr(mark.offset).starts_with(mark.bytes)) return mark.format;
  if (is_binary_medit(head)) return {"a binary Medit mesh", true, "save it as text (.mesh)"};
  return xml_format(without_leading_blanks(head.substr(0, 4096)));
}

}  // namespace reeb::io
