// The tags of an XML document, one after the other; the text between them is passed over, however long it is.
//
// It reads what programs write: elements with attributes, comments, processing instructions and the five entities of
// attribute values.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/content_source.h"
#include "io/text/cursor.h"

namespace reeb::io {

struct XmlTag {
  std::string name;
  bool closes = false;    // </name>
  bool is_empty = false;  // <name/>
  std::vector<std::pair<std::string, std::string>> attributes;
  std::uint64_t begin = 0, end = 0;  // offsets of its '<', and after its '>'

  // Null if there is none.
  const std::string* find(std::string_view attribute) const;
  std::string get(std::string_view attribute, std::string_view otherwise = {}) const;
};

class XmlScanner {
 public:
  explicit XmlScanner(std::unique_ptr<ContentSource> source) : cursor_(std::move(source)) {}

  // False at the end of the document.
  // THROWS: Error{kBadInput} at a tag that is no XML, or is longer than ContentSource::kLookahead.
  bool next(XmlTag& tag);
  // The offset of the text after the last tag, without blanks before it and elements between it and the tag.
  std::uint64_t text_offset();
  const ContentSource& source() const { return cursor_.source(); }

  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

 private:
  bool skip_to_tag();
  bool skip_comment();
  void skip_past(std::string_view end);
  std::string_view take_tag();

  Cursor cursor_;
};

}  // namespace reeb::io
