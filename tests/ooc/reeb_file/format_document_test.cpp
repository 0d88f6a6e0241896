// The writer writes the example in docs/FORMAT.md byte for byte, and the reader reads it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/reeb_file_writer.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

std::string bytes_of_document() {
  std::ifstream in(REEB_SOURCE_DIR "/docs/FORMAT.md");
  std::string bytes, line;
  while (std::getline(in, line) && line != "```hex") {
  }
  while (std::getline(in, line) && line != "```") {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    words >> word;  // the offset
    EXPECT_EQ(std::stoul(word, nullptr, 16), bytes.size());
    while (words >> word) bytes += static_cast<char>(std::stoul(word, nullptr, 16));
  }
  return bytes;
}

TEST(FormatDocument, TheExampleIsWhatIsWritten) {
  ReebGraph graph;
  for (std::uint64_t i = 0; i < 4; ++i) graph.nodes.push_back({static_cast<double>(i), VertexId(10 + i)});
  graph.lo = {NodeId(0), NodeId(1), NodeId(1), NodeId(2)};
  graph.hi = {NodeId(1), NodeId(2), NodeId(2), NodeId(3)};
  Hierarchy hierarchy;
  hierarchy.pairs = {{NodeId(1), NodeId(2), PairType::kExt1, false}, {NodeId(0), NodeId(3), PairType::kExt0, false}};
  hierarchy.persistence = {1.0};
  for (std::size_t i = 0; i < 4; ++i) hierarchy.arcs.push_back({graph.lo[i], graph.hi[i], 0, 1});
  hierarchy.arcs.push_back({NodeId(0), NodeId(3), 1, kNeverDies});
  FileMeta meta{.function = "z", .function_min = 0, .function_max = 3, .mesh_vertices = 6, .mesh_triangles = 4};

  const std::string path = (fs::temp_directory_path() / ("reeb-document-" + std::to_string(getpid()))).string();
  write_hierarchy_file(path, meta, graph, hierarchy);
  std::string written(fs::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(written.data(), static_cast<std::streamsize>(written.size()));
  const std::string documented = bytes_of_document();
  ASSERT_GT(documented.size(), 500u);
  EXPECT_EQ(written, documented);
  const ReebFile file(path);
  EXPECT_NO_THROW(file.verify());
  EXPECT_EQ(file.load(file.version_at(1.0)).graph, graph);
  EXPECT_EQ(file.load(file.version_at(1.5)).graph.arc_count(), 1u);
  fs::remove(path);
}

}  // namespace
}  // namespace reeb::ooc
