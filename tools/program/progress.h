// The display while a run continues: a bar on a terminal, nothing elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace reeb::tools {

// Peak resident memory of this process so far, in bytes.
std::uint64_t peak_rss_bytes();

// One bar per pass on standard error, redrawn at most ten times a second: share done, rate, time left and memory. Draws
// only if standard error is a terminal and `quiet` is false.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { clear(); }

  // `done` of `total` bytes (0: unknown) in the pass called `title`.
  void update(const std::string& title, std::uint64_t done, std::uint64_t total, std::uint64_t triangles);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool on_, drawn_ = false;
  std::string title_;
  Clock::time_point pass_start_{}, last_draw_{};
};

}  // namespace reeb::tools
