#include "libreeb/base/error.h"

#include <algorithm>
#include <utility>

#include "libreeb/base/printable.h"

namespace reeb {

Error::Error(ErrorKind kind, std::string what, std::string hint)
    : kind_(kind), message_(std::move(what)), hint_(std::move(hint)) {
  compose();
}

Error& Error::at(const std::string& file, const std::string& position) {
  if (file_.empty()) file_ = file;
  if (position_.empty()) position_ = position;
  compose();
  return *this;
}

Error& Error::because(ErrorCause cause) {
  cause_ = cause;
  return *this;
}

Error Error::with_hint(std::string hint) const {
  Error other = *this;
  other.hint_ = std::move(hint);
  return other;
}

void Error::compose() {
  text_ = file_;
  if (!position_.empty()) text_ += (text_.empty() ? "" : ":") + position_;
  if (!text_.empty()) text_ += ": ";
  text_ = printable(text_ + message_);
}

Error input_changed(const std::string& what, const std::string& hint) {
  return Error(ErrorKind::kBadInput, what, hint).because(ErrorCause::kChanged);
}

Error not_manifold(std::uint64_t a, std::uint64_t b) {
  return Error(ErrorKind::kBadInput,
               "the edge between vertices " + std::to_string(std::min(a, b)) + " and " +
                   std::to_string(std::max(a, b)) + " has a third triangle",
               "leave --manifold out; reeb info counts the edges that are not manifold")
      .because(ErrorCause::kNotManifold);
}

}  // namespace reeb
