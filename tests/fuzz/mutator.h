// Mutates files: bits and bytes, but also fields, numbers, lines and words of a text. It also splices in parts of other
// samples and cuts files off.
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
  static constexpr std::size_t kMaxBytes = 6'000;

  Mutator(const FuzzTarget& target, std::uint64_t seed);

  // Returns a mutated sample.
  std::string next();
  // Makes one to eight changes, mostly few; most of the time it corrects checksums after them.
  void mutate(std::string& bytes);
  const std::string& sample() { return corpus_[random_.below(corpus_.size())]; }
  // All later results depend on the seed only.
  void reseed(std::uint64_t seed) { random_ = Random(seed); }

 private:
  void change_once(std::string& bytes);
  void overwrite_field(std::string& bytes);
  void overwrite_number(std::string& bytes);
  void change_line(std::string& bytes);
  void splice(std::string& bytes);
  // A position, more often near the beginning, where headers are.
  std::size_t place(const std::string& bytes);

  const FuzzTarget& target_;
  Random random_;
  std::vector<std::string> corpus_;
};

}  // namespace reeb::test
