// Adaptive frequencies of the symbols 0 .. n-1, for the coder of SMC files.
//
// The current frequencies stay fixed over an interval, while counts are collected. At its end the counts replace the
// frequencies and are halved. The interval doubles up to a target. All of this is part of the file format: encoder and
// decoder must agree to the bit.
#pragma once

#include <cstdint>
#include <vector>

namespace reeb::io {

// There are two kinds of models. The total of the large one is its power of two minus one.
struct ModelKind {
  std::uint32_t bits, total, target_interval;
};
inline constexpr ModelKind kSmallModel{14, 16384, 2000};
inline constexpr ModelKind kLargeModel{16, 65535, 20000};

class AdaptiveModel {
 public:
  AdaptiveModel() = default;
  // REQUIRES: 2 <= symbols <= kind.total / 2.
  AdaptiveModel(std::uint32_t symbols, const ModelKind& kind);

  bool exists() const { return !counts_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(counts_.size()); }
  std::uint32_t bits() const { return bits_; }
  // Sum of the current frequencies of all symbols less than `symbol`.
  std::uint32_t below(std::uint32_t symbol) const { return below_[symbol]; }

  // The symbol with below(symbol) <= place < below(symbol + 1), or the last symbol if `place` is beyond the total.
  std::uint32_t find(std::uint32_t place) const {
    const std::uint32_t guess = hints_[place >> hint_shift_];
    std::uint32_t low = guess, high = hints_[(place >> hint_shift_) + 1] + 1;
    if (high > size()) high = size();
    while (high - low > 1) {
      const std::uint32_t middle = (low + high) / 2;
      (below_[middle] <= place ? low : high) = middle;
    }
    return low;
  }

  void update(std::uint32_t symbol) {
    if (left_ == 0) rescale();
    --left_;
    counts_[symbol] = static_cast<std::uint16_t>(counts_[symbol] + increment_);
  }

 private:
  void rescale();
  void refresh_hints();

  std::vector<std::uint16_t> below_;   // size() + 1 entries
  std::vector<std::uint16_t> counts_;  // of the current interval
  std::vector<std::uint16_t> hints_;   // hints_[p]: find(p << hint_shift_)
  std::uint32_t bits_ = 0, total_ = 0, target_interval_ = 0, hint_shift_ = 0;
  std::uint32_t interval_ = 0, left_ = 0, more_ = 0, increment_ = 0;
};

}  // namespace reeb::io
