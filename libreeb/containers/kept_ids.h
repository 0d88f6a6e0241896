// Which ids of a range are still in use, and the rank of each among these.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reeb {

// At first all ids from 0 to before `size`; keep_if() leaves fewer.
//
// TIME: rank() reads one cache line.   MEMORY: bytes_for(size).
class KeptIds {
 public:
  explicit KeptIds(std::uint32_t size) : words_(size / kBits + 1), count_(size) {
    for (std::uint32_t word = 0; word < words_.size(); ++word) words_[word] = {~std::uint64_t{0}, word * kBits};
    words_.back().kept = low_bits(size % kBits);
  }

  static std::uint64_t bytes_for(std::uint64_t size) { return (size / kBits + 1) * sizeof(Word); }

  std::uint32_t count() const { return count_; }
  // REQUIRES, as rank(): `id` is below the size.
  bool has(std::uint32_t id) const { return (words_[id / kBits].kept >> id % kBits & 1) != 0; }
  // How many ids before `id` are kept.
  std::uint32_t rank(std::uint32_t id) const {
    const Word& word = words_[id / kBits];
    return word.before + static_cast<std::uint32_t>(std::popcount(word.kept & low_bits(id % kBits)));
  }

  // Calls stays(id) for each id that is kept, ascending. Those for which it returns false are no longer kept. During
  // such a call, rank(id) is still the rank from before.
  template <class Stays>
  void keep_if(const Stays& stays) {
    std::uint32_t before = 0;
    for (std::size_t k = 0; k < words_.size(); ++k) {
      std::uint64_t kept = 0;
      for (std::uint64_t rest = words_[k].kept; rest != 0; rest &= rest - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(rest));
        if (stays(static_cast<std::uint32_t>(k) * kBits + bit)) kept |= std::uint64_t{1} << bit;
      }
      words_[k] = {kept, before};
      before += static_cast<std::uint32_t>(std::popcount(kept));
    }
    count_ = before;
  }

 private:
  static constexpr std::uint32_t kBits = 64;
  struct Word {
    std::uint64_t kept = 0;    // by id
    std::uint32_t before = 0;  // kept ids in the words before
  };
  static std::uint64_t low_bits(std::uint32_t count) { return (std::uint64_t{1} << count) - 1; }

  std::vector<Word> words_;
  std::uint32_t count_;
};

}  // namespace reeb
