#include "io/streaming/block_reader.h"

#include <algorithm>
#include <cmath>

#include "io/events/stream_fault.h"
#include "io/mesh/scalar_bytes.h"
#include "io/streaming/block_head.h"

namespace reeb::io {

template <std::size_t kWords>
BlockEventReader<kWords>::BlockEventReader(Cursor cursor) : cursor_(std::move(cursor)) {
  BlockHead head = read_block_head(cursor_, kWords == 4);
  header_ = std::move(head.header);
  swap_ = head.swap;
  rules_.set_post_order(header_.post_order);
  if (head.overruled) warn("ORDER: the byte order mark contradicts the data; they are read as " + header_.format);
}

template <std::size_t kWords>
void BlockEventReader<kWords>::fill() {
  if (done_) return;
  if (!cursor_.ensure(4 + kBlockElements * kElementBytes)) {
    if (cursor_.available() == 0) return finish();
    if (cursor_.available() < 4)
      fail(Fault::kTruncated, "ends inside a block descriptor", std::to_string(cursor_.offset()));
  }
  const std::uint32_t descriptor = load_scalar<std::uint32_t>(cursor_.data(), swap_);
  const std::size_t rest = cursor_.available() - 4;
  const std::size_t count = std::min(kBlockElements, rest / kElementBytes);
  const char* elements = cursor_.data() + 4;
  const std::uint64_t position = cursor_.offset() + 4;
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t at = j * kElementBytes;
    ((descriptor >> j) & 1) != 0 ? read_vertex(elements + at, position + at) : read_cell(elements + at, position + at);
  }
  cursor_.advance(4 + count * kElementBytes);
  if (count == kBlockElements) return;
  if (rest % kElementBytes != 0)
    fail(Fault::kTruncated, "ends inside element " + std::to_string(count) + " of a block",
         std::to_string(cursor_.offset()));
  finish();
}

template <std::size_t kWords>
void BlockEventReader<kWords>::read_vertex(const char* element, std::uint64_t position) {
  const std::array<float, 3> xyz = {load_scalar<float>(element, swap_), load_scalar<float>(element + 4, swap_),
                                    load_scalar<float>(element + 8, swap_)};
  // SVB only: a fourth float, or an integer, or nothing.
  const char* more = element + kElementBytes - 4;
  const float fourth = header_.vertex_floats == 4 ? load_scalar<float>(more, swap_) : 0;
  if (!std::isfinite(xyz[0]) || !std::isfinite(xyz[1]) || !std::isfinite(xyz[2]) || !std::isfinite(fourth))
    fail(Fault::kBadNumber, "a value of vertex " + std::to_string(rules_.vertex_count()) + " is not finite",
         std::to_string(position));
  if (rules_.vertex_count() == kMaxVertices)
    fail(Fault::kBadIndex, "more than 2147483647 vertices", std::to_string(position));

  const std::uint32_t vertex = rules_.vertex_count();
  StreamEvent& event = push(EventKind::kVertex);
  event.vertex = vertex;
  std::copy(xyz.begin(), xyz.end(), event.floats.begin());
  if constexpr (kWords == 4) {
    event.floats[3] = fourth;
    event.ints[0] = load_scalar<std::int32_t>(more, swap_);
  }
  rules_.add_vertex();
  if (rules_.post_order()) push_finalized(vertex);
}

template <std::size_t kWords>
void BlockEventReader<kWords>::read_cell(const char* element, std::uint64_t position) {
  std::array<std::int32_t, kWords> numbers;
  std::array<std::uint32_t, kWords> vertices{};
  for (std::size_t k = 0; k < kWords; ++k) {
    numbers[k] = load_scalar<std::int32_t>(element + 4 * k, swap_);
    IndexVerdict verdict = rules_.corner(numbers[k], vertices[k]);
    for (std::size_t i = 0; i < k; ++i)
      if (numbers[k] < 0 && numbers[i] == numbers[k]) verdict = IndexVerdict::kFinal;
    if (verdict != IndexVerdict::kValid) [[unlikely]]
      rules_.fail_index(verdict, numbers[k], "corner " + std::to_string(k + 1), std::to_string(position));
  }
  ++cells_;
  StreamEvent& event = push(kWords == 4 ? EventKind::kTetrahedron : EventKind::kTriangle);
  for (std::size_t k = 0; k < kWords; ++k) event.corners[k] = vertices[k];
  for (std::size_t k = 0; k < kWords; ++k) {
    if (numbers[k] >= 0) continue;
    rules_.finalize(vertices[k]);
    push_finalized(vertices[k]);
  }
}

template <std::size_t kWords>
void BlockEventReader<kWords>::finish() {
  done_ = true;
  const char* cell_name = kWords == 4 ? "tetrahedra" : "triangles";
  const std::string end = std::to_string(cursor_.offset());
  rules_.require_all_arrived(cell_name, end);
  const Tally vertices{header_.vertex_count, rules_.vertex_count()};
  const Tally cells{header_.cell_count, cells_};
  require_promised(vertices, "vertices", end);
  require_promised(cells, cell_name, end);
  for (auto text : {count_warning(vertices, "vertices", false), count_warning(cells, cell_name, false)})
    if (!text.empty()) warn(std::move(text));
}

template class BlockEventReader<3>;
template class BlockEventReader<4>;

}  // namespace reeb::io
