// The classes of faults of streaming meshes. The class is the first word of the error message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace reeb::io {

enum class Fault {
  kTruncated,
  kBadHeader,
  kBadNumber,
  kBadIndex,
  kFinalIndex,
  kMissingVertex,
  kNotTriangle,
  kUnsupported,
  kCorrupt,
};

// `position` is a byte offset ("412") or line:column ("17:9").
// THROWS: Error{kBadInput}, always.
[[noreturn]] void fail(Fault fault, const std::string& what, const std::string& position);

// How many elements a header announced, and how many the stream delivered.
struct Tally {
  std::optional<std::uint32_t> promised;
  std::uint64_t delivered = 0;
};

// "COUNT: ..." if more elements (or, with `fewer_too`, fewer) came than announced, else empty.
std::string count_warning(const Tally& tally, const char* what, bool fewer_too);
// THROWS: TRUNCATED if fewer elements came than announced.
void require_promised(const Tally& tally, const char* what, const std::string& position);

}  // namespace reeb::io
