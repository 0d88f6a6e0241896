// Every sample file gives its golden events, or ends with its class of error.
#include <gtest/gtest.h>

#include "tests/io/streaming/samples.h"
#include "tests/support/same.h"

namespace reeb::io {
namespace {

std::string warning_classes(const std::vector<std::string>& warnings) {
  std::string classes;
  for (const auto& text : warnings) {
    const std::string name = text.substr(0, text.find(':'));
    if (classes.find(name) == std::string::npos) classes += (classes.empty() ? "" : ",") + name;
  }
  return classes.empty() ? "-" : classes;
}

TEST(StreamSamples, GoodFilesGiveExactlyTheirGoldenEvents) {
  std::size_t count = 0;
  for (const Sample& sample : all_samples()) {
    if (!sample.good()) continue;
    ++count;
    const Outcome outcome = read_all(sample_bytes(sample.file), sample.file);
    EXPECT_EQ(outcome.error, "") << sample.file;
    EXPECT_TRUE(test::same(outcome.events, golden_events(sample.file))) << sample.file;
    EXPECT_EQ(warning_classes(outcome.warnings), sample.warnings) << sample.file;
  }
  EXPECT_GT(count, 250u);
}

TEST(StreamSamples, GoodFilesGiveTheSameThroughAPipe) {
  for (const Sample& sample : all_samples()) {
    if (!sample.good()) continue;
    const std::string bytes = sample_bytes(sample.file);
    for (const std::size_t step : {1u, 7u, 1000u}) {
      std::ostringstream out;
      const auto reader = open_stream(std::make_unique<test::BytesSource>(bytes, step), sample.file);
      write_all_events(*reader, out);
      EXPECT_TRUE(test::same(out.str(), golden_events(sample.file))) << sample.file << " by " << step;
      if (sample.warnings != "TRAIL") {
        EXPECT_EQ(reader->bytes_read(), bytes.size()) << sample.file;
      }
    }
  }
}

TEST(StreamSamples, MalformedFilesGetTheirVerdict) {
  std::size_t count = 0;
  for (const Sample& sample : all_samples()) {
    if (sample.good()) continue;
    ++count;
    const Outcome outcome = read_all(sample_bytes(sample.file), sample.file);
    EXPECT_NE(outcome.error, "") << sample.file;
    if (sample.verdict.starts_with("any error")) continue;
    EXPECT_TRUE(outcome.error.starts_with(sample.verdict + ": "))
        << sample.file << " is " << sample.verdict << ", but: " << outcome.error;
    EXPECT_TRUE(golden_events(sample.file).starts_with(outcome.events)) << sample.file;
  }
  EXPECT_GT(count, 70u);
}

TEST(StreamSamples, SmallExampleOfTheCompressedFormat) {
  static constexpr unsigned char kFile[] = {
      0x03, 0x01, 0,    0,    0, 0, 0,    0,    0,    0,    0,    0,    0,    0, 0, 0,    0, 0, 0,
      4,    0x10, 0x4f, 0,    0, 0, 0,    0,    4,    0x10, 0x4f, 0,    0,    0, 0, 0,    0, 0, 0,
      0,    0,    0x41, 0x80, 0, 0, 0x12, 0xba, 0xad, 0x80, 4,    0xa4, 0x25, 0, 0, 0x3c, 0, 0, 0x38};
  const Outcome outcome = read_all(std::string(reinterpret_cast<const char*>(kFile), sizeof kFile));
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.events, "v 0 0 0 0\nv 1 0 1 0\nv 2 1 0 0\nt 0 1 2\nv 3 0 0 1\nt 0 2 3\n");
}

}  // namespace
}  // namespace reeb::io
