#include "io/smc/smc_positions.h"

#include <algorithm>
#include <cmath>

namespace reeb::io {
namespace {

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }
std::uint32_t exponent_of(float value) { return (bits_of(value) >> 23) & 0xFF; }
std::int32_t mantissa_of(float value) { return static_cast<std::int32_t>(bits_of(value) & 0x7FFFFF); }

// The alphabet for a grid with 2^precision places: its bits, and the low bits that are coded separately.
struct GridAlphabet {
  std::uint32_t small_bits, low_bits;
};

GridAlphabet alphabet_of(std::uint32_t precision) {
  static constexpr std::array<GridAlphabet, 25> kAlphabets = {{
      {0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0},  {6, 0},  {4, 0},  {5, 0},  {5, 0},   {5, 0},   {6, 0},   {7, 0},
      {7, 0}, {8, 0}, {8, 3}, {9, 4}, {9, 5}, {10, 6}, {10, 7}, {11, 8}, {12, 9}, {13, 10}, {14, 11}, {14, 12},
  }};
  return kAlphabets[precision];
}

}  // namespace

FloatAxis::FloatAxis(std::uint32_t precision) : precision_(precision), models_(kPredictions) {
  keep_.fill(kMantissaBits);
}

template <class Coder>
float FloatAxis::code(Coder& coder, Prediction kind, float predicted, float value) {
  Models& models = models_[static_cast<std::size_t>(kind)];
  const bool blind = kind == Prediction::kNone;
  const std::uint32_t predicted_exponent = blind ? 0 : exponent_of(predicted);
  std::uint32_t exponent = exponent_of(value);
  if (!Coder::kDecodes && keep_[exponent] < 0) exponent = 0;
  exponent = coder.code(ready(models.exponent[predicted_exponent], 256), exponent);
  if (keep_[exponent] < 0) return 0.0f;

  const bool predicted_sign = !blind && std::signbit(predicted);
  const bool sign =
      coder.bit(ready(models.sign[blind ? 0 : exponent], 2), std::signbit(value) != predicted_sign) != predicted_sign;
  std::int32_t predicted_mantissa = 0;
  if (!blind && sign == predicted_sign) {
    if (exponent == predicted_exponent) predicted_mantissa = mantissa_of(predicted);
    if (exponent < predicted_exponent) predicted_mantissa = kMantissaSize - 1;
  }
  const std::uint32_t mantissa = code_mantissa(coder, models, exponent, predicted_mantissa, mantissa_of(value));
  if (exponent == 255) fail(Fault::kBadNumber, "a coordinate is not finite", {});
  const float result = std::bit_cast<float>((sign ? 1u << 31 : 0u) | (exponent << 23) | mantissa);
  if (precision_ > 0) widen(result);
  return result;
}

template <class Coder>
std::uint32_t FloatAxis::code_mantissa(Coder& coder, Models& models, std::uint32_t exponent, std::int32_t predicted,
                                       std::int32_t mantissa) {
  const std::int32_t keep = keep_[exponent];
  if (keep == 0) return 0;
  const std::int32_t drop = kMantissaBits - keep;
  const std::int32_t mask = kMantissaSize - (1 << drop);
  std::int32_t correction = (mantissa & mask) - (predicted & mask);
  if (correction < -(kExtreme - 1))
    correction += kMantissaSize;
  else if (correction > kExtreme)
    correction -= kMantissaSize;
  auto magnitude = correction == kExtreme ? 0u : static_cast<std::uint32_t>(std::abs(correction) >> drop);
  // A model has at most 2048 symbols: longer magnitudes are coded in a high and a low part.
  if (keep >= 13) {
    const auto low_bits = static_cast<std::uint32_t>(keep - 12);
    const std::uint32_t high = coder.code(ready(models.high[exponent], 1u << 11), magnitude >> low_bits);
    const std::uint32_t low =
        coder.code(ready(models.low[exponent], 1u << low_bits), magnitude & ((1u << low_bits) - 1));
    magnitude = (high << low_bits) | low;
  } else if (keep >= 2) {
    magnitude = coder.code(ready(models.low[exponent], 1u << (keep - 1)), magnitude);
  } else {
    magnitude = 0;
  }
  if (magnitude > 0) {
    const bool negative = coder.bit(ready(negative_[exponent], 2), correction < 0);
    correction = static_cast<std::int32_t>(magnitude << drop);
    if (negative) correction = -correction;
  } else {
    const bool extreme = coder.bit(ready(zero_or_extreme_[exponent], 2), correction == kExtreme);
    correction = extreme ? kExtreme : 0;
  }
  return static_cast<std::uint32_t>(((predicted & mask) + correction) & (kMantissaSize - 1));
}

