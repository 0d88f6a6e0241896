#include "ooc/states/state_file.h"

#include <algorithm>

namespace reeb::ooc {

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
