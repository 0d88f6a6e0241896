// Which vertex a number in a file refers to, and whether the stream may name that vertex now.
//
// Numbers in SMA, SMB, SVA and SVB: n > 0 is vertex n - 1. n < 0 counts back from the newest vertex (-1), and the
// vertex is final after this cell. 0 is never legal. In post-order a cell names only vertices that have not arrived,
// with n > 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace reeb::io {

inline constexpr std::uint32_t kMaxVertices = 0x7FFFFFFF;

// The set of final vertices, one bit each. A page is released when all its vertices are final.
// MEMORY: follows the active vertices, plus 4 bytes per 4096 vertices.
class FinalSet {
 public:
  void add_vertex() {
    if ((size_ & (kPageVertices - 1)) == 0) open_page();
    ++size_;
  }
  std::uint32_t size() const { return size_; }
  std::uint64_t memory_bytes() const {
    return words_.capacity() * sizeof(std::uint64_t) +
           (pages_.capacity() + counts_.capacity() + free_.capacity()) * sizeof(std::uint32_t);
  }
  // REQUIRES: vertex < size().
  bool contains(std::uint32_t vertex) const {
    const std::uint32_t page = pages_[vertex / kPageVertices];
    return page == kAllFinal || ((words_[word(page, vertex)] >> (vertex & 63)) & 1) != 0;
  }
  // REQUIRES: vertex < size(), not in the set.
  void insert(std::uint32_t vertex) {
    const std::uint32_t page = pages_[vertex / kPageVertices];
    words_[word(page, vertex)] |= std::uint64_t{1} << (vertex & 63);
    if (++counts_[page] == kPageVertices) close_page(vertex / kPageVertices);
  }

 private:
  static constexpr std::uint32_t kPageVertices = 4096, kPageWords = kPageVertices / 64;
  static constexpr std::uint32_t kAllFinal = ~0u;

  static std::size_t word(std::uint32_t page, std::uint32_t vertex) {
    return std::size_t{page} * kPageWords + vertex % kPageVertices / 64;
  }
  void open_page();
  void close_page(std::uint32_t number);

  std::uint32_t size_ = 0;
  std::vector<std::uint32_t> pages_;   // one for every 4096 vertices; or kAllFinal
  std::vector<std::uint64_t> words_;   // pool of pages
  std::vector<std::uint32_t> counts_;  // vertices in the set, by page
  std::vector<std::uint32_t> free_;
};

// What is wrong with a number, if anything.
enum class IndexVerdict : std::uint8_t { kValid, kZero, kNotArrived, kBeforeFirst, kFinal };

class IndexRules {
 public:
  void set_post_order(bool post_order) { post_order_ = post_order; }
  bool post_order() const { return post_order_; }
  std::uint32_t vertex_count() const { return final_.size(); }
  std::uint64_t memory_bytes() const { return final_.memory_bytes(); }

  // A vertex arrives; in post-order it is final at once. REQUIRES: vertex_count() < kMaxVertices.
  void add_vertex() {
    final_.add_vertex();
    if (post_order_) final_.insert(vertex_count() - 1);
  }

  // Sets `vertex` to the one that a corner `number` of a cell refers to.
  IndexVerdict corner(std::int32_t number, std::uint32_t& vertex) {
    return post_order_ ? corner_post(number, vertex) : resolve(number, vertex);
  }
  // The same for an explicit finalization.
  IndexVerdict finalization(std::int32_t number, std::uint32_t& vertex) const {
    const IndexVerdict verdict = resolve(number, vertex);
    return post_order_ && verdict == IndexVerdict::kValid ? IndexVerdict::kFinal : verdict;
  }
  // REQUIRES: pre-order, and the verdict on the vertex was kValid.
  void finalize(std::uint32_t vertex) { final_.insert(vertex); }
  bool is_final(std::uint32_t vertex) const { return final_.contains(vertex); }

  // At the end. THROWS: MISSING_VERTEX.
  void require_all_arrived(const char* cells, const std::string& position) const;
  // THROWS: the error for this verdict; `who` is "corner 2" or "finalization".
  [[noreturn]] void fail_index(IndexVerdict verdict, std::int32_t number, const std::string& who,
                               const std::string& position) const;

 private:
  IndexVerdict resolve(std::int32_t number, std::uint32_t& vertex) const {
    if (number == 0) return IndexVerdict::kZero;
    const std::int64_t index = number > 0 ? std::int64_t{number} - 1 : vertex_count() + std::int64_t{number};
    if (index < 0) return IndexVerdict::kBeforeFirst;
    if (index >= vertex_count()) return IndexVerdict::kNotArrived;
    vertex = static_cast<std::uint32_t>(index);
    return final_.contains(vertex) ? IndexVerdict::kFinal : IndexVerdict::kValid;
  }
  IndexVerdict corner_post(std::int32_t number, std::uint32_t& vertex);

  bool post_order_ = false;
  FinalSet final_;
  std::uint32_t named_ = 0;  // one more than the largest vertex named by a cell, in post-order
};

}  // namespace reeb::io
