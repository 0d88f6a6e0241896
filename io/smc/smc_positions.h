// Positions of vertices in SMC files: each is predicted, and the error of the prediction is coded.
//
// There are three modes: quantized to a grid in a box; lossless float32; and float32 with mantissas shortened to a
// precision that follows the range of the values so far (adaptive). The same code encodes and decodes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/events/stream_event.h"
#include "io/events/stream_fault.h"
#include "io/smc/adaptive_model.h"
#include "io/smc/range_coder.h"

namespace reeb::io {

// How a position is predicted: not at all, from the first corner, or by the parallelogram across an edge.
enum class Prediction : std::uint8_t { kNone, kLast, kAcross };
inline constexpr std::size_t kPredictions = 3;

// A coded position: the bits of three float32, or three places on the grid.
using CodedPosition = std::array<std::int32_t, 3>;

struct PredictionInput {
  Prediction kind = Prediction::kNone;
  // For kLast: a. For kAcross: a and c are the ends of the edge, b is opposite to it.
  const CodedPosition* a = nullptr;
  const CodedPosition* b = nullptr;
  const CodedPosition* c = nullptr;
};

// One axis of float32, lossless or adaptive.
class FloatAxis {
 public:
  // `precision`: 0 is lossless, else the number of bits to keep, relative to the largest range.
  explicit FloatAxis(std::uint32_t precision);

  // THROWS: BAD_NUMBER for infinities and NaN.
  template <class Coder>
  float code(Coder& coder, Prediction kind, float predicted, float value);

  // The prediction across an edge, rounded after each operation.
  static float across(float a, float b, float c) {
    const float difference = a - b;
    return difference + c;
  }

 private:
  static constexpr std::int32_t kMantissaBits = 23, kMantissaSize = 1 << kMantissaBits;
  static constexpr std::int32_t kExtreme = 1 << 22;  // the one correction without a sign

  // The models for one kind of prediction, each created when first used.
  struct Models {
    std::array<AdaptiveModel, 256> exponent;  // by the exponent of the prediction
    std::array<AdaptiveModel, 256> sign;      // this and the others: by the exponent of the value
    std::array<AdaptiveModel, 256> high, low;
  };

  static AdaptiveModel& ready(AdaptiveModel& model, std::uint32_t symbols) {
    if (!model.exists()) [[unlikely]]
      model = AdaptiveModel(symbols, kSmallModel);
    return model;
  }
  template <class Coder>
  std::uint32_t code_mantissa(Coder& coder, Models& models, std::uint32_t exponent, std::int32_t predicted,
                              std::int32_t mantissa);
  void widen(float value);
  void reset(std::int32_t exponent);

  std::uint32_t precision_;
  std::vector<Models> models_;  // kPredictions of them
  std::array<AdaptiveModel, 256> zero_or_extreme_, negative_;
  std::array<std::int32_t, 256> keep_;  // mantissa bits by exponent; negative: the value becomes 0
  bool fresh_ = true;
  float least_ = 0, most_ = 0;
  std::int32_t range_exponent_ = -1;
};

// One axis of a grid with `size` places.
class GridAxis {
 public:
  GridAxis(std::uint32_t precision, std::int32_t size);

  // THROWS: CORRUPT.
  template <class Coder>
  std::int32_t code(Coder& coder, Prediction kind, std::int32_t predicted, std::int32_t value);

  std::int32_t size() const { return size_; }
  std::int32_t clamp(std::int32_t place) const { return place < 0 ? 0 : place >= size_ ? size_ - 1 : place; }
  std::int32_t previous() const { return previous_; }

 private:
  template <class Coder>
  std::int32_t code_correction(Coder& coder, std::size_t kind, std::int32_t correction);

  std::int32_t size_, least_, cut_;
  std::uint32_t low_bits_;
  bool escapes_;
  std::array<AdaptiveModel, kPredictions> small_, high_;
  AdaptiveModel low_positive_, low_negative_;
  std::int32_t previous_ = 0;
};

// Converts between float32 positions and a uniform grid with 2^precision places along the longest side.
struct Grid {
  std::array<double, 3> min{};
  double places_per_unit = 0, units_per_place = 0;
  std::array<std::int32_t, 3> top{};

  // REQUIRES: a finite box with some extent; 1 <= precision <= 24.
  Grid(const StreamBox& box, std::uint32_t precision);
  std::int32_t place(std::size_t axis, float x) const;
  // THROWS: BAD_NUMBER. The last place can be half a step outside the box, and so beyond float32.
  float position(std::size_t axis, std::int32_t place) const;
};

class PositionCoder {
 public:
  // Quantized if precision > 0 and there is a box, lossless if precision == 0, else adaptive.
  PositionCoder(std::uint32_t precision, const std::optional<StreamBox>& box);

  // The coded position; on a grid it is rounded.
  CodedPosition to_coded(const std::array<float, 3>& position) const;
  std::array<float, 3> to_position(const CodedPosition& coded) const;

  // Codes `value` (the decoder ignores it) and returns the value that a decoder gets.
  template <class Coder>
  CodedPosition code(Coder& coder, const PredictionInput& from, const CodedPosition& value);

 private:
  template <class Coder>
  std::int32_t code_float(Coder& coder, std::size_t axis, const PredictionInput& from, std::int32_t value);
  template <class Coder>
  std::int32_t code_place(Coder& coder, std::size_t axis, const PredictionInput& from, std::int32_t value);

  std::optional<Grid> grid_;  // none for floats
  std::vector<FloatAxis> float_axes_;
  std::vector<GridAxis> grid_axes_;
};

extern template CodedPosition PositionCoder::code(RangeDecoder&, const PredictionInput&, const CodedPosition&);
extern template CodedPosition PositionCoder::code(RangeEncoder&, const PredictionInput&, const CodedPosition&);

}  // namespace reeb::io
