// The files of ranks next to the output: OUT.rank-K-share.fragment holds what settled in the share of rank K,
// OUT.rank-K-tree.fragment what settled while it glued.
#pragma once

#include <cstdint>
#include <string>

namespace reeb::tools {

enum class RankFile { kShare, kTree };

std::string rank_file(const std::string& output, std::uint32_t rank, RankFile which);

// Removes what runs with any number of ranks left. The states of runs that can be resumed stay, unless `with_states`.
// REQUIRES: no run to this output is at work.
void remove_rank_files(const std::string& output, bool with_states);

}  // namespace reeb::tools
