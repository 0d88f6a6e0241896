// Damaged files: every prefix of small samples, and the classes of faults. Random changes are in tests/fuzz.
#include <gtest/gtest.h>

#include <limits>

#include "io/events/stream_writer.h"
#include "tests/io/streaming/samples.h"

namespace reeb::io {
namespace {

constexpr std::size_t kSmallBytes = 150;

TEST(StreamRobustness, NoPrefixOfABinarySampleReadsAsAWholeFile) {
  for (const Sample& sample : all_samples()) {
    const std::string bytes = sample_bytes(sample.file);
    if (bytes.size() > kSmallBytes) continue;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string prefix = bytes.substr(0, size);
      const Outcome outcome = read_all(prefix, sample.file);
      // The code stream contains its own end and length, so every prefix is an error.
      if (!sample.good() || !sample.file.ends_with(".smc") || sample.warnings == "TRAIL") continue;
      EXPECT_TRUE(outcome.error.starts_with("TRUNCATED: ")) << sample.file << " cut at " << size;
      EXPECT_TRUE(golden_events(sample.file).starts_with(outcome.events)) << sample.file;
    }
  }
}

TEST(StreamRobustness, AHeaderThatPromisesMuchCostsNothing) {
  const std::string many = "# nverts 2000000000\n# nfaces 2000000000\nv 0 0 0\n";
  EXPECT_EQ(read_all(many).error, "TRUNCATED: file ends after 1 of 2000000000 vertices");
  std::string comments(8, '\0');
  comments[4] = '\1';
  comments += std::string("\xff\xff\x0f\0", 4);  // a comment of a megabyte that is not there
  EXPECT_TRUE(read_all(comments).error.starts_with("TRUNCATED: "));
}

TEST(StreamRobustness, FinalizedVerticesStayFinalAcrossPages) {
  std::string text;
  for (int i = 0; i < 10000; ++i) text += "v 0 0 0\nx -1\n";
  EXPECT_EQ(read_all(text).error, "");
  EXPECT_TRUE(read_all(text + "x 1\n").error.starts_with("FINAL_INDEX: "));
  EXPECT_TRUE(read_all(text + "f 1 2 3\n").error.starts_with("FINAL_INDEX: "));
  EXPECT_TRUE(read_all(text + "x 10001\n").error.starts_with("BAD_INDEX: "));
}

TEST(StreamRobustness, NumbersAreTheNearestFloats) {
  const Outcome hex = read_all("v 0x1.8p1 -0x1p-149 +2e-60\nv 0x1p-2000 -0 1e-45\n");
  EXPECT_EQ(hex.error, "");
  EXPECT_EQ(hex.events, "v 0 3 -1.40129846e-45 0\nv 1 0 -0 1.40129846e-45\n");
  EXPECT_TRUE(read_all("v 0x1p128 0 0\n").error.starts_with("BAD_NUMBER: "));
  EXPECT_TRUE(read_all("v 0 0 --1\n").error.starts_with("BAD_NUMBER: "));
}

// A grid with two places per axis, at a distance of the longest side of the box. On the second axis the upper place is
// above the largest float32, by a quarter of that distance.
TEST(StreamRobustness, APlaceOfTheGridBeyondFloat32IsNoCoordinate) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  StreamHeader header;
  header.box = StreamBox{{0, kLargest / 4, 0}, {kLargest, kLargest, 1}};
  std::ostringstream out;
  const auto writer = make_smc_writer(out, header, {.version = 3, .precision = 1});
  for (std::uint32_t v = 0; v < 3; ++v) {
    StreamEvent vertex{};
    vertex.kind = EventKind::kVertex;
    vertex.vertex = v;
    vertex.floats = {0, kLargest, 0};
    writer->write(vertex);
  }
  StreamEvent triangle{};
  triangle.kind = EventKind::kTriangle;
  triangle.corners = {0, 1, 2, 0};
  writer->write(triangle);
  writer->close();
  const Outcome outcome = read_all(out.str());
  EXPECT_TRUE(outcome.error.starts_with("BAD_NUMBER: ")) << outcome.error;
  EXPECT_EQ(outcome.events, "");
}

}  // namespace
}  // namespace reeb::io
