// Changes files so that readers have to think: bits and bytes, but also whole numbers, fields, lines and
// words of a text, pieces of other samples, and ends cut off.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/targets.h"
#include "tests/support/random.h"

namespace reeb::test {

class Mutator {
 public:
  // Inputs longer than this are cut.
  static constexpr std::size_t kMostBytes = 6'000;

  Mutator(const FuzzTarget& target, std::uint64_t seed);

  // A changed sample.
  std::string next();
  // One to eight changes, mostly few; checksums are mended most of the time.
  void mutate(std::string& bytes);
  const std::string& sample() { return corpus_[random_.below(corpus_.size())]; }
  // What follows depends on the seed only.
  void reseed(std::uint64_t seed) { random_ = Random(seed); }

 private:
  void change_once(std::string& bytes);
  void overwrite_field(std::string& bytes);
  void overwrite_number(std::string& bytes);
  void change_line(std::string& bytes);
  void splice(std::string& bytes);
  // A place, more often near the beginning, where headers are.
  std::size_t place(const std::string& bytes);

  const FuzzTarget& target_;
  Random random_;
  std::vector<std::string> corpus_;
};

}  // namespace reeb::test
