#include "tools/program/progress.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "libreeb/base/memory_budget.h"

namespace reeb::tools {

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

ProgressBar::ProgressBar(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::update(const std::string& title, std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
  if (!on_) return;
  const auto now = Clock::now();
  if (title != title_) {
    clear();
    title_ = title;
    pass_start_ = now;
  }
  if (drawn_ && now - last_draw_ < std::chrono::milliseconds(100)) return;
  last_draw_ = now;
  drawn_ = true;

  constexpr int kWidth = 28;
  const double seconds = std::chrono::duration<double>(now - pass_start_).count();
  const double share = total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const auto filled = static_cast<std::size_t>(share * kWidth);
  fmt::print(stderr, "\r\033[K{:<12} [{}{}] {:3.0f} %", title, std::string(filled, '#'),
             std::string(kWidth - filled, '.'), 100 * share);
  if (triangles != 0 && seconds > 0)
    fmt::print(stderr, "  {:.1f} M triangles/s", static_cast<double>(triangles) / seconds / 1e6);
  if (share > 0.01) fmt::print(stderr, "  {:.0f} s left", seconds * (1 - share) / share);
  fmt::print(stderr, "  {}", format_bytes(peak_rss_bytes()));
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace reeb::tools
