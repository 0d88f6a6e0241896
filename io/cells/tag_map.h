// The tags of nodes, which a file chooses freely, and their indices in the order of the file.
//
// MEMORY: 24 bytes for each run of consecutive tags, of which most files have few; twice that if runs do not ascend.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "libreeb/containers/growing_array.h"

namespace reeb::io {

class TagMap {
 public:
  // The tag of the next node.
  void add(std::uint64_t tag) {
    Run* const last = runs_.size() == 0 ? nullptr : &runs_[runs_.size() - 1];
    if (last != nullptr && tag == last->tag + last->count && tag != 0) {
      ++last->count;
    } else {
      ascending_ = ascending_ && (last == nullptr || tag > last->tag);
      runs_.append({tag, size_, 1});
    }
    ++size_;
    by_tag_.clear();
  }
  std::uint64_t size() const { return size_; }

  // Nothing for an unknown tag; of nodes with equal tags one.
  std::optional<std::uint64_t> find(std::uint64_t tag) {
    if (!ascending_ && by_tag_.size() == 0) {
      by_tag_ = runs_;
      std::ranges::sort(std::span(&by_tag_[0], by_tag_.size()), {}, &Run::tag);
    }
    const std::span<const Run> runs = sorted_runs();
    if (last_ >= runs.size() || tag - runs[last_].tag >= runs[last_].count) {
      const auto next = std::ranges::upper_bound(runs, tag, {}, &Run::tag);
      if (next == runs.begin()) return std::nullopt;
      last_ = static_cast<std::size_t>(next - runs.begin()) - 1;
    }
    const Run& run = runs[last_];
    if (tag < run.tag || tag - run.tag >= run.count) return std::nullopt;
    return run.index + (tag - run.tag);
  }

  // Whether a tag stands for two nodes.
  bool has_repetition() {
    if (size_ == 0) return false;
    (void)find(0);
    const std::span<const Run> runs = sorted_runs();
    return std::ranges::adjacent_find(runs, [](const Run& a, const Run& b) { return a.tag + a.count > b.tag; }) !=
           runs.end();
  }

  // The tags by index, one after the other.
  class Walk {
   public:
    std::uint64_t next(const TagMap& map) {
      if (place_ == map.runs_[run_].count) {
        ++run_;
        place_ = 0;
      }
      return map.runs_[run_].tag + place_++;
    }

   private:
    std::size_t run_ = 0;
    std::uint64_t place_ = 0;
  };

  // With what find() will take.
  std::uint64_t memory_bytes() const { return std::uint64_t{runs_.memory_bytes()} * (ascending_ ? 1 : 2); }

 private:
  struct Run {
    std::uint64_t tag = 0, index = 0, count = 0;
  };

  std::span<const Run> sorted_runs() const { return ascending_ ? runs_.all() : by_tag_.all(); }

  GrowingArray<Run> runs_;    // by index
  GrowingArray<Run> by_tag_;  // the same, if runs_ is not sorted by tag and was searched
  bool ascending_ = true;
  std::uint64_t size_ = 0;
  std::size_t last_ = 0;  // the run that was found last
};

}  // namespace reeb::io
