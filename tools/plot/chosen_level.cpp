#include "tools/plot/chosen_level.h"

#include <filesystem>

#include "libreeb/base/count_text.h"
#include "libreeb/base/printable.h"
#include "tools/arguments/options.h"
#include "tools/program/quantity.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {

LevelOptions add_level_options(Command command, LevelChoice& choice) {
  const Option threshold = command
                               .add_option("--threshold", choice.threshold,
                                           "The level without features of less persistence: 0.01 (function units), "
                                           "or 0.1% (of the range)")
                               .option_text("T");
  Option nodes = add_count(command, "--nodes", choice.nodes, "The finest level with at most N nodes").option_text("N");
  nodes.excludes(threshold);
  return {threshold, nodes};
}

void check_threshold(const LevelChoice& choice) {
  if (!choice.threshold.empty()) parse_threshold("--threshold", choice.threshold, {0, 1});
}

ChosenLevel choose_level(const ooc::ReebFile& file, const LevelChoice& choice) {
  ChosenLevel level{0, "full graph"};
  if (!choice.threshold.empty()) {
    const ValueRange range{file.header().function_min, file.header().function_max};
    level.version = file.version_at(parse_threshold("--threshold", choice.threshold, range));
    level.text = "level at threshold " + choice.threshold;
  } else if (choice.nodes) {
    level.version = file.finest_with_nodes(*choice.nodes);
    if (level.version != 0) level.text = "finest level of at most " + count_of(*choice.nodes, "node");
  } else if (choice.version) {
    level.version = *choice.version;
    if (level.version != 0) level.text = "level without the " + count_of(level.version, "smallest pair");
  }
  return level;
}

void note_large_threshold(const ooc::ReebFile& file, const std::string& threshold) {
  if (threshold.empty()) return;
  const FileHeader& header = file.header();
  const std::string note = large_threshold(threshold, {header.function_min, header.function_max}, header.function);
  if (!note.empty()) print_line("note: " + printable(note));
}

void for_each_pair_of(const ooc::ReebFile& file, std::uint32_t version,
                      const std::function<void(const ooc::PairKeys&)>& visit) {
  std::uint32_t cancelled = 0;
  file.for_each_pair([&](const ooc::PairKeys& pair) {
    const bool is_ever_cancelled = !pair.kept && pair.type != PairType::kExt0;
    if (is_ever_cancelled && cancelled < version)
      ++cancelled;
    else
      visit(pair);
  });
}

std::string graph_name(const ooc::ReebFile& file) {
  constexpr std::size_t kMost = 48, kPart = (kMost - 3) / 2;
  std::string name = std::filesystem::path(file.path()).stem().string();
  if (name.size() <= kMost) return name;
  // Not within a character of UTF-8.
  const auto begins_character = [&](std::size_t at) { return (static_cast<unsigned char>(name[at]) & 0xc0) != 0x80; };
  std::size_t end = kPart, begin = name.size() - kPart;
  while (end > 0 && !begins_character(end)) --end;
  while (begin < name.size() && !begins_character(begin)) ++begin;
  return name.substr(0, end) + "..." + name.substr(begin);
}

}  // namespace reeb::tools
