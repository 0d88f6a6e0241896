#include "io/smc/adaptive_model.h"

#include <algorithm>
#include <bit>

namespace reeb::io {

AdaptiveModel::AdaptiveModel(std::uint32_t symbols, const ModelKind& kind)
    : below_(symbols + 1),
      counts_(symbols),
      bits_(kind.bits),
      total_(kind.total),
      target_interval_(kind.target_interval),
      interval_((symbols >> 4) | 2) {
  const std::uint32_t share = total_ / symbols, rest = total_ % symbols;
  for (std::uint32_t i = 0; i < symbols; ++i) counts_[i] = static_cast<std::uint16_t>(share + (i < rest ? 1 : 0));
  // About one hint per symbol: find() then takes one or two steps on average.
  hint_shift_ = bits_ - static_cast<std::uint32_t>(std::bit_width(symbols - 1));
  hints_.resize((std::size_t{1} << (bits_ - hint_shift_)) + 1);
  rescale();
}

void AdaptiveModel::rescale() {
  if (more_ > 0) {  // the rest of the interval, with a larger increment: the total must be exact
    ++increment_;
    left_ = more_;
    more_ = 0;
    return;
  }
  if (interval_ != target_interval_) interval_ = std::min(2 * interval_, target_interval_);
  std::uint32_t sum = 0, halved = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    sum += counts_[i];
    below_[i + 1] = static_cast<std::uint16_t>(sum);
    counts_[i] = static_cast<std::uint16_t>((counts_[i] >> 1) | 1);
    halved += counts_[i];
  }
  const std::uint32_t missing = total_ - halved;
  increment_ = missing / interval_;
  more_ = missing % interval_;
  left_ = interval_ - more_;
  refresh_hints();
}

void AdaptiveModel::refresh_hints() {
  std::size_t hint = 0;
  for (std::uint32_t symbol = 0; symbol < size(); ++symbol)
    for (; hint < hints_.size() && (hint << hint_shift_) < below_[symbol + 1]; ++hint)
      hints_[hint] = static_cast<std::uint16_t>(symbol);
  std::fill(hints_.begin() + static_cast<std::ptrdiff_t>(hint), hints_.end(), static_cast<std::uint16_t>(size() - 1));
}

}  // namespace reeb::io
