// Reads XML as it comes, without holding the document: Expat, fed with windows of the content.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/content_source.h"

namespace reeb::io {

using XmlAttributes = std::vector<std::pair<std::string, std::string>>;

// The value of an attribute; empty if there is none.
std::string attribute_of(const XmlAttributes& attributes, std::string_view name);

class XmlParser {
 public:
  // What a user of the parser does with the parts of a document. Each returns whether to read on.
  class Handler {
   public:
    virtual ~Handler() = default;
    virtual bool start(const std::string& name, const XmlAttributes& attributes) = 0;
    virtual bool end(const std::string& name) = 0;
    virtual bool text(std::string_view text) = 0;
  };

  // Starts at the beginning of the content. Both must stay valid.
  XmlParser(ContentSource& source, Handler& handler);
  XmlParser(const XmlParser&) = delete;
  XmlParser& operator=(const XmlParser&) = delete;
  ~XmlParser();

  // Reads the next window. False if that was the last one, or the handler wants no more.
  // THROWS: Error{kBadInput} with line and column: no XML, a document type, a tag of more than 1 MB, too many tags
  //         inside each other, too many different names; what the handler throws.
  bool advance();

  // How much of the content has been given to the parser, and where the view began that it was given from.
  std::uint64_t offset() const;
  std::uint64_t view_offset() const;
  // While the handler runs: the line, and the offset of the byte after the tag or text.
  std::uint64_t line() const;
  std::uint64_t part_end() const;
  // The error at the present line.
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace reeb::io
