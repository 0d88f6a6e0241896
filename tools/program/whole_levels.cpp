#include "tools/program/whole_levels.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <ranges>
#include <string>

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
  return fmt::format("--threshold {}", level.threshold);
}

}  // namespace

bool is_whole(const ooc::ReebFile& file, const LevelLine& level) {
  const Error* damage = file.damage();
  return damage == nullptr || level.file_bytes <= whole_bytes(*damage);
}

const LevelLine* finest_whole_level(const ooc::ReebFile& file) {
  for (const LevelLine& level : file.levels() | std::views::reverse)
    if (is_whole(file, level)) return &level;
  return nullptr;
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
  return Error(error.kind(), error.message(), hint).at(error.file(), error.position());
}

}  // namespace reeb::tools
