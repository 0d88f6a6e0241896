// ReebFile::verify: checks everything that can be checked without the mesh.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "libreeb/format/version_counts.h"
#include "ooc/reeb_file/frame_file.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {
namespace {

// All graph frames of a file, gathered.
struct Content {
  std::vector<SweepKey> nodes;
  std::vector<ArcVersion> arcs;
  std::vector<std::uint32_t> bucket_counts;
  std::vector<std::uint64_t> vertices;  // in the buckets of each arc
  std::vector<VersionCounts> versions;  // from coarse to fine
  std::vector<std::uint32_t> frame_finest;
};

// Checks that buckets ascend, are within the values of their arc's ends, and have finite means. Appends the number of
// vertices of each arc.
void gather_buckets(const FrameFile& file, const GraphFrame& frame, Content& content) {
  const auto bucket_of = [&](std::uint64_t node) {
    return std::floor(std::ldexp(content.nodes[node].value, -file.header().bucket_exponent));
  };
  auto bucket = frame.buckets.begin();
  for (std::size_t i = 0; i < frame.bucket_counts.size(); ++i) {
    const double first = bucket_of(frame.arcs[i].lo), last = bucket_of(frame.arcs[i].hi);
    std::uint64_t vertices = 0;
    const auto end = bucket + frame.bucket_counts[i];
    for (auto before = end; bucket != end; before = bucket++) {
      const auto index = static_cast<double>(bucket->index);
      if (before != end && bucket->index <= before->index) file.fail(0, "the buckets of an arc do not ascend");
      if (!(first <= index && index <= last)) file.fail(0, "an arc has a bucket beyond its ends");
      if (!std::ranges::all_of(bucket->mean, [](double x) { return std::isfinite(x); }))
        file.fail(0, "a bucket has no place");
      vertices += bucket->count;
    }
    content.vertices.push_back(vertices);
  }
}

Content gather(const FrameFile& file) {
  Content content;
  GraphFrame frame;
  FrameFile::Buffers buffers;
  for (FrameCursor cursor(file); cursor.frames_read() < file.header().graph_frames;) {
    cursor.next(file, frame, buffers);
    for (const SettledNode& node : frame.nodes) content.nodes.push_back(node.key);
    require_rising(file, cursor, frame, [&](std::uint64_t node) -> const SweepKey& { return content.nodes[node]; });
    for (const FileArc& arc : frame.arcs)
      content.arcs.push_back(
          {NodeId(static_cast<std::uint32_t>(arc.lo)), NodeId(static_cast<std::uint32_t>(arc.hi)), arc.born, arc.died});
    content.bucket_counts.insert(content.bucket_counts.end(), frame.bucket_counts.begin(), frame.bucket_counts.end());
    gather_buckets(file, frame, content);
    content.versions.insert(content.versions.end(), frame.versions.begin(), frame.versions.end());
    content.frame_finest.push_back(cursor.finest_complete());
  }
  return content;
}

void verify_digest(const FrameFile& file) {
  io::RunningChecksum digest;
  FrameHeader header;
  FrameFile::Buffers buffers;
  for (std::size_t i = 0; i < std::size_t{file.header().graph_frames} + file.header().pair_frames; ++i)
    digest.add(file.read_frame(i, header, buffers));
  if (digest.value() != file.header().content_digest) file.fail(0, "the digest of the content is wrong");
}

// Checks that the counts announced by the frames are those of their arcs. Returns the counts by version.
std::vector<VersionCounts> verify_versions(const FrameFile& file, const Content& content) {
  if (content.versions.size() != std::size_t{file.header().steps} + 1)
    file.fail(0, "the frames do not complete all versions");
  std::vector<double> persistence;
  for (std::size_t version = 1; version < content.versions.size(); ++version)
    persistence.push_back(content.versions[content.versions.size() - 1 - version].persistence);
  auto counts = count_versions(static_cast<std::uint32_t>(content.nodes.size()), content.arcs, content.bucket_counts,
                               persistence);
  for (std::size_t version = 0; version < counts.size(); ++version)
    if (!(counts[version] == content.versions[content.versions.size() - 1 - version]))
      file.fail(0, "version " + std::to_string(version) + " has other counts than the file says");
  return counts;
}

// Checks that each vertex of the mesh is a node or in one bucket of the full graph. Coarser versions may have dropped
// some.
void verify_vertices(const FrameFile& file, const Content& content, const std::vector<VersionCounts>& versions) {
  if (!file.header().flags.has_embedding) return;
  std::vector<std::uint64_t> change(versions.size());  // differences; they wrap around and cancel out
  for (std::size_t i = 0; i < content.arcs.size(); ++i) {
    change[content.arcs[i].born] += content.vertices[i];
    if (content.arcs[i].died != kNeverDies) change[content.arcs[i].died] -= content.vertices[i];
  }
  std::uint64_t in_buckets = 0;
  for (std::size_t version = 0; version < versions.size(); ++version) {
    in_buckets += change[version];
    const std::uint64_t vertices = in_buckets + versions[version].nodes, mesh = file.header().mesh_vertices;
    if (version == 0 ? vertices != mesh : vertices > mesh)
      file.fail(0, "version " + std::to_string(version) + " has " + std::to_string(vertices) +
                       " vertices in nodes and buckets; the mesh has " + std::to_string(mesh));
  }
}

void verify_levels(const FrameFile& file, const Content& content, const std::vector<VersionCounts>& versions) {
  for (const LevelLine& line : file.header().levels) {
    const VersionCounts& counts = versions[line.version];
    const bool needs_all_its_frames = line.frames == 1 || content.frame_finest[line.frames - 2] > line.version;
    if (line.nodes != counts.nodes || line.arcs != counts.arcs || line.buckets != counts.buckets ||
        line.threshold != level_threshold(line.version, counts.persistence) ||
        line.memory_bytes != level_memory(counts.nodes, counts.arcs, counts.buckets) ||
        content.frame_finest[line.frames - 1] > line.version || !needs_all_its_frames)
      file.fail(0, "the line of the level table for version " + std::to_string(line.version) + " is wrong");
  }
}

void verify_full_graph(const FrameFile& file, const Content& content, const ReebGraph& graph) {
  const FileHeader& header = file.header();
  const BettiNumbers betti = betti_numbers(graph);
  if (header.nodes != graph.node_count() || header.arcs != graph.arc_count() || header.components != betti.components ||
      header.loops != betti.loops || header.records != content.arcs.size())
    file.fail(0, "the full graph has other counts than the header says");
  // Cancelling adds no node: each node of any version is one of the full graph.
  if (content.nodes.size() != graph.node_count()) file.fail(0, "there are nodes that the full graph lacks");
  if (std::ranges::adjacent_find(graph.nodes) != graph.nodes.end()) file.fail(0, "a node was introduced twice");
}

void verify_pairs(const FrameFile& file, const std::vector<PairRow>& pairs) {
  const FileHeader& header = file.header();
  std::array<std::uint64_t, 4> count{};
  std::uint64_t kept = 0;
  for (const PairRow& pair : pairs) {
    ++count[static_cast<std::size_t>(pair.type)];
    kept += pair.kept ? 1 : 0;
  }
  if (count[0] != header.components) file.fail(0, "the number of Ext0 pairs is not that of components");
  if (count[1] != header.loops) file.fail(0, "the number of Ext1 pairs is not that of loops");
  if (kept != header.kept_loops) file.fail(0, "there are not as many kept loops as the header says");
}

}  // namespace

void ReebFile::verify() const {
  const FrameFile& file = *frames_;
  if (file.damage() != nullptr) throw Error(*file.damage());
  const Content content = gather(file);
  const std::vector<VersionCounts> versions = verify_versions(file, content);
  verify_levels(file, content, versions);
  verify_vertices(file, content, versions);
  for (const LevelLine& line : levels())
    if (line.file_bytes != file.end_of(line.frames)) file.fail(0, "the level table does not fit the seek table");
  verify_full_graph(file, content, load(0).graph);
  if (!header().flags.graph_only) verify_pairs(file, pairs());
  verify_digest(file);
}

}  // namespace reeb::ooc
