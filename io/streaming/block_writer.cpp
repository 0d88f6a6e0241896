// SMB and SVB.
#include "io/streaming/block_head.h"
#include "io/streaming/cell_hold.h"
#include "io/streaming/stream_output.h"
#include "io/streaming/stream_writer.h"

namespace reeb::io {
namespace {

class BlockWriter : public StreamWriter {
 public:
  BlockWriter(std::ostream& out, const StreamHeader& header)
      : out_(out), header_(header), words_(header.volume ? 4 : 3) {
    if (header.volume && (header.vertex_floats + header.vertex_ints > 4 || header.cell_floats > 0 ||
                          header.cell_ints > 0))
      fail_format("SVB holds one value a vertex and none a cell", "write SVA instead");
    write_head();
  }

  void write(const StreamEvent& event) override {
    switch (event.kind) {
      case EventKind::kVertex:
        return write_vertex(event);
      case EventKind::kTriangle:
      case EventKind::kTetrahedron:
        return write_cell(event);
      case EventKind::kFinalized:
        if (!post_order_ && !held_.finalize(event.vertex, false)) ++dropped_;
        return;
    }
  }

  // A last block without elements is written too: old readers expect it.
  void close() override {
    write_held();
    write_block();
    out_.flush();
    patch_counts();
    out_.finish();
  }

  std::vector<std::string> warnings() const override {
    if (dropped_ == 0) return {};
    return {std::to_string(dropped_) +
            " finalizations apart from the last cell of their vertex were left out"};
  }

 private:
  void write_head() {
    out_.text().append({header_.volume ? '\4' : '\0', '\0', '\0', '\0'});
    out_.append_word(static_cast<std::uint32_t>(header_.comments.size()));
    for (const std::string& comment : header_.comments) {
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
    // The bounds of further values are not known, and all stand or fall together.
    const bool box = header_.box && header_.vertex_floats == 3;
    out_.text() += box ? '\1' : '\0';
    if (box) {
      for (const float x : header_.box->min) out_.append_float(x);
      for (const float x : header_.box->max) out_.append_float(x);
    }
    if (header_.volume && header_.vertex_ints > 0) out_.text() += '\0';
  }

  void patch_counts() {
    if ((header_.vertex_count && header_.cell_count) || counts_at_ == std::streampos(-1)) return;
    std::ostream& stream = out_.stream();
    const std::streampos end = stream.tellp();
    stream.seekp(counts_at_);
    out_.append_word(header_.vertex_count.value_or(vertices_));
    out_.append_word(header_.cell_count.value_or(cells_));
    out_.flush();
    stream.seekp(end);
  }

  void write_vertex(const StreamEvent& event) {
    write_held();
    started_ = true;
    std::array<std::uint32_t, 4> words{};
    std::size_t used = 0;
    for (unsigned i = 0; i < header_.vertex_floats; ++i)
      words[used++] = std::bit_cast<std::uint32_t>(event.floats[i]);
    for (unsigned i = 0; i < header_.vertex_ints; ++i)
      words[used++] = static_cast<std::uint32_t>(event.ints[i]);
    write_element(words, true);
    ++vertices_;
  }

  void write_cell(const StreamEvent& event) {
    require_cell_kind(event.kind, header_.volume);
    write_held();
    if (!started_) post_order_ = true;
    started_ = true;
    held_.put(event);
  }

  void write_held() {
    if (!held_.full()) return;
    std::array<std::uint32_t, 4> words{};
    for (std::size_t k = 0; k < words_; ++k)
      words[k] =
          held_.is_final(k) ? held_.cell().corners[k] - vertices_ : held_.cell().corners[k] + 1;
    write_element(words, false);
    ++cells_;
    held_.clear();
  }

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

  StreamOutput out_;
  StreamHeader header_;
  std::size_t words_;  // 32-bit words of an element, and corners of a cell
  CellHold held_;
  std::streampos counts_at_;
  std::array<std::uint32_t, 4 * kBlockElements> block_{};
  std::uint32_t descriptor_ = 0;
  std::size_t elements_ = 0;
  std::uint32_t vertices_ = 0, cells_ = 0;
  std::uint64_t dropped_ = 0;
  bool started_ = false, post_order_ = false;
};

}  // namespace

std::unique_ptr<StreamWriter> make_block_writer(std::ostream& out, const StreamHeader& header) {
  return std::make_unique<BlockWriter>(out, header);
}

}  // namespace reeb::io
