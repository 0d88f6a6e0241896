#include "ooc/reeb_file/level_history.h"

#include <algorithm>

#include "ooc/reeb_file/frame_file.h"

namespace reeb::ooc {

LevelHistory read_history(const std::string& path, std::uint32_t finest, const VisitRecord& visit) {
  const FrameFile file(path);
  file.require_version(finest);
  LevelHistory history;
  std::vector<bool> named, present;  // ends of any record, and of those that live at `finest`
  std::uint64_t arcs = 0;            // that live there
  GraphFrame frame;
  FrameFile::Buffers buffers;
  FrameCursor cursor(file);
  while (!cursor.covers(finest)) {
    cursor.next(file, frame, buffers);
    history.nodes.insert(history.nodes.end(), frame.nodes.begin(), frame.nodes.end());
    require_rising(file, cursor, frame, [&](std::uint64_t node) -> const SweepKey& { return history.nodes[node].key; });
    named.resize(history.nodes.size(), false);
    present.resize(history.nodes.size(), false);
    std::size_t first = 0;
    for (std::size_t i = 0; i < frame.arcs.size(); ++i) {
      const FileArc& arc = frame.arcs[i];
      const std::size_t count = frame.bucket_counts.empty() ? 0 : frame.bucket_counts[i];
      named[arc.lo] = named[arc.hi] = true;
      if (arc.born <= finest && finest < arc.died) {
        present[arc.lo] = present[arc.hi] = true;
        ++arcs;
      }
      if (arc.died > finest)
        visit(arc, history.nodes[arc.lo], history.nodes[arc.hi], std::span(frame.buckets).subspan(first, count));
      first += count;
    }
    history.versions.insert(history.versions.end(), frame.versions.begin(), frame.versions.end());
  }
  for (std::uint32_t node = 0; node < named.size(); ++node)
    if (!named[node]) history.isolated.push_back(node);
  // A frame can complete finer versions than the one that was asked for.
  history.versions.resize(std::size_t{file.header().steps} + 1 - finest);
  std::ranges::reverse(history.versions);
  const auto nodes = static_cast<std::uint64_t>(std::ranges::count(present, true)) + history.isolated.size();
  require_counts(file, cursor, finest, history.versions[0], nodes, arcs);
  return history;
}

}  // namespace reeb::ooc
