#include "io/events/index_rules.h"

#include <algorithm>

#include "io/events/stream_fault.h"

namespace reeb::io {

void FinalSet::open_page() {
  std::uint32_t page = 0;
  if (free_.empty()) {
    page = static_cast<std::uint32_t>(counts_.size());
    words_.resize(words_.size() + kPageWords);
    counts_.push_back(0);
  } else {
    page = free_.back();
    free_.pop_back();
    std::fill_n(words_.begin() + static_cast<std::ptrdiff_t>(std::size_t{page} * kPageWords), kPageWords, 0);
    counts_[page] = 0;
  }
  pages_.push_back(page);
}

void FinalSet::close_page(std::uint32_t number) {
  free_.push_back(pages_[number]);
  pages_[number] = kAllFinal;
}

IndexVerdict IndexRules::corner_post(std::int32_t number, std::uint32_t& vertex) {
  if (number == 0) return IndexVerdict::kZero;
  if (number < 0) return vertex_count() + std::int64_t{number} < 0 ? IndexVerdict::kBeforeFirst : IndexVerdict::kFinal;
  vertex = static_cast<std::uint32_t>(number - 1);
  if (vertex < vertex_count()) return IndexVerdict::kFinal;
  named_ = std::max(named_, vertex + 1);
  return IndexVerdict::kValid;
}

void IndexRules::require_all_arrived(const char* cells, const std::string& position) const {
  if (named_ <= vertex_count()) return;
  fail(Fault::kMissingVertex,
       std::string(cells) + " name vertex " + std::to_string(named_ - 1) + ", only " + std::to_string(vertex_count()) +
           " vertices arrived",
       position);
}

void IndexRules::fail_index(IndexVerdict verdict, std::int32_t number, const std::string& who,
                            const std::string& position) const {
  const std::string arrived = std::to_string(vertex_count()) + " have arrived";
  switch (verdict) {
    case IndexVerdict::kZero:
      fail(Fault::kBadIndex, who + " is 0; vertices are numbered from 1", position);
    case IndexVerdict::kBeforeFirst:
      fail(Fault::kBadIndex, who + " (" + std::to_string(number) + ") is before the first vertex, " + arrived,
           position);
    case IndexVerdict::kNotArrived:
      fail(Fault::kBadIndex, who + " names vertex " + std::to_string(std::int64_t{number} - 1) + ", only " + arrived,
           position);
    default:
      break;
  }
  const std::int64_t vertex = number > 0 ? std::int64_t{number} - 1 : vertex_count() + std::int64_t{number};
  fail(Fault::kFinalIndex, who + ": vertex " + std::to_string(vertex) + " is used after it was finalized", position);
}

}  // namespace reeb::io
