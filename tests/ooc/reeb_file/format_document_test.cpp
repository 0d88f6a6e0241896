// The writer writes the example in docs/FORMAT.md byte for byte, and the readers read it, unless a rule is broken.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "ooc/reeb_file/level_history.h"
#include "ooc/reeb_file/progressive_graph.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/support/scratch.h"

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

// Makes the checksum of the graph frame right again.
void sign_graph_frame(std::string& file) {
  constexpr std::size_t kBegin = 0x129, kChecksum = 0x149, kPayload = 0x151, kEnd = 0x1a1;
  const std::string covered = file.substr(kBegin, kChecksum - kBegin) + file.substr(kPayload, kEnd - kPayload);
  const std::uint64_t sum = io::checksum(std::as_bytes(std::span(covered)));
  std::memcpy(file.data() + kChecksum, &sum, sizeof sum);
}

TEST(FormatDocument, EveryReaderRefusesRecordsThatFallAndOtherCounts) {
  const Scratch folder;
  const std::string path = folder.path() + "/a.reeb";
  const std::map<std::string, std::function<void()>> readers = {
      {"load", [&] { ReebFile(path).load(0); }},
      {"verify", [&] { ReebFile(path).verify(); }},
      {"load_graph", [&] { ReebFile(path).load_graph(0); }},
      {"history", [&] { read_history(path, 0, [](const auto&...) {}); }},
      {"progressive",
       [&] {
         const ReebFile file(path);
         ProgressiveGraph(file).go_to_version(0);
       }},
      {"refined", [&] {
         const ReebFile file(path);
         ProgressiveGraph graph(file);
         graph.go_to_version(1);
         graph.go_to_version(0);
       }}};
  struct Edit {
    std::size_t at;
    char byte;
    std::string why;  // nothing: the file is as it was
  };
  for (const Edit& edit : {Edit{0x162, 2, ""}, Edit{0x162, 4, "has other counts than the file says"},
                           Edit{0x19d, 0, "an arc does not go up"}}) {
    std::string bytes = bytes_of_document();
    bytes[edit.at] = edit.byte;
    sign_graph_frame(bytes);
    std::ofstream(path, std::ios::binary) << bytes;
    for (const auto& [name, read] : readers) {
      SCOPED_TRACE(name + ": " + edit.why);
      try {
        read();
        EXPECT_TRUE(edit.why.empty());
      } catch (const Error& error) {
        EXPECT_FALSE(edit.why.empty());
        EXPECT_TRUE(error.message().ends_with(edit.why)) << error.message();
      }
    }
  }
}

}  // namespace
}  // namespace reeb::ooc
