#include "tools/program/whole_levels.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <ranges>
#include <string>

#include "libreeb/base/printable.h"

namespace reeb::tools {
namespace {

// Where the whole part of a cut file ends.
std::uint64_t whole_bytes(const Error& damage) {
  std::uint64_t bytes = 0;
  const std::string& text = damage.position();
  std::from_chars(text.data(), text.data() + text.size(), bytes);
  return bytes;
}

// The option that yields a whole level. `--nodes` may have to look into the missing part, for finer levels with as few
// nodes; the threshold of the level's line needs no more than the level.
std::string choice_of(const ooc::ReebFile& file, const LevelLine& level) {
  try {
    if (file.finest_with_nodes(level.nodes) == level.version) return "--nodes " + std::to_string(level.nodes);
  } catch (const Error&) {  // the threshold works
  }
  return "--threshold " + threshold_text(file, level);
}

double number_of(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// The number of this text, which has `digits` digits, is at least `value`.
std::string rounded_up(double value, int digits) {
  const std::string nearest = fmt::format("{:.{}g}", value, digits);
  if (number_of(nearest) >= value) return nearest;
  const double last_place = std::pow(10, std::floor(std::log10(value)) - digits + 1);
  return fmt::format("{:.{}g}", value + last_place / 2, digits);
}

}  // namespace

std::string threshold_text(const ooc::ReebFile& file, const LevelLine& level) {
  constexpr int kLeastDigits = 6, kMostDigits = 16;
  std::string exact = fmt::format("{}", level.threshold);
  if (!std::isnormal(level.threshold)) return exact;
  try {
    for (int digits = kLeastDigits; digits <= kMostDigits; ++digits) {
      std::string text = rounded_up(level.threshold, digits);
      if (text.size() >= exact.size()) break;
      const double typed = number_of(text);
      if (typed >= level.threshold && file.version_at(typed) == level.version) return text;
    }
  } catch (const Error& error) {  // which threshold gives a finer level can be in a part that is missing or damaged
    if (!says_damage(error)) throw;
  }
  return exact;
}

bool says_damage(const Error& error) {
  return error.kind() == ErrorKind::kBadInput && error.cause() != ErrorCause::kUnreadable;
}

bool is_whole(const ooc::ReebFile& file, const LevelLine& level) {
  const Error* damage = file.damage();
  return damage == nullptr || level.file_bytes <= whole_bytes(*damage);
}

const LevelLine* finest_whole_level(const ooc::ReebFile& file) {
  for (const LevelLine& level : file.levels() | std::views::reverse)
    if (is_whole(file, level)) return &level;
  return nullptr;
}

void warn_of_damage(const ooc::ReebFile& file) {
  if (const Error* damage = file.damage())
    fmt::print(stderr, "reeb: warning: {}; compute the file again for what is missing\n", printable(damage->what()));
}

bool meets_missing_part(const ooc::ReebFile& file, const Error& error) {
  const Error* damage = file.damage();
  return damage != nullptr && error.file() == damage->file() && error.position() == damage->position();
}

Error with_whole_level(const ooc::ReebFile& file, const Error& error, FilePart wanted) {
  const LevelLine* level = finest_whole_level(file);
  const std::string choice = level == nullptr ? std::string() : choice_of(file, *level);
  std::string hint = "compute the file again";
  if (wanted == FilePart::kPairs)
    hint = "pairs are at the end of a file: compute it again" +
           (choice.empty() ? choice : "; `reeb extract` with " + choice + " still works");
  else if (!choice.empty())
    hint = choice + " still works; for finer levels compute the file again";
  return error.with_hint(hint);
}

}  // namespace reeb::tools
