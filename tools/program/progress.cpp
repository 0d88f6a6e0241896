#include "tools/program/progress.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "tools/program/bar_line.h"

namespace reeb::tools {
namespace {

bool can_redraw() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

}  // namespace

// getrusage() counts what the process had before it became this program: a copy of the one that started it.
std::uint64_t peak_rss_bytes() {
  constexpr std::string_view kPeak = "VmHWM:";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(kPeak)) return std::strtoull(line.c_str() + kPeak.size(), nullptr, 10) * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::size_t terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 ? size.ws_col : 80;
}

ProgressBar::ProgressBar(bool quiet) : on_(!quiet && can_redraw()) {}

void ProgressBar::update(Pass pass, std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
  if (!on_) return;
  const auto now = Clock::now();
  if (name_ == nullptr || std::string_view(pass.name) != name_) {
    clear();
    name_ = pass.name;
    ++number_;
    pass_start_ = now;
  } else if (done < last_done_) {  // the same pass, for another function
    pass_start_ = now;
  }
  last_done_ = done;
  constexpr auto kNoDrawing = std::chrono::milliseconds(200), kBetweenDraws = std::chrono::milliseconds(100);
  if (now - start_ < kNoDrawing || (drawn_ && now - last_draw_ < kBetweenDraws)) return;
  last_draw_ = now;
  drawn_ = true;

  BarState state;
  state.title = fmt::format("{}/{} {}", number_, number_ + pass.more, pass.name);
  state.seconds = std::chrono::duration<double>(now - pass_start_).count();
  if (total != 0) state.share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  if (state.seconds > 0) state.millions = static_cast<double>(triangles) / state.seconds / 1e6;
  state.bytes = peak_rss_bytes();
  // The last column stays free: some terminals go to the next line when it is written.
  fmt::print(stderr, "\r\033[K{}", bar_line(state, terminal_columns() - 1));
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace reeb::tools
