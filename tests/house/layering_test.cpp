// The include rules between rooms (folders). A room may include itself and the rooms that its line in kRooms names. A
// line names only rooms above it, so rooms form no cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

using Rooms = std::vector<std::pair<std::string, std::set<std::string>>>;

// A name without a slash stands for all rooms of that layer.
const Rooms kRooms = {
    {"libreeb/base", {}},
    {"libreeb/containers", {"libreeb/base"}},
    {"libreeb/graph", {"libreeb/base", "libreeb/containers"}},
    {"libreeb/port", {"libreeb/base", "libreeb/graph"}},
    {"libreeb/sweep", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port"}},
    {"libreeb/engine", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port", "libreeb/sweep"}},
    {"libreeb/parts",
     {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port", "libreeb/sweep", "libreeb/engine"}},
    {"libreeb/grid", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port", "libreeb/sweep"}},
    {"libreeb/hierarchy", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port"}},
    {"libreeb/noise", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port", "libreeb/hierarchy"}},
    {"libreeb/defects", {"libreeb/base", "libreeb/containers", "libreeb/graph"}},
    {"libreeb/repair", {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/defects"}},
    {"libreeb/segmentation",
     {"libreeb/base", "libreeb/containers", "libreeb/graph", "libreeb/port", "libreeb/hierarchy"}},
    {"libreeb/format", {"libreeb/base", "libreeb/graph", "libreeb/port", "libreeb/hierarchy"}},

    {"io/file", {"libreeb/base"}},
    {"io/text", {"libreeb", "io/file"}},
    {"io/mesh", {"libreeb", "io/file", "io/text"}},
    {"io/events", {"libreeb", "io/file", "io/text", "io/mesh"}},
    {"io/smc", {"libreeb", "io/file", "io/text", "io/events"}},
    {"io/streaming", {"libreeb", "io/file", "io/text", "io/mesh", "io/events", "io/smc"}},
    {"io/ply", {"libreeb", "io/file", "io/text", "io/mesh"}},
    {"io/decoding", {"libreeb", "io/file", "io/text", "io/mesh"}},
    {"io/images", {"libreeb", "io/file", "io/text", "io/mesh", "io/decoding"}},
    {"io/grids", {"libreeb"}},
    {"io/cells", {"libreeb", "io/file", "io/text", "io/mesh"}},
    {"io/vtk", {"libreeb", "io/file", "io/text", "io/mesh", "io/decoding", "io/cells"}},
    {"io/formats",
     {"libreeb", "io/file", "io/text", "io/mesh", "io/events", "io/streaming", "io/ply", "io/images", "io/grids",
      "io/cells", "io/vtk"}},
    {"io/fields", {"libreeb"}},
    {"io/functions", {"libreeb", "io/file", "io/text", "io/mesh", "io/images", "io/formats", "io/fields"}},
    {"io/export", {"libreeb", "io/file", "io/text"}},
    {"io/drawing", {"libreeb", "io/text"}},
    {"io/plot", {"libreeb", "io/text", "io/export", "io/drawing"}},
    {"io/generate", {"libreeb", "io/text"}},

    {"ooc/threads", {"libreeb"}},
    {"ooc/sorting", {"libreeb", "io/file", "ooc/threads"}},
    {"ooc/tables", {"libreeb", "io/file", "ooc/threads", "ooc/sorting"}},
    {"ooc/states", {"libreeb", "io/file"}},
    {"ooc/chunks", {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables", "ooc/states"}},
    {"ooc/guesses", {"libreeb", "io/file", "ooc/threads", "ooc/tables", "ooc/chunks"}},
    {"ooc/grids", {"libreeb", "io/file", "ooc/chunks"}},
    {"ooc/whole_mesh", {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables", "ooc/chunks"}},
    {"ooc/census", {"libreeb", "io/file", "ooc/threads", "ooc/chunks", "ooc/whole_mesh"}},
    {"ooc/stored_graph", {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables"}},
    {"ooc/reeb_file", {"libreeb", "io/file"}},
    {"ooc/reeb_writer", {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables"}},
    {"ooc/stored_hierarchy",
     {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables", "ooc/stored_graph", "ooc/reeb_writer"}},
    {"ooc/patches", {"libreeb", "io/file", "ooc/threads", "ooc/sorting", "ooc/tables", "ooc/whole_mesh"}},
    {"ooc/segmentation", {"libreeb", "io/file", "ooc/sorting", "ooc/tables", "ooc/stored_graph"}},
    {"ooc/checkpoints", {"libreeb", "io/file", "ooc/states", "ooc/chunks"}},
    {"ooc/run", {"libreeb", "io/file", "ooc"}},
    {"ooc/distributed", {"libreeb", "io/file", "ooc"}},

    {"tools/library", {"libreeb", "io", "ooc"}},
    {"tools/program", {"libreeb", "io", "ooc", "tools/library"}},
    {"tools/meshes", {"libreeb", "io", "ooc", "tools/library", "tools/program"}},
    {"tools/arguments", {"libreeb", "io", "tools/program"}},
    {"tools/checks", {"libreeb", "io", "ooc", "tools/library"}},
    {"tools/defects", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/meshes", "tools/checks"}},
    {"tools/plot",
     {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/arguments", "tools/checks", "tools/defects"}},
    {"tools/report", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/checks", "tools/defects"}},
    {"tools/repair", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/defects"}},
    {"tools/view", {"libreeb", "io/file", "io/text", "tools/program"}},
    {"tools/runs", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/arguments"}},
    {"tools/mpi", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/arguments", "tools/runs"}},
    {"tools/python", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/defects", "tools/plot"}},
    {"tools/measures", {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/checks"}},
    {"tools/commands",
     {"libreeb", "io", "ooc", "tools/library", "tools/program", "tools/arguments", "tools/checks", "tools/defects",
      "tools/plot", "tools/report", "tools/repair", "tools/view", "tools/runs", "tools/measures", "tools/meshes"}},
    {"tools", {"libreeb", "io", "ooc", "tools"}},
    {"tests", {"libreeb", "io", "ooc", "tools", "tests"}},
    {"bench", {"libreeb", "io", "ooc", "tests/support", "bench"}},
};

// libreeb uses no files and no threads; its only lock guards the memory budget. Two sources have instructions of the
// processor in them, which the compiler's own header declares.
const std::set<std::string> kForbiddenHeaders = {
    "atomic", "barrier", "condition_variable", "filesystem",   "fstream",    "future",     "iostream",
    "latch",  "mutex",   "semaphore",          "shared_mutex", "stop_token", "syncstream", "thread"};
const std::set<std::pair<std::string, std::string>> kExceptions = {
    {"memory_budget.h", "mutex"}, {"arc_slots.cpp", "immintrin.h"}, {"wide_sums.cpp", "immintrin.h"}};

std::string layer_of(const std::string& room) { return room.substr(0, room.find('/')); }

// The room of a file, from its path below the root. For tests and bench, whose rooms are not distinguished, it is the
// layer.
std::string room_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().generic_string();
  const std::string layer = layer_of(folder);
  if (layer == "tests") return folder.starts_with("tests/support") ? "tests/support" : "tests";
  return layer == "bench" ? layer : folder;
}

const std::set<std::string>* allowed_for(const std::string& room) {
  const auto it = std::ranges::find_if(kRooms, [&](const auto& entry) {
    return entry.first == room || (layer_of(room) == "tests" && entry.first == "tests");
  });
  return it == kRooms.end() ? nullptr : &it->second;
}

// What is wrong with one line of the file `path`; empty if it is allowed.
std::string violation(const std::string& path, const std::string& line) {
  static const std::regex kQuoted(R"re(^\s*#\s*include\s*"([^"]+)")re");
  static const std::regex kAngled(R"re(^\s*#\s*include\s*<([^>]+)>)re");
  const std::string room = room_of(path);
  const std::set<std::string>* const allowed = allowed_for(room);
  if (allowed == nullptr) return "the room " + room + " is not in the table";
  std::smatch match;
  if (std::regex_search(line, match, kQuoted)) {
    const std::string header = match[1];
    if (header.find('/') == std::string::npos) return "not root-relative: " + line;
    const std::string other = room_of(header);
    if (other != room && !allowed->contains(other) && !allowed->contains(layer_of(other))) return line;
  } else if (layer_of(room) == "libreeb" && std::regex_search(line, match, kAngled)) {
    const std::string header = match[1];
    if (kExceptions.contains({fs::path(path).filename().string(), header})) return {};
    if (header.find_first_of("/.") != std::string::npos) return "beyond the standard library: " + line;
    if (kForbiddenHeaders.contains(header)) return "a file or a thread: " + line;
  }
  return {};
}

std::vector<std::string> source_files(const fs::path& root, const std::string& layer,
                                      const std::set<std::string>& suffixes = {".h", ".cpp"}) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root / layer))
    if (suffixes.contains(entry.path().extension().string()))
      files.push_back(entry.path().lexically_relative(root).generic_string());
  return files;
}

TEST(Layering, EveryIncludeIsAllowed) {
  const fs::path root = REEB_SOURCE_DIR;
  for (const char* layer : {"libreeb", "io", "ooc", "tools", "tests", "bench"}) {
    const auto files = source_files(root, layer);
    EXPECT_FALSE(files.empty()) << layer;
    for (const std::string& file : files) {
      std::ifstream in(root / file);
      for (std::string line; std::getline(in, line);) EXPECT_EQ(violation(file, line), "") << "in " << file;
    }
  }
}

// Each room names only rooms above it in the table.
TEST(Layering, TheTableHasNoCycle) {
  std::set<std::string> before;
  for (const auto& [room, allowed] : kRooms) {
    for (const std::string& other : allowed) {
      if (layer_of(room) == other || other.starts_with("tests")) continue;  // the last room of its layer
      const bool is_layer = other.find('/') == std::string::npos;
      const bool known = is_layer ? std::ranges::any_of(before, [&](const auto& b) { return layer_of(b) == other; })
                                  : before.contains(other);
      EXPECT_TRUE(known) << room << " names " << other;
    }
    before.insert(room);
  }
}

// A part is a header with its source file, or a file in another language.
TEST(Layering, RoomsAreSmall) {
  constexpr std::size_t kMaxParts = 15, kMaxLooseFiles = 5;
  const fs::path root = REEB_SOURCE_DIR;
  for (const char* layer : {"libreeb", "io", "ooc", "tools", "tests"}) {
    std::map<std::string, std::set<std::string>> parts;
    const std::set<std::string> suffixes = {".h", ".cpp", ".ts", ".js", ".mjs", ".html", ".css", ".py", ".sh"};
    for (const std::string& file : source_files(root, layer, suffixes))
      parts[fs::path(file).parent_path().generic_string()].insert(fs::path(file).stem().string());
    for (const auto& [room, names] : parts) EXPECT_LE(names.size(), kMaxParts) << room;
    const auto loose = std::distance(fs::directory_iterator(root / layer), fs::directory_iterator());
    const auto folders = std::count_if(fs::directory_iterator(root / layer), fs::directory_iterator(),
                                       [](const fs::directory_entry& entry) { return entry.is_directory(); });
    EXPECT_LE(static_cast<std::size_t>(loose - folders), kMaxLooseFiles) << layer;
  }
}

// Two types of one name in one namespace are undefined behaviour, even in headers that no source includes together: the
// linker keeps one destructor of both. Types of an unnamed namespace do not count.
std::map<std::string, std::set<std::string>> type_definitions(const std::string& file, const std::string& text) {
  static const std::regex opens(R"(^namespace ([\w:]*) ?\{)"), closes(R"(^\}  // namespace)"),
      defines(R"(^(?:template <.*> )?(?:struct|class|enum class|enum) (\w+)(?: final)?(?: : [^;]*| :)? ?\{)");
  std::map<std::string, std::set<std::string>> found;
  std::vector<std::string> spaces;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, opens))
      spaces.push_back(match[1]);
    else if (std::regex_search(line, closes) && !spaces.empty())
      spaces.pop_back();
    else if (std::ranges::count(spaces, "") == 0 && std::regex_search(line, match, defines)) {
      std::string name;
      for (const std::string& space : spaces) name += space + "::";
      found[name + match[1].str()].insert(file);
    }
  }
  return found;
}

TEST(Layering, ATypeIsDefinedOnce) {
  const fs::path root = REEB_SOURCE_DIR;
  std::map<std::string, std::set<std::string>> definitions;
  for (const char* layer : {"libreeb", "io", "ooc", "tools"})
    for (const std::string& file : source_files(root, layer)) {
      std::ifstream stream(root / file);
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      for (const auto& [type, files] : type_definitions(file, text))
        definitions[type].insert(files.begin(), files.end());
    }
  EXPECT_GT(definitions.size(), 300u);
  for (const auto& [type, files] : definitions)
    EXPECT_EQ(files.size(), 1u) << type << " is defined in " << testing::PrintToString(files);
  EXPECT_EQ(type_definitions("a.h", "namespace reeb::io {\nstruct Image {\n}\n}  // namespace reeb::io\nclass B : A {"),
            (std::map<std::string, std::set<std::string>>{{"reeb::io::Image", {"a.h"}}, {"B", {"a.h"}}}));
  EXPECT_TRUE(type_definitions("a.cpp", "namespace reeb {\nnamespace {\nstruct Image {").empty());
}

TEST(Layering, AViolationIsSeen) {
  const auto seen = [](const char* path, const char* line) { return !violation(path, line).empty(); };
  EXPECT_TRUE(seen("io/text/cursor.h", "#include \"ooc/run/compute.h\""));
  EXPECT_TRUE(seen("ooc/run/compute.cpp", "#include \"io/formats/open_mesh.h\""));
  EXPECT_TRUE(seen("io/file/file.cpp", "#include \"io/formats/open_mesh.h\""));
  EXPECT_TRUE(seen("libreeb/graph/bucket.h", "#include \"libreeb/hierarchy/hierarchy.h\""));
  EXPECT_TRUE(seen("libreeb/port/graph_sink.h", "#include \"libreeb/engine/glue.h\""));
  EXPECT_TRUE(seen("libreeb/base/error.h", "#include <tbb/tbb.h>"));
  EXPECT_TRUE(seen("libreeb/engine/glue.cpp", "#include <thread>"));
  EXPECT_TRUE(seen("libreeb/engine/glue.cpp", "  #  include <fstream>"));
  EXPECT_TRUE(seen("libreeb/engine/glue.cpp", "#include \"glue.h\""));
  EXPECT_TRUE(seen("tests/whole/model_test.cpp", "#include \"bench/made_graph.h\""));
  EXPECT_TRUE(seen("ooc/cellar/file.h", "#include <vector>"));
  EXPECT_FALSE(seen("ooc/run/compute.cpp", "#include \"io/file/file.h\""));
  EXPECT_FALSE(seen("libreeb/base/memory_budget.h", "#include <mutex>"));
  EXPECT_FALSE(seen("bench/reader_bench.cpp", "#include \"tests/support/held_memory.h\""));
}

}  // namespace
