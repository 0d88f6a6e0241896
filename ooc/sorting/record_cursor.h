// Reads an ExternalSort one record at a time.
#pragma once

#include <cstddef>
#include <vector>

namespace reeb::ooc {

// MEMORY: some thousand records.
template <class Record>
class RecordCursor {
 public:
  // Replaces `record` by the next one. False at the end. REQUIRES: `sort` is the same in each call, and nobody else
  // reads it.
  template <class Sort>
  bool next(Sort& sort, Record& record) {
    if (at_ == batch_.size()) {
      at_ = 0;
      if (!sort.read(batch_, kAtOnce)) return false;
    }
    record = batch_[at_++];
    return true;
  }
  // Rewinds the sort, too.
  template <class Sort>
  void rewind(Sort& sort) {
    sort.rewind();
    batch_.clear();
    at_ = 0;
  }

 private:
  static constexpr std::size_t kAtOnce = 4096;

  std::vector<Record> batch_;
  std::size_t at_ = 0;  // of the next record in batch_
};

}  // namespace reeb::ooc
