// Lists of notes on their way from the thread that writes them to the one that does what they say.
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "libreeb/graph/direction.h"
#include "libreeb/hierarchy/version_log.h"

namespace reeb {

// What was done to an arc: a function of ArcChanges and its arguments, or a part of a path.
struct ArcNote {
  static constexpr NodeId kNoNode = NodeId::none();
  enum class Kind : std::uint8_t { kTouch, kCut, kMerge, kJoin, kLay, kDrop, kPath, kPass, kCommit };

  Kind kind = Kind::kCommit;
  Direction direction = kUp;
  ArcId arc = ArcId::none(), other = ArcId::none();
  std::array<NodeId, 3> nodes{kNoNode, kNoNode, kNoNode};
  ArcEnds ends{};
  std::uint32_t count = 0;
};

// The writer waits when all lists are full, and the reader when all are empty. Whoever waits is woken when half of the
// lists are of use, so that it does not wait again at once.
//
// MEMORY: kLists lists.   THREADS: a writer and a reader, which run at the same time.
class NoteQueue {
 public:
  static constexpr std::size_t kLists = 4;
  struct List {
    alignas(64) std::vector<ArcNote> notes;  // two threads change neighbouring lists
    double done = 0;                         // the part of the work that is done when these notes are
  };

  // Each list has room for this many notes.
  void reserve(std::size_t notes) {
    for (List& list : lists_) list.notes.reserve(notes);
  }

  // The writer fills this list.
  std::vector<ArcNote>& open() { return lists_[open_].notes; }
  const std::vector<ArcNote>& open() const { return lists_[open_].notes; }
  // Passes it on, and opens the next one. False if the reader has stopped.
  bool pass_on(double done) {
    std::unique_lock lock(mutex_);
    lists_[open_].done = done;
    open_ = (open_ + 1) % kLists;
    ++full_;
    if (reader_waits_ && full_ >= kLists / 2) changed_.notify_all();
    return full_ < kLists || wait_for_reader(lock, kLists / 2);
  }
  // Waits until all lists are done but the last `most` of those that were passed on. False if the reader has stopped.
  bool wait_until_done(std::size_t most) {
    std::unique_lock lock(mutex_);
    return full_ <= most || wait_for_reader(lock, most);
  }
  // Nothing more is passed on.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }

  // The next list for the reader, which has it until free(). Null if there is none and the queue is closed.
  const List* next() {
    std::unique_lock lock(mutex_);
    if (full_ == 0) {
      reader_waits_ = true;
      changed_.wait(lock, [this] { return full_ >= kLists / 2 || (writer_waits_ && full_ != 0) || is_closed_; });
      reader_waits_ = false;
    }
    return full_ == 0 ? nullptr : &first();
  }
  // What the list says is done.
  void free() {
    const std::lock_guard lock(mutex_);
    first().notes.clear();
    --full_;
    if (writer_waits_ && full_ <= awaited_) changed_.notify_all();
  }
  // The reader reads no more.
  void stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }

 private:
  List& first() { return lists_[(open_ + kLists - full_) % kLists]; }
  bool wait_for_reader(std::unique_lock<std::mutex>& lock, std::size_t most) {
    awaited_ = most;
    writer_waits_ = true;
    if (reader_waits_) changed_.notify_all();
    changed_.wait(lock, [this] { return full_ <= awaited_ || is_stopped_; });
    writer_waits_ = false;
    return !is_stopped_;
  }

  std::array<List, kLists> lists_;  // a ring; the full ones are before the open one
  std::size_t open_ = 0;
  std::size_t full_ = 0;     // that were passed on and are not free yet
  std::size_t awaited_ = 0;  // what the writer waits for: no more full lists than this
  bool reader_waits_ = false, writer_waits_ = false, is_closed_ = false, is_stopped_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace reeb
