// Formats are told by content; a name decides only between OBJ and streaming text.
#include "io/format_detection.h"

#include "tests/io/mesh_files.h"

namespace reeb::io::testing {
namespace {

MeshFormat detect(const std::string& bytes, const std::string& name = "mesh") {
  const std::string path = write_file(name, bytes);
  return detect_format(*open_content(path), path);
}

TEST(FormatDetection, ByContent) {
  EXPECT_EQ(detect("ply\r\nformat"), MeshFormat::kPly);
  EXPECT_EQ(detect("plywood\n"), MeshFormat::kUnknown);
  EXPECT_EQ(detect("# c\n\nSTCN4nOFF\n3\n"), MeshFormat::kOff);
  EXPECT_EQ(detect("NCOFF\n"), MeshFormat::kUnknown);
  EXPECT_EQ(detect("SOLID a\nfacet"), MeshFormat::kAsciiStl);
  EXPECT_EQ(detect("solid" + std::string(79, ' ') + std::string(50, '\0')), MeshFormat::kBinaryStl);
  EXPECT_EQ(detect(std::string(84, '\0')), MeshFormat::kBinaryStl);
  EXPECT_EQ(detect("# by hand\n\n\tmtllib a.mtl\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("$ stray\nv 1 2 3\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("dear v all\n"), MeshFormat::kUnknown);
}

TEST(FormatDetection, StreamingTextAgainstObj) {
  const std::string body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -1\n";
  EXPECT_EQ(detect(body), MeshFormat::kObj);
  EXPECT_EQ(detect(body, "mesh.sma"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("# a\n# nverts 3\n" + body), MeshFormat::kStreaming);
  EXPECT_EQ(detect(body + "# nverts 3\n"), MeshFormat::kObj);
  EXPECT_EQ(detect(std::string("\0\1\2\3", 4)), MeshFormat::kStreaming);
}

}  // namespace
}  // namespace reeb::io::testing
