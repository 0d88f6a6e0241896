// Which loops of a Reeb graph are likely defects of the mesh, as far as their persistence tells.
#pragma once

#include <cstdint>

namespace reeb {

struct SmallLoops {
  std::uint64_t count = 0;  // 0: persistence tells none apart
  double persistence = 0;   // of the largest of them
};

// Defects are far smaller than the features of a shape. So there is a gap between their persistences and those of
// features: on a logarithmic axis, the widest one above a persistence of at most 2 % of the range. It counts if it is a
// factor of at least 3. What is above the last loop is the range itself.
class LikelyDefects {
 public:
  explicit LikelyDefects(double range) : range_(range) {}

  // The next loop, in ascending order. Those whose persistence is not positive are ignored.
  void add(double persistence);
  SmallLoops found() const;

 private:
  SmallLoops with_next(double persistence) const;

  double range_;
  double last_ = 0, widest_ = 3;
  std::uint64_t count_ = 0;
  SmallLoops found_{};
};

}  // namespace reeb
