#include "io/smc/range_coder.h"

#include "io/events/stream_fault.h"

namespace reeb::io {
namespace {

constexpr std::size_t kFlushBytes = 1u << 16;

}  // namespace

RangeDecoder::RangeDecoder(Cursor& cursor) : cursor_(cursor), start_(cursor.offset()) {
  if (next_byte() != 1) fail(Fault::kBadHeader, "the code stream does not start with 1", std::to_string(start_));
  last_ = next_byte();
  low_ = last_ >> 1;
}

void RangeDecoder::refill() {
  // finish() checks the length against the last three bytes, which can be in two views.
  for (std::size_t i = used_ > 3 ? used_ - 3 : 0; i < used_; ++i)
    tail_ = (tail_ << 8) | static_cast<unsigned char>(bytes_[i]);
  cursor_.advance(used_);
  used_ = ready_ = 0;
  if (!cursor_.ensure(1)) fail(Fault::kTruncated, "file ends inside the code stream", std::to_string(position()));
  bytes_ = cursor_.data();
  ready_ = cursor_.available();
}

void RangeDecoder::finish() {
  normalize();
  std::uint32_t stored = tail_;
  for (std::size_t i = used_ > 3 ? used_ - 3 : 0; i < used_; ++i)
    stored = (stored << 8) | static_cast<unsigned char>(bytes_[i]);
  cursor_.advance(used_);
  ready_ -= used_;
  used_ = 0;
  bytes_ = cursor_.data();
  const std::uint64_t length = position() - start_;
  if ((stored & 0xFFFFFF) != (length & 0xFFFFFF))
    fail(Fault::kCorrupt,
         "the code stream has " + std::to_string(length) + " bytes, but says " + std::to_string(stored & 0xFFFFFF),
         std::to_string(position()));
}

void RangeDecoder::fail_damaged() const {
  fail(Fault::kCorrupt, "a symbol that cannot be decoded", std::to_string(position()));
}

void RangeEncoder::put(std::uint32_t byte) {
  buffer_.push_back(static_cast<char>(byte & 0xFF));
  if (buffer_.size() >= kFlushBytes) flush();
}

void RangeEncoder::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

void RangeEncoder::put_held(bool carry) {
  put(held_ + (carry ? 1 : 0));
  for (; pending_ > 0; --pending_) put(carry ? 0x00 : 0xFF);
}

void RangeEncoder::normalize() {
  while (range_ <= kBottom) {
    if (low_ < 0x7F800000 || low_ >= kTop) {
      put_held(low_ >= kTop);
      held_ = (low_ >> 23) & 0xFF;
    } else {
      ++pending_;
    }
    range_ <<= 8;
    low_ = (low_ << 8) & 0x7FFFFFFF;
    ++shifts_;
  }
}

std::uint32_t RangeEncoder::uniform(std::uint32_t size, std::uint32_t symbol) {
  if (size > kMaxUniform) {
    uniform(65536, symbol & 0xFFFF);
    uniform((size >> 16) + 1, symbol >> 16);
    return symbol;
  }
  normalize();
  const std::uint32_t step = range_ / size;
  low_ += step * symbol;
  range_ = symbol + 1 < size ? step : range_ - step * symbol;
  return symbol;
}

std::uint32_t RangeEncoder::word(std::uint32_t value) {
  uniform(65536, value & 0xFFFF);
  uniform(65536, value >> 16);
  return value;
}

std::uint32_t RangeEncoder::code(AdaptiveModel& model, std::uint32_t symbol) {
  normalize();
  const std::uint32_t step = range_ >> model.bits();
  const std::uint32_t below = model.below(symbol), above = model.below(symbol + 1);
  low_ += step * below;
  range_ = above >> model.bits() != 0 ? range_ - step * below : step * (above - below);
  model.update(symbol);
  return symbol;
}

void RangeEncoder::finish() {
  normalize();
  const std::uint32_t total = shifts_ + 5;
  std::uint32_t top = low_ >> 23;
  if ((low_ & (kBottom - 1)) >= ((total & 0xFFFFFF) >> 1)) ++top;
  put_held(top > 0xFF);
  put(top);
  put(total >> 16);
  put(total >> 8);
  put(total);
  flush();
}

}  // namespace reeb::io
