#include "ooc/states/state_file.h"

#include <algorithm>

namespace reeb::ooc {

bool begins_with(const std::string& path, const std::array<char, 8>& magic) {
  if (!io::is_regular_file(path)) return false;
  const io::File file = io::File::open_for_reading(path);
  std::array<char, 8> first{};
  if (file.size() < first.size()) return false;
  file.read_at(0, std::as_writable_bytes(std::span(first)));
  return first == magic;
}

void StateFileWriter::write(std::span<const std::byte> bytes) {
  out_.append(bytes);
  checksum_.add(bytes);
  bytes_ += bytes.size();
}

void StateFileReader::read(std::span<std::byte> bytes) {
  if (bytes.size() > left()) throw DamagedState();
  while (!bytes.empty()) {
    if (window_.size() == used_) {
      if (bytes.size() >= kWindowBytes) {
        file_.read_at(at_, bytes);
        at_ += bytes.size();
        return;
      }
      window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kWindowBytes, end_ - at_)));
      file_.read_at(at_, window_);
      at_ += window_.size();
      used_ = 0;
    }
    const std::size_t count = std::min(bytes.size(), window_.size() - used_);
    std::copy_n(window_.begin() + static_cast<std::ptrdiff_t>(used_), count, bytes.begin());
    used_ += count;
    bytes = bytes.subspan(count);
  }
}

}  // namespace reeb::ooc
