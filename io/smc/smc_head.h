// The head of an SMC stream, all of it inside the range coder.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "io/events/stream_event.h"
#include "io/events/stream_fault.h"
#include "io/smc/range_coder.h"

namespace reeb::io {

struct SmcHead {
  std::uint32_t precision = 0;  // bits per coordinate, 0 is lossless
  std::optional<std::uint32_t> vertex_count, cell_count;
  // A file can have one corner of the box only, which is then ignored.
  std::optional<std::array<float, 3>> min, max;

  std::optional<StreamBox> box() const { return min && max ? std::optional(StreamBox{*min, *max}) : std::nullopt; }
};

namespace smc_head_detail {

template <class Coder>
void code_count(Coder& coder, std::optional<std::uint32_t>& count) {
  const std::uint32_t present = coder.uniform(2, count ? 1 : 0);
  if (present == 0) return;
  const std::uint32_t value = coder.word(count.value_or(0));
  count = value > 0x7FFFFFFF ? std::nullopt : std::optional(value);
}

template <class Coder>
void code_corner(Coder& coder, std::optional<std::array<float, 3>>& corner) {
  if (coder.uniform(2, corner ? 1 : 0) == 0) return;
  if (!corner) corner.emplace();
  for (float& x : *corner) x = std::bit_cast<float>(coder.word(std::bit_cast<std::uint32_t>(x)));
}

template <class Coder>
void code_zero(Coder& coder, const char* what) {
  if (coder.uniform(2, 0) != 0) fail(Fault::kUnsupported, std::string(what) + " in the header is not defined", {});
}

}  // namespace smc_head_detail

// Codes the head; a decoder fills it. THROWS: BAD_HEADER, UNSUPPORTED, TRUNCATED.
template <class Coder>
void code_smc_head(Coder& coder, SmcHead& head) {
  using namespace smc_head_detail;
  head.precision = coder.uniform(25, head.precision);
  code_count(coder, head.vertex_count);
  code_count(coder, head.cell_count);
  code_corner(coder, head.min);
  code_corner(coder, head.max);
  code_zero(coder, "a comment");
  const auto box = head.box();
  if (head.precision > 0 && box) code_zero(coder, "this kind of quantization");
  if (!box) return;
  bool sound = true, flat = true;
  for (std::size_t k = 0; k < 3; ++k) {
    sound = sound && std::isfinite(box->min[k]) && std::isfinite(box->max[k]) && box->min[k] <= box->max[k];
    flat = flat && box->min[k] == box->max[k];
  }
  if (!sound || (head.precision > 0 && flat))
    fail(Fault::kBadHeader, "the bounding box is inverted, empty or not finite", {});
}

}  // namespace reeb::io
