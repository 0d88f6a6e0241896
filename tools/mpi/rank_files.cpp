#include "tools/mpi/rank_files.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "ooc/checkpoints/partial_folder.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRank = ".rank-", kShare = "-share.fragment", kTree = "-tree.fragment";

// The file of a rank to which a name belongs, without what it ends in while it is written; else empty.
std::string_view rank_file_of(std::string_view name, const std::string& output) {
  if (!name.starts_with(output) || !name.substr(output.size()).starts_with(kRank)) return {};
  const std::size_t number = output.size() + kRank.size();
  const std::size_t end = name.find_first_not_of("0123456789", number);
  if (end == number || end == std::string_view::npos) return {};
  for (const std::string_view what : {kShare, kTree})
    if (name.substr(end).starts_with(what)) return name.substr(0, end + what.size());
  return {};
}

}  // namespace

std::string rank_file(const std::string& output, std::uint32_t rank, RankFile which) {
  return output + std::string(kRank) + std::to_string(rank) + std::string(which == RankFile::kShare ? kShare : kTree);
}

void remove_rank_files(const std::string& output, bool with_states) {
  std::vector<fs::path> found;
  std::error_code ignored;
  const fs::path folder = io::folder_of(output);
  const std::string own = fs::path(output).filename().string();
  io::for_each_name(folder.string(), [&](std::string_view name) {
    if (const auto file = rank_file_of(name, own); !file.empty()) found.push_back(folder / file);
  });
  for (const fs::path& file : found) {
    fs::remove(file, ignored);
    io::remove_abandoned(file.string());
    if (!with_states || !ooc::PartialFolder::has_checkpoint(file.string())) continue;
    try {
      ooc::PartialFolder(file.string()).clear();
    } catch (const Error&) {  // not ours: it stays
    }
  }
}

}  // namespace reeb::tools