// Adaptive precision: the larger the range of the values, the fewer bits of small ones matter.
void FloatAxis::widen(float value) {
  if (fresh_) {
    least_ = most_ = value;
    fresh_ = false;
    return;
  }
  if (value < least_)
    least_ = value;
  else if (value > most_)
    most_ = value;
  else
    return;
  const float range = most_ - least_;
  const std::int32_t exponent = static_cast<std::int32_t>(bits_of(range) >> 23) - (mantissa_of(range) == 0 ? 1 : 0);
  if (exponent <= range_exponent_) return;
  range_exponent_ = exponent;
  std::int32_t i = std::min(22 - static_cast<std::int32_t>(precision_) + exponent, 255);
  for (std::int32_t bits = 22; bits >= 0 && i >= 0; --bits, --i) {
    reset(i);
    keep_[static_cast<std::size_t>(i)] = bits;
  }
  for (; i >= 0 && keep_[static_cast<std::size_t>(i)] != -1; --i) {
    reset(i);
    keep_[static_cast<std::size_t>(i)] = -1;
  }
}

void FloatAxis::reset(std::int32_t exponent) {
  for (Models& models : models_) {
    models.high[static_cast<std::size_t>(exponent)] = {};
    models.low[static_cast<std::size_t>(exponent)] = {};
  }
}

GridAxis::GridAxis(std::uint32_t precision, std::int32_t size)
    : size_(size), least_(-(size / 2)), low_bits_(alphabet_of(precision).low_bits) {
  const std::int32_t small = 1 << alphabet_of(precision).small_bits;
  escapes_ = size > small;
  cut_ = escapes_ ? small / 2 : 1 + size / 2;
  const std::int32_t most = least_ + size - 1;
  const std::int32_t high_symbols =
      low_bits_ == 0 ? size - (2 * cut_ - 1) : (most >> low_bits_) - (least_ >> low_bits_) + 1;
  for (std::size_t kind = 0; kind < kPredictions; ++kind) {
    small_[kind] = AdaptiveModel(static_cast<std::uint32_t>(escapes_ ? small : 1 + size), kLargeModel);
    if (escapes_) high_[kind] = AdaptiveModel(static_cast<std::uint32_t>(high_symbols), kLargeModel);
  }
  if (!escapes_ || low_bits_ == 0) return;
  low_positive_ = AdaptiveModel(1u << low_bits_, kLargeModel);
  low_negative_ = AdaptiveModel(1u << low_bits_, kLargeModel);
}

template <class Coder>
std::int32_t GridAxis::code(Coder& coder, Prediction kind, std::int32_t predicted, std::int32_t value) {
  const std::int32_t most = least_ + size_ - 1;
  std::int32_t correction = value - predicted;
  if (correction < least_)
    correction += size_;
  else if (correction > most)
    correction -= size_;
  std::int32_t place = predicted + code_correction(coder, static_cast<std::size_t>(kind), correction);
  if (place < 0)
    place += size_;
  else if (place >= size_)
    place -= size_;
  if (place < 0 || place >= size_) fail(Fault::kCorrupt, "a position outside the bounding box", {});
  previous_ = place;
  return place;
}

template <class Coder>
std::int32_t GridAxis::code_correction(Coder& coder, std::size_t kind, std::int32_t correction) {
  const bool is_small = std::abs(correction) < cut_;
  const std::uint32_t symbol = coder.code(small_[kind], is_small ? static_cast<std::uint32_t>(correction + cut_) : 0);
  if (symbol != 0) return static_cast<std::int32_t>(symbol) - cut_;
  if (!escapes_) fail(Fault::kCorrupt, "an escape on a grid that has none", {});
  if (low_bits_ == 0) {
    const std::int32_t gap = 2 * cut_ - 1;  // the number of small corrections
    const std::int32_t shifted = correction - least_ - (correction > 0 ? gap : 0);
    const auto high = static_cast<std::int32_t>(coder.code(high_[kind], static_cast<std::uint32_t>(shifted)));
    return high + least_ + (high <= -least_ - cut_ ? 0 : gap);
  }
  const std::int32_t base = least_ >> low_bits_;
  const auto high =
      static_cast<std::int32_t>(coder.code(high_[kind], static_cast<std::uint32_t>((correction >> low_bits_) - base)));
  AdaptiveModel& low_model = high <= -base ? low_negative_ : low_positive_;
  const std::uint32_t low = coder.code(low_model, static_cast<std::uint32_t>(correction) & ((1u << low_bits_) - 1));
  return ((high + base) << low_bits_) + static_cast<std::int32_t>(low);
}

