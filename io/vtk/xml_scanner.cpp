#include "io/vtk/xml_scanner.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool ends_name(char c) { return is_blank(c) || c == '=' || c == '/' || c == '>'; }

std::string_view take_name(std::string_view& text) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if(text, ends_name) - text.begin());
  const std::string_view name = text.substr(0, end);
  text.remove_prefix(end);
  return name;
}

void skip_blanks(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
}

std::string without_entities(std::string_view text) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string plain;
  while (!text.empty()) {
    const auto* const entity =
        std::ranges::find_if(kEntities, [&](const auto& known) { return text.starts_with(known.first); });
    const bool found = entity != std::end(kEntities);
    plain += found ? entity->second : text.front();
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return plain;
}

}  // namespace

const std::string* XmlTag::find(std::string_view attribute) const {
  const auto found = std::ranges::find(attributes, attribute, [](const auto& pair) { return pair.first; });
  return found == attributes.end() ? nullptr : &found->second;
}

std::string XmlTag::get(std::string_view attribute, std::string_view otherwise) const {
  const std::string* const value = find(attribute);
  return value == nullptr ? std::string(otherwise) : *value;
}

bool XmlScanner::next(XmlTag& tag) {
  do {
    if (!skip_to_tag()) return false;
  } while (skip_comment());
  tag = {};
  tag.begin = cursor_.offset();
  std::string_view text = take_tag();
  tag.end = cursor_.offset();
  text.remove_prefix(1);
  text.remove_suffix(1);
  if (text.starts_with('/')) {
    tag.closes = true;
    text.remove_prefix(1);
  } else if (text.ends_with('/')) {
    tag.is_empty = true;
    text.remove_suffix(1);
  }
  tag.name = take_name(text);
  if (tag.name.empty() || tag.name.front() == '!') fail(tag.begin, "this is no XML that is read here");
  for (skip_blanks(text); !text.empty(); skip_blanks(text)) {
    const std::string_view name = take_name(text);
    skip_blanks(text);
    const bool assigned = !name.empty() && text.starts_with('=');
    if (assigned) text.remove_prefix(1);
    skip_blanks(text);
    if (!assigned || text.empty() || (text.front() != '"' && text.front() != '\''))
      fail(tag.begin, "an attribute of the element " + tag.name + " is damaged");
    const std::size_t end = text.find(text.front(), 1);
    if (end == std::string_view::npos) fail(tag.begin, "an attribute of the element " + tag.name + " does not end");
    tag.attributes.emplace_back(name, without_entities(text.substr(1, end - 1)));
    text.remove_prefix(end + 1);
  }
  return true;
}

std::uint64_t XmlScanner::text_offset() {
  while (true) {
    while (cursor_.ensure(1) && is_blank(*cursor_.data())) cursor_.advance(1);
    cursor_.ensure(2);
    const std::string_view text(cursor_.data(), cursor_.available());
    if (!text.starts_with('<') || text.starts_with("</")) return cursor_.offset();
    XmlTag tag;
    std::uint64_t depth = 0;
    do {
      if (!next(tag)) fail(cursor_.offset(), "the file ends in an element");
      if (!tag.is_empty) depth = tag.closes ? depth - std::min<std::uint64_t>(depth, 1) : depth + 1;
    } while (depth != 0);
  }
}

bool XmlScanner::skip_to_tag() {
  while (cursor_.ensure(1)) {
    const void* const found = std::memchr(cursor_.data(), '<', cursor_.available());
    if (found != nullptr) {
      cursor_.advance(static_cast<std::size_t>(static_cast<const char*>(found) - cursor_.data()));
      return true;
    }
    cursor_.advance(cursor_.available());
  }
  return false;
}

// Also skips processing instructions, such as the first line of most documents.
bool XmlScanner::skip_comment() {
  cursor_.ensure(4);
  const std::string_view text(cursor_.data(), cursor_.available());
  const bool comment = text.starts_with("<!--"), instruction = text.starts_with("<?");
  if (!comment && !instruction) return false;
  cursor_.advance(comment ? 4 : 2);
  skip_past(comment ? "-->" : "?>");
  return true;
}

void XmlScanner::skip_past(std::string_view end) {
  const std::uint64_t begin = cursor_.offset();
  while (cursor_.ensure(end.size())) {
    const std::string_view text(cursor_.data(), cursor_.available());
    const std::size_t found = text.find(end);
    cursor_.advance(found == std::string_view::npos ? text.size() - end.size() + 1 : found + end.size());
    if (found != std::string_view::npos) return;
  }
  fail(begin, "a comment does not end");
}

std::string_view XmlScanner::take_tag() {
  const std::uint64_t begin = cursor_.offset();
  for (std::size_t wanted = 256;; wanted = std::min<std::size_t>(4 * wanted, ContentSource::kLookahead)) {
    const bool more = cursor_.ensure(wanted);
    const std::string_view text(cursor_.data(), std::min(cursor_.available(), ContentSource::kLookahead));
    char quote = 0;
    for (std::size_t i = 1; i < text.size(); ++i) {
      const char c = text[i];
      if (quote == 0 && c == '>') {
        cursor_.advance(i + 1);
        return text.substr(0, i + 1);
      }
      if (c == quote)
        quote = 0;
      else if (quote == 0 && (c == '"' || c == '\''))
        quote = c;
    }
    if (!more || wanted == ContentSource::kLookahead) fail(begin, "an element of the XML does not end");
  }
}

void XmlScanner::fail(std::uint64_t offset, const std::string& what) const {
  throw Error(ErrorKind::kBadInput, what, "the file is cut or damaged; get a whole copy")
      .at(cursor_.source().name(), std::to_string(offset));
}

}  // namespace reeb::io
