// The level of a .reeb file that a picture shows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/arguments.h"

namespace reeb::tools {

// As --threshold and --nodes, or the version itself; all empty: the full graph.
struct LevelChoice {
  std::string threshold;
  std::optional<std::uint64_t> nodes;
  std::optional<std::uint32_t> version = {};
};

struct LevelOptions {
  Option threshold, nodes;
};
// Of these at most one may be given. `choice` must outlive the parsing.
LevelOptions add_level_options(Command command, LevelChoice& choice);
// THROWS: Error{kUsage} for a threshold that is none.
void check_threshold(const LevelChoice& choice);

struct ChosenLevel {
  std::uint32_t version = 0;
  std::string text;  // "full graph", "level at threshold 1%"
};
ChosenLevel choose_level(const ooc::ReebFile& file, const LevelChoice& choice);

// Prints a note if a threshold (empty: none) is so large that it may be meant in per cent. REQUIRES: it is well-formed.
void note_large_threshold(const ooc::ReebFile& file, const std::string& threshold);

// Calls visit(pair) for each pair that the level still has, in the order of cancelling.
void for_each_pair_of(const ooc::ReebFile& file, std::uint32_t version,
                      const std::function<void(const ooc::PairKeys&)>& visit);

// "dragon" for dirs/dragon.reeb; of a name that is too long for a title, without its middle.
std::string graph_name(const ooc::ReebFile& file);

}  // namespace reeb::tools
