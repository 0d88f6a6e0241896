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

// SMB with `count` comments of 50000 bytes each, one of 10 bytes, and a triangle.
std::string with_long_comments(std::size_t count) {
  StreamHeader header;
  for (std::size_t i = 0; i < count; ++i) header.comments.emplace_back(50000, static_cast<char>('a' + i));
  header.comments.emplace_back("the end...");
  std::ostringstream out;
  const auto writer = make_block_writer(out, header);
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto reader = open_bytes(triangle);
  for (const StreamEvent* event = reader->next(); event != nullptr; event = reader->next()) writer->write(*event);
  writer->close();
  return out.str();
}

// A head can be longer than all that a source shows at once.
TEST(StreamRobustness, LongCommentsAreReadWhole) {
  constexpr std::size_t kCount = 5;
  const std::string bytes = with_long_comments(kCount);
  for (const std::size_t step : {std::size_t{1}, std::size_t{65536}, bytes.size()}) {
    const auto reader = open_stream(std::make_unique<test::BytesSource>(bytes, step));
    ASSERT_EQ(reader->header().comments.size(), kCount + 1);
    for (std::size_t i = 0; i < kCount; ++i)
      EXPECT_EQ(reader->header().comments[i], std::string(50000, static_cast<char>('a' + i)));
    EXPECT_EQ(reader->header().comments.back(), "the end...");
    std::ostringstream out;
    write_all_events(*reader, out);
    EXPECT_EQ(out.str(), "v 0 0 0 0\nv 1 1 0 0\nv 2 0 1 0\nt 0 1 2\n");
  }
}

TEST(StreamRobustness, CommentsHaveALimit) {
  std::string lines, text;
  for (int i = 0; i < 160'000; ++i) lines += "# c\n";
  for (int i = 0; i < 320; ++i) text += "# " + std::string(50001, 'c') + "\n";
  EXPECT_EQ(read_all(lines + "v 0 0 0\n").error, "");
  EXPECT_EQ(read_all(lines + "# c\nv 0 0 0\n").error, "BAD_HEADER: the file has more than 160,000 comments");
  EXPECT_EQ(read_all(text + "v 0 0 0\n").error,
            "BAD_HEADER: the comments of the file have more than 16,000,000 characters in all");
}

TEST(StreamRobustness, AFaultAfterLongCommentsHasItsPlace) {
  const std::string bytes = with_long_comments(2);
  constexpr std::size_t kLength = 8 + 2 * 50004;  // offset of the length of the last comment
  const auto error_of = [](const std::string& file) {
    try {
      open_bytes(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of(bytes.substr(0, kLength + 2)),
            std::to_string(kLength) + ": TRUNCATED: file ends inside the header");
  EXPECT_EQ(error_of(bytes.substr(0, kLength + 7)),
            std::to_string(kLength + 4) + ": TRUNCATED: file ends inside the header");
  std::string odd = bytes;
  odd[kLength + 3] = '\1';
  EXPECT_EQ(error_of(odd), std::to_string(kLength + 4) + ": BAD_HEADER: comment length 16777226 is not plausible");
  odd = bytes;
  odd[kLength + 4 + 10 + 3] = '\x80';  // the number of vertices
  EXPECT_EQ(error_of(odd),
            std::to_string(kLength + 18) + ": BAD_HEADER: number of vertices -2147483645 is not plausible");
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