Grid::Grid(const StreamBox& box, std::uint32_t precision) {
  std::array<double, 3> extent{};
  for (std::size_t k = 0; k < 3; ++k) {
    min[k] = box.min[k];
    extent[k] = static_cast<double>(box.max[k]) - min[k];
  }
  const double longest = *std::max_element(extent.begin(), extent.end());
  const double steps = static_cast<double>((1u << precision) - 1);
  places_per_unit = steps / longest;
  units_per_place = longest / steps;
  for (std::size_t k = 0; k < 3; ++k) top[k] = static_cast<std::int32_t>(std::floor(extent[k] * places_per_unit + 0.5));
}

std::int32_t Grid::place(std::size_t axis, float x) const {
  const double place = places_per_unit * (static_cast<double>(x) - min[axis]) + 0.5;
  return static_cast<std::int32_t>(std::clamp(place, 0.0, static_cast<double>(top[axis])));
}

float Grid::position(std::size_t axis, std::int32_t place) const {
  const double offset = units_per_place * place;
  const double x = offset + min[axis];
  if (std::abs(x) > static_cast<double>(std::numeric_limits<float>::max()))
    fail(Fault::kBadNumber, "a coordinate is not finite", {});
  return static_cast<float>(x);
}

PositionCoder::PositionCoder(std::uint32_t precision, const std::optional<StreamBox>& box) {
  const bool quantized = precision > 0 && box;
  if (quantized) grid_.emplace(*box, precision);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (quantized)
      grid_axes_.emplace_back(precision, grid_->top[axis] + 1);
    else
      float_axes_.emplace_back(precision);
  }
}

CodedPosition PositionCoder::to_coded(const std::array<float, 3>& position) const {
  CodedPosition coded{};
  for (std::size_t k = 0; k < 3; ++k)
    coded[k] = grid_ ? grid_->place(k, position[k]) : std::bit_cast<std::int32_t>(position[k]);
  return coded;
}

std::array<float, 3> PositionCoder::to_position(const CodedPosition& coded) const {
  std::array<float, 3> position{};
  for (std::size_t k = 0; k < 3; ++k)
    position[k] = grid_ ? grid_->position(k, coded[k]) : std::bit_cast<float>(coded[k]);
  return position;
}

template <class Coder>
std::int32_t PositionCoder::code_float(Coder& coder, std::size_t axis, const PredictionInput& from,
                                       std::int32_t value) {
  const auto real = [axis](const CodedPosition* p) { return std::bit_cast<float>((*p)[axis]); };
  float predicted = 0;
  if (from.kind == Prediction::kLast) predicted = real(from.a);
  if (from.kind == Prediction::kAcross) predicted = FloatAxis::across(real(from.a), real(from.b), real(from.c));
  return std::bit_cast<std::int32_t>(float_axes_[axis].code(coder, from.kind, predicted, std::bit_cast<float>(value)));
}

template <class Coder>
std::int32_t PositionCoder::code_place(Coder& coder, std::size_t axis, const PredictionInput& from,
                                       std::int32_t value) {
  GridAxis& grid_axis = grid_axes_[axis];
  std::int32_t predicted = grid_axis.previous();
  if (from.kind == Prediction::kLast) predicted = (*from.a)[axis];
  if (from.kind == Prediction::kAcross)
    predicted = grid_axis.clamp((*from.a)[axis] - (*from.b)[axis] + (*from.c)[axis]);
  return grid_axis.code(coder, from.kind, predicted, value);
}

template <class Coder>
CodedPosition PositionCoder::code(Coder& coder, const PredictionInput& from, const CodedPosition& value) {
  CodedPosition result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = grid_ ? code_place(coder, axis, from, value[axis]) : code_float(coder, axis, from, value[axis]);
  return result;
}

template CodedPosition PositionCoder::code(RangeDecoder&, const PredictionInput&, const CodedPosition&);
template CodedPosition PositionCoder::code(RangeEncoder&, const PredictionInput&, const CodedPosition&);

}  // namespace reeb::io
