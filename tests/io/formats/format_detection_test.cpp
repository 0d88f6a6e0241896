// Formats are detected from the content; the name decides only between OBJ and streaming text.
#include "io/formats/format_detection.h"

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/file/zstd_codec.h"
#include "io/formats/format_names.h"
#include "io/images/image_format.h"
#include "tests/io/formats/mesh_files.h"
#include "tests/io/images/nifti_files.h"

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

// One triangle in post-order, with a comment of eleven bytes. Its last word, a coordinate, is 0: a binary STL file of
// 84 bytes has no facets.
TEST(FormatDetection, AStreamOfTheSizeOfABinaryStlFile) {
  std::string bytes(4, '\0');
  const auto put = [&bytes](auto word) { bytes.append(reinterpret_cast<const char*>(&word), sizeof word); };
  for (const std::uint32_t word : {1u, 11u}) put(word);
  bytes += "eleven char";
  for (const std::uint32_t word : {3u, 1u}) put(word);
  bytes += '\0';
  for (const std::uint32_t word : {0b1110u, 1u, 2u, 3u}) put(word);
  for (const float x : {0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) put(x);
  ASSERT_EQ(bytes.size(), 84u);
  EXPECT_EQ(detect(bytes), MeshFormat::kStreaming);
  EXPECT_EQ(detect(bytes, "a.smb"), MeshFormat::kStreaming);
  const std::string path = write_file("chosen", bytes);
  EXPECT_EQ(chosen_format("smb", *open_content(path)), MeshFormat::kStreaming);
  // Some programs leave what was in memory as the title of an STL file.
  EXPECT_EQ(detect(bytes, "a.stl"), MeshFormat::kBinaryStl);
  EXPECT_EQ(chosen_format("stl", *open_content(path)), MeshFormat::kBinaryStl);
}

TEST(FormatDetection, StreamingTextAgainstObj) {
  const std::string body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -1\n";
  EXPECT_EQ(detect(body), MeshFormat::kObj);
  EXPECT_EQ(detect(body, "mesh.sma"), MeshFormat::kStreaming);
  EXPECT_EQ(detect(body, "MESH.SMA"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("# a\n# nverts 3\n" + body), MeshFormat::kStreaming);
  EXPECT_EQ(detect("# nverts 3\n" + body, "mesh.obj"), MeshFormat::kObj);
  EXPECT_EQ(detect("# nverts 3\n" + body + "x 1\n", "mesh.obj"), MeshFormat::kStreaming);
  EXPECT_EQ(detect(body + "# nverts 3\n"), MeshFormat::kObj);
  EXPECT_EQ(detect(std::string("\0\1\2\3", 4)), MeshFormat::kStreaming);
}

// Of packed files and pipes the size is not known.
TEST(FormatDetection, StreamingTextAgainstObjWhereItIsPacked) {
  const auto detect_packed = [](const std::string& text, const std::string& name) {
    std::vector<std::byte> packed;
    zstd_compress(std::as_bytes(std::span(text)), 1, packed);
    return detect({reinterpret_cast<const char*>(packed.data()), packed.size()}, name);
  };
  const std::string text = "# nverts 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n";
  EXPECT_EQ(detect_packed(text, "mesh.obj.zst"), MeshFormat::kObj);
  EXPECT_EQ(detect_packed(text, "mesh.zst"), MeshFormat::kStreaming);
}

TEST(FormatDetection, StreamingTextWithoutHeadShowsInItsLines) {
  EXPECT_EQ(detect("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("# by hand\r\n\r\nf 1\t2 3\r\nv 0 0 0\r\n"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nx 1\n"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("x 1\nv 0 0 0\n"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nc -1 2 3 -4 0.5\n"), MeshFormat::kStreaming);
  EXPECT_EQ(detect("c 1 2 3 4\nv 0 0 0\n"), MeshFormat::kStreaming);
  // Lines that only OBJ has.
  EXPECT_EQ(detect("f 1/1 2/2 3/3\nv 0 0 0\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("f 1 2 3 4\nv 0 0 0\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("f -1 -2 -3\nv 0 0 0\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("g part\nv 0 0 0\nf 1 1 1\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("v 0 0 0\nx y z\n"), MeshFormat::kObj);
  EXPECT_EQ(detect("v 0 0 0\nc 1 2 3\nc 1 2 3 a\n"), MeshFormat::kObj);
}

TEST(FormatDetection, APostOrderStreamIsKnownBeforeThePipeEnds) {
  const std::string bytes =
      "f 1 2 3\nf 1 3 4\nv 0 0 0\nf 2 3 4\nv 0 1 0\nv 1 0 0\nv 0 0 1\nf 5 6 7\nv 0 0 0\nv 1 1 1\n";
  ASSERT_EQ(bytes.size(), 80u) << "what is waited for";
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  const auto source = open_content("/proc/self/fd/" + std::to_string(ends[0]));
  // The other end stays open: asking for more bytes would wait forever.
  EXPECT_EQ(detect_format(*source, "-"), MeshFormat::kStreaming);
  ::close(ends[0]);
  ::close(ends[1]);
}

// The first bytes are those of a streaming mesh, too.
TEST(FormatDetection, ABigEndianNiftiImageIsNoStreamingMeshOnAPipe) {
  const std::string bytes = nifti({.dim = {3, 2, 2, 2}, .big_endian = true}, "12345678");
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  ::close(ends[1]);
  const auto source = open_content("/proc/self/fd/" + std::to_string(ends[0]));
  EXPECT_EQ(detect_format(*source, "-"), MeshFormat::kUnknown);
  EXPECT_EQ(image_format_of(source->view(0)), ImageFormat::kNifti);
  ::close(ends[0]);
}

}  // namespace
}  // namespace reeb::io::testing
