#include "io/cells/msh_items.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "libreeb/base/error.h"

namespace reeb::io {

MshItems::MshItems(std::unique_ptr<ContentSource> source) : text_(std::move(source)) { read_format(); }

void MshItems::read_format() {
  constexpr const char* kVersions = "versions 2.2 and 4.1 are read; save it in one of these";
  if (next_section() != "MeshFormat") fail("a MSH file begins with $MeshFormat", kVersions);
  text_.more();
  const std::string version(text_.token());
  format_.version4 = version == "4.1";
  if (!format_.version4 && version != "2.2" && version != "2.1" && version != "2.0" && version != "2")
    text_.fail("the file is of MSH version " + version.substr(0, 20) + ", which is not read", kVersions);
  const auto binary = text_.integer("file type");
  const auto size = text_.integer("data size");
  if (binary < 0 || binary > 1 || size != 8)
    text_.fail("the file type is not 0 or 1, or the data size not 8", "save the file again, as text if need be");
  text_.skip_line();
  if (binary == 1) {
    const char* const bytes = take(4, "mark of the byte order");
    const auto one = load_scalar<std::int32_t>(bytes, false);
    format_.big_endian = one != 1;
    if (load_scalar<std::int32_t>(bytes, format_.big_endian) != 1) fail("the mark of the byte order is damaged");
    format_.binary = true;
  }
  end_section("MeshFormat");
}

std::string MshItems::next_section() {
  while (text_.more()) {
    offset_ = text_.bytes().offset();
    const std::string word(text_.token());
    text_.skip_line();
    if (word.starts_with('$') && word.size() > 1) return word.substr(1);
    fail(word.substr(0, 40) + " is not the beginning of a section");
  }
  return {};
}

void MshItems::end_section(const std::string& name) {
  text_.more();
  offset_ = text_.bytes().offset();
  if (text_.token() != "$End" + name) fail("the section " + name + " does not end here");
  text_.skip_line();
}

void MshItems::skip_section(const std::string& name) {
  const std::string end = "$End" + name;
  if (!format_.binary) {
    while (text_.more()) {
      const bool found = text_.token() == end;
      text_.skip_line();
      if (found) return;
    }
    fail("the section " + name + " does not end", kCutHint);
  }
  Cursor& bytes = text_.bytes();
  while (bytes.ensure(end.size())) {
    const std::string_view view(bytes.data(), bytes.available());
    const std::size_t found = view.find(end);
    bytes.advance(found == std::string_view::npos ? view.size() - end.size() + 1 : found + end.size());
    if (found == std::string_view::npos) continue;
    text_.skip_line();
    return;
  }
  fail("the section " + name + " does not end", kCutHint);
}

const char* MshItems::take(std::size_t bytes, const char* what) {
  Cursor& cursor = text_.bytes();
  offset_ = cursor.offset();
  if (!cursor.ensure(bytes)) fail(std::string("the file ends where a ") + what + " should be", kCutHint);
  const char* const data = cursor.data();
  cursor.advance(bytes);
  return data;
}

std::int64_t MshItems::integer(const char* what) {
  if (format_.binary) return load_scalar<std::int32_t>(take(4, what), format_.big_endian);
  text_.require_more(what);
  return text_.integer(what);
}

std::uint64_t MshItems::size(const char* what) {
  std::uint64_t value = 0;
  if (format_.binary && format_.version4) {
    value = load_scalar<std::uint64_t>(take(8, what), format_.big_endian);
  } else {
    const std::int64_t number = integer(what);
    if (number < 0) fail(std::string("a ") + what + " is negative");
    value = static_cast<std::uint64_t>(number);
  }
  if (value >> 56 != 0) fail(std::string("a ") + what + " is too large");
  return value;
}

double MshItems::real(const char* what) {
  if (!format_.binary) {
    text_.require_more(what);
    return text_.finite_number<double>(what);
  }
  const auto value = load_scalar<double>(take(8, what), format_.big_endian);
  if (!std::isfinite(value)) fail(std::string("a ") + what + " is not finite", "fix this value in the file");
  return value + 0.0;
}

std::uint64_t MshItems::text_number(const char* what) {
  text_.require_more(what);
  offset_ = text_.bytes().offset();
  const std::int64_t value = text_.integer(what);
  if (value < 0) fail(std::string("a ") + what + " is negative");
  text_.skip_line();
  return static_cast<std::uint64_t>(value);
}

std::string MshItems::quoted_line() {
  text_.require_more("name");
  offset_ = text_.bytes().offset();
  Cursor& bytes = text_.bytes();
  bytes.ensure(TextCursor::kTokenBytes);
  std::string_view line(bytes.data(), std::min(bytes.available(), TextCursor::kTokenBytes));
  line = line.substr(0, line.find('\n'));
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  if (line.size() >= 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  std::string name(line);
  text_.skip_line();
  return name;
}

std::uint64_t MshItems::here() { return text_.bytes().offset(); }

void MshItems::move_to(std::uint64_t offset, std::uint64_t line) { text_.move_to_line(offset, line); }

void MshItems::fail(const std::string& what, const std::string& hint) const {
  if (!format_.binary) text_.fail(what, hint);
  throw Error(ErrorKind::kBadInput, what, hint).at(source().name(), std::to_string(offset_));
}

}  // namespace reeb::io
