#include "io/streaming/event_input.h"

#include <algorithm>
#include <cstring>

#include "io/events/byte_source.h"
#include "io/streaming/open_stream.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

class ContentBytes : public ByteSource {
 public:
  explicit ContentBytes(std::unique_ptr<ContentSource> content) : content_(std::move(content)) {}

  // Reads what is available; waits for one byte only.
  std::size_t read(std::span<std::byte> out) override {
    const std::string_view bytes = content_->view(offset_, 1).substr(0, out.size());
    if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    offset_ += bytes.size();
    return bytes.size();
  }
  // A mapped file does not count consumed bytes, so the offset is used.
  std::uint64_t consumed() const override { return content_->can_seek() ? offset_ : content_->file_bytes_read(); }
  std::optional<std::uint64_t> size() const override { return content_->size(); }

 private:
  std::unique_ptr<ContentSource> content_;
  std::uint64_t offset_ = 0;
};

}  // namespace

std::unique_ptr<EventReader> open_events(std::unique_ptr<ContentSource> source, const std::string& path) {
  const std::string name = source->name();
  try {
    auto reader = open_stream(std::make_unique<ContentBytes>(std::move(source)), path);
    reader->set_name(name);
    return reader;
  } catch (Error& error) {
    error.at(name);
    throw;
  }
}

}  // namespace reeb::io
