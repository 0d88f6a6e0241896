// The display while a run continues: a bar on a terminal, nothing elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace reeb::tools {

// Peak resident memory of this process so far, in bytes.
std::uint64_t peak_rss_bytes();

// Columns of the terminal at standard error; 80 if it is not known.
std::size_t terminal_columns();

// The passes of a run. How many there will be is known only in part: each pass says how many must follow it.
class ProgressBar {
 public:
  // Draws on standard error, if that is a terminal that can redraw a line (not TERM=dumb), and `quiet` is false.
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  struct Pass {
    const char* name;
    unsigned more = 0;  // passes that follow
  };

  // `done` of `total` (0: unknown) in this pass. A pass with another name than the last begins here; one
  // with the same name begins again if `done` has become less. Redraws at most ten
  // times a second, and nothing in the first fifth of a second.
  void update(Pass pass, std::uint64_t done, std::uint64_t total, std::uint64_t triangles = 0);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool on_, drawn_ = false;
  const char* name_ = nullptr;
  unsigned number_ = 0;  // of the pass, from 1
  std::uint64_t last_done_ = 0;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point pass_start_{}, last_draw_{};
};

}  // namespace reeb::tools
