#include "tools/program/bar_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "libreeb/base/memory_budget.h"

namespace reeb::tools {
namespace {

constexpr std::size_t kTitleColumns = 20, kLeastBar = 8, kMostBar = 28;

// "8 s", "3 min 20 s", "1 h 05 min".
std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::min(seconds, 1e9) + 0.5);
  if (whole < 100) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

// With too little done, any guess of the time left would be far off.
std::string time_part(const BarState& state) {
  if (state.share > 0.01) return "  " + duration(state.seconds * (1 - state.share) / state.share) + " left";
  return state.seconds >= 1 ? "  " + duration(state.seconds) : "";
}

std::string bar(double share, std::size_t columns) {
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(columns));
  return " [" + std::string(filled, '#') + std::string(columns - filled, '.') + "]";
}

}  // namespace

std::string bar_line(const BarState& state, std::size_t columns) {
  const bool known = state.share >= 0;
  const double share = std::clamp(state.share, 0.0, 1.0);
  const std::string title = fmt::format("{:<{}}", state.title, kTitleColumns);
  const std::string percent = known ? fmt::format(" {:3.0f} %", std::floor(100 * share)) : "";
  const std::string rate = state.millions > 0 ? fmt::format("  {:.1f} M triangles/s", state.millions) : "";
  const std::string time = time_part(state), memory = "  " + format_bytes(state.bytes);
  constexpr std::size_t kBrackets = 3;
  // From everything to the least.
  for (const std::array<bool, 3>& keep :
       {std::array{true, true, true}, {true, true, false}, {true, false, false}, {false, false, false}}) {
    const bool with_bar = keep[0] && known;
    const std::string tail = percent + (keep[1] ? rate : "") + time + (keep[2] ? memory : "");
    const std::size_t taken = title.size() + tail.size() + (with_bar ? kBrackets : 0);
    if (taken + (with_bar ? kLeastBar : 0) > columns) continue;
    return title + (with_bar ? bar(share, std::min(kMostBar, columns - taken)) : "") + tail;
  }
  return (state.title + percent).substr(0, columns);
}

}  // namespace reeb::tools
