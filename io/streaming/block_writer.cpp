// SMB and SVB.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/events/format_limits.h"
#include "io/events/held_cell_writer.h"
#include "io/streaming/block_head.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

class BlockWriter : public HeldCellWriter {
 public:
  // The format does not store the order of finalizations in a cell.
  BlockWriter(std::ostream& out, const StreamHeader& header)
      : HeldCellWriter(out, header, false), words_(header.volume ? 4 : 3) {
    if (header.volume &&
        (header.vertex_floats + header.vertex_ints > 4 || header.cell_floats > 0 || header.cell_ints > 0))
      fail_format("SVB holds one value per vertex and none per cell", "write SVA instead");
    write_head();
  }

  // A last block is written even if it has no elements: old readers expect it.
  void close() override {
    write_held();
    write_block();
    out_.flush();
    patch_counts();
    out_.flush();
  }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all;
    if (dropped_ != 0)
      all.push_back("left out: " + count_of(dropped_, "finalization") + " apart from the last cell of the vertex");
    if (header_.comments.size() > kMaxComments)
      all.push_back("left out: " + count_of(header_.comments.size() - kMaxComments, "comment") + " of the head");
    return all;
  }

 private:
  void write_head() {
    out_.text().append({header_.volume ? '\4' : '\0', '\0', '\0', '\0'});
    const auto comments = std::span(header_.comments).first(std::min(header_.comments.size(), kMaxComments));
    out_.append_word(static_cast<std::uint32_t>(comments.size()));
    for (const std::string& comment : comments) {
      out_.append_word(static_cast<std::uint32_t>(comment.size()));
      out_.text() += comment;
    }
    out_.flush();
    counts_at_ = out_.stream().tellp();
    out_.append_word(header_.vertex_count.value_or(~0u));
    out_.append_word(header_.cell_count.value_or(~0u));
    if (header_.volume) {
      out_.append_word(header_.vertex_floats);
      out_.append_word(header_.vertex_ints);
    }
    // One flag is for the bounds of all floats, and those of a fourth float are unknown.
    const bool box = header_.box && header_.vertex_floats == 3;
    out_.text() += box ? '\1' : '\0';
    if (box) {
      for (const float x : header_.box->min) out_.append_float(x);
      for (const float x : header_.box->max) out_.append_float(x);
    }
    if (header_.volume && header_.vertex_ints > 0) out_.text() += '\0';
  }

  void patch_counts() {
    const bool are_right = header_.vertex_count == vertices() && header_.cell_count == cells();
    if (are_right || counts_at_ == std::streampos(-1)) return;
    std::ostream& stream = out_.stream();
    const std::streampos end = stream.tellp();
    stream.seekp(counts_at_);
    out_.append_word(vertices());
    out_.append_word(cells());
    out_.flush();
    stream.seekp(end);
  }

  void write_vertex(const StreamEvent& vertex) override {
    std::array<std::uint32_t, 4> words{};
    std::size_t used = 0;
    for (unsigned i = 0; i < header_.vertex_floats; ++i) words[used++] = std::bit_cast<std::uint32_t>(vertex.floats[i]);
    for (unsigned i = 0; i < header_.vertex_ints; ++i) words[used++] = static_cast<std::uint32_t>(vertex.ints[i]);
    write_element(words, true);
  }

  void write_cell(const StreamEvent& /*cell*/, std::span<const std::int32_t> corners) override {
    std::array<std::uint32_t, 4> words{};
    for (std::size_t k = 0; k < corners.size(); ++k) words[k] = static_cast<std::uint32_t>(corners[k]);
    write_element(words, false);
  }

  void write_finalized(std::uint32_t /*vertex*/) override { ++dropped_; }

  void write_element(const std::array<std::uint32_t, 4>& words, bool vertex) {
    for (std::size_t k = 0; k < words_; ++k) block_[elements_ * words_ + k] = words[k];
    descriptor_ |= static_cast<std::uint32_t>(vertex) << elements_;
    if (++elements_ == kBlockElements) write_block();
  }

  void write_block() {
    out_.append_word(descriptor_);
    for (std::size_t i = 0; i < elements_ * words_; ++i) out_.append_word(block_[i]);
    descriptor_ = 0;
    elements_ = 0;
    out_.flush_if_full();
  }

  std::size_t words_;  // 32-bit words of an element, and corners of a cell
  std::streampos counts_at_;
  std::array<std::uint32_t, 4 * kBlockElements> block_{};
  std::uint32_t descriptor_ = 0;
  std::size_t elements_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace

std::unique_ptr<StreamWriter> make_block_writer(std::ostream& out, const StreamHeader& header) {
  return std::make_unique<BlockWriter>(out, header);
}

}  // namespace reeb::io
