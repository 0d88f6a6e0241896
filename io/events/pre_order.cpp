#include "io/events/pre_order.h"

#include <algorithm>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/containers/flat_map.h"

namespace reeb::io {
namespace {

constexpr std::uint32_t kNoCell = ~0u;
constexpr std::uint32_t kMostCells = kNoCell / 4;  // so that 4 * cell + corner is less than kNoCell
constexpr std::size_t kEventsBetweenPauses = 65536;

class PreOrderReader : public EventReader {
 public:
  explicit PreOrderReader(std::unique_ptr<EventReader> reader)
      : reader_(std::move(reader)), corners_(reader_->header().volume ? 4 : 3) {
    header_ = reader_->header();
    header_.post_order = false;
    set_name(reader_->name());
  }

  std::vector<std::string> warnings() const override { return reader_->warnings(); }
  std::uint64_t bytes_read() const override { return reader_->bytes_read(); }
  std::uint64_t memory_bytes() const override {
    return EventReader::memory_bytes() + reader_->memory_bytes() + index_of_.memory_bytes() +
           named_.capacity() * sizeof(Named) + cells_.capacity() * sizeof(WaitingCell) +
           (free_named_.capacity() + free_cells_.capacity() + complete_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  // A vertex that a waiting cell names.
  struct Named {
    std::uint32_t first = kNoCell;  // the last corner that named it, as 4 * cell + corner
    std::uint32_t cells = 0;        // corners of waiting cells
  };
  struct WaitingCell {
    StreamEvent event;
    std::array<std::uint32_t, 4> next;  // by corner: the corner before it in the vertex's list
    std::uint32_t missing;              // corners whose vertex has not arrived
  };

  void fill() override {
    for (std::size_t n = 0; queued() == 0; ++n) {
      if (n == kEventsBetweenPauses) return pause();
      const StreamEvent* event = reader_->next();
      if (event == nullptr) return;
      if (event->kind == EventKind::kVertex) arrive(*event);
      // Finalizations are not read: in a post-order stream they follow from the vertices.
      else if (event->kind != EventKind::kFinalized)
        wait(*event);
    }
  }

  void wait(const StreamEvent& event) {
    std::uint32_t cell = static_cast<std::uint32_t>(cells_.size());
    if (free_cells_.empty()) {
      if (cell == kMostCells)
        throw Error(ErrorKind::kResource,
                    "more than " + count_of(kMostCells, "cell") + " wait for a vertex, which is the limit",
                    "write vertices before the cells that use them");
      cells_.emplace_back();
    } else {
      cell = free_cells_.back();
      free_cells_.pop_back();
    }
    WaitingCell& waiting = cells_[cell];
    waiting.event = event;
    waiting.missing = corners_;
    for (std::uint32_t k = 0; k < corners_; ++k) {
      Named& named = named_of(event.corners[k]);
      waiting.next[k] = named.first;
      named.first = 4 * cell + k;
      ++named.cells;
    }
  }

  Named& named_of(std::uint32_t vertex) {
    const auto next = free_named_.empty() ? static_cast<std::uint32_t>(named_.size()) : free_named_.back();
    const std::uint32_t index = index_of_.find_or_insert(vertex, next);
    if (index == named_.size()) {
      named_.emplace_back();
    } else if (!free_named_.empty() && index == free_named_.back()) {
      free_named_.pop_back();
      named_[index] = {};
    }
    return named_[index];
  }

  void arrive(const StreamEvent& vertex) {
    push(EventKind::kVertex) = vertex;
    const std::uint32_t index = index_of_.find(vertex.vertex);
    if (index == FlatMap::kNone) return push_finalized(vertex.vertex);
    for (std::uint32_t at = named_[index].first; at != kNoCell;) {
      WaitingCell& cell = cells_[at / 4];
      if (--cell.missing == 0) complete_.push_back(at / 4);
      at = cell.next[at % 4];
    }
    std::reverse(complete_.begin(), complete_.end());  // the lists run backwards
    for (const std::uint32_t cell : complete_) deliver(cell);
    complete_.clear();
  }

  void deliver(std::uint32_t cell) {
    const StreamEvent& event = cells_[cell].event;
    push(event.kind) = event;
    for (std::uint32_t k = 0; k < corners_; ++k) {
      const std::uint32_t vertex = event.corners[k];
      const std::uint32_t index = index_of_.find(vertex);
      if (--named_[index].cells != 0) continue;
      index_of_.erase(vertex);
      free_named_.push_back(index);
      push_finalized(vertex);
    }
    free_cells_.push_back(cell);
  }

  std::unique_ptr<EventReader> reader_;
  std::uint32_t corners_;
  FlatMap index_of_;  // of vertices that waiting cells name, in named_
  std::vector<Named> named_;
  std::vector<std::uint32_t> free_named_;
  std::vector<WaitingCell> cells_;
  std::vector<std::uint32_t> free_cells_;
  std::vector<std::uint32_t> complete_;  // scratch: cells that a vertex completes
};

}  // namespace

std::unique_ptr<EventReader> in_pre_order(std::unique_ptr<EventReader> reader) {
  if (!reader->header().post_order) return reader;
  return std::make_unique<PreOrderReader>(std::move(reader));
}

}  // namespace reeb::io
