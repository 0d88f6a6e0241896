// Damaged files: every prefix of small samples, random changes of all. Run it under sanitizers.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "tests/fuzz/stream_fuzz.h"
#include "tests/streaming/samples.h"

namespace reeb::io {
namespace {

constexpr std::size_t kSmallBytes = 150;
constexpr auto kMutationTime = std::chrono::seconds(2);

void fuzz(const std::string& bytes) { fuzz_stream(std::as_bytes(std::span(bytes))); }

TEST(StreamRobustness, NoPrefixOfABinarySampleReadsAsAWholeFile) {
  REEB_REQUIRE_SAMPLES();
  for (const Sample& sample : all_samples()) {
    const std::string bytes = sample_bytes(sample.file);
    if (bytes.size() > kSmallBytes) continue;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string prefix = bytes.substr(0, size);
      fuzz(prefix);
      // The code stream has an end of its own and its length in it.
      if (!sample.good() || !sample.file.ends_with(".smc") || sample.warnings == "TRAIL") continue;
      const Outcome outcome = read_all(prefix, sample.file);
      EXPECT_TRUE(outcome.error.starts_with("TRUNCATED: ")) << sample.file << " cut at " << size;
      EXPECT_TRUE(golden_events(sample.file).starts_with(outcome.events)) << sample.file;
    }
  }
}

// One to four changes: a bit, a byte, a piece cut out or doubled.
void mutate(std::string& bytes, std::mt19937_64& random) {
  for (std::uint64_t n = 1 + random() % 4; n > 0 && !bytes.empty(); --n) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at, random() % 40);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, random() % 40));
        break;
      default:
        bytes[at] = "\x00\x7f\xff-0"[random() % 5];
        break;
    }
  }
}

TEST(StreamRobustness, ChangedSamplesNeverCrash) {
  REEB_REQUIRE_SAMPLES();
  const std::uint64_t seed = std::random_device{}();
  RecordProperty("seed", std::to_string(seed));
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  std::mt19937_64 random(seed);
  std::vector<std::string> corpus;
  for (const Sample& sample : all_samples())
    if (auto bytes = sample_bytes(sample.file); bytes.size() < 20000) corpus.push_back(bytes);
  ASSERT_FALSE(corpus.empty());
  const auto end = std::chrono::steady_clock::now() + kMutationTime;
  while (std::chrono::steady_clock::now() < end) {
    std::string bytes = corpus[random() % corpus.size()];
    mutate(bytes, random);
    fuzz(bytes);
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

}  // namespace
}  // namespace reeb::io
