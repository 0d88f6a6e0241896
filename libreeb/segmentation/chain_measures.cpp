#include "libreeb/segmentation/chain_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb {

void LinearSum::Sum::add(double value) {
  const double sum = high + value, part = sum - high;
  low += (high - (sum - part)) + (value - part);
  high = sum + low;
  low -= high - sum;
}

void LinearSum::add(double slope, double origin) {
  const double offset = slope * origin;
  slope_.add(slope);
  offset_.add(-offset);
  offset_.add(-std::fma(slope, origin, -offset));
  greatest_slope_ = std::max(greatest_slope_, std::abs(slope_.high));
  greatest_offset_ = std::max(greatest_offset_, std::abs(offset_.high));
}

double LinearSum::error(double level) const {
  constexpr double kRounding = 0x1p-100;
  return kRounding * greatest_slope_ * std::abs(level) + kRounding * greatest_offset_;
}

double LinearSum::at(double level) const {
  const double product = slope_.high * level;
  Sum sum = offset_;
  sum.add(product);
  sum.add(std::fma(slope_.high, level, -product));
  sum.add(slope_.low * level);
  return std::max(0.0, sum.high);
}

ChainMeasures::ChainMeasures(const ReebGraph& graph, const ArcChains& chains, std::vector<ArcMeasures>& arcs)
    : graph_(graph), chains_(chains), arcs_(arcs) {
  double greatest = 0;
  for (const SweepKey& node : graph.nodes) greatest = std::max(greatest, std::abs(node.value));
  if (greatest == 0) return;
  constexpr int kExponent = 500;
  const int exponent = kExponent - std::ilogb(greatest);
  scale_ = {std::ldexp(1, exponent / 2), std::ldexp(1, exponent - exponent / 2)};
}

void ChainMeasures::add(const CrossingTriangle& triangle) {
  while (chain_ < triangle.chain) end_chain();
  if (!started_) start_chain();
  const double from = scaled(triangle.from), to = scaled(triangle.to);
  advance(from);
  const double lo = scaled(triangle.lo), mid = scaled(triangle.mid), hi = scaled(triangle.hi);
  longest_ = std::max(longest_, triangle.length);
  add_part(std::max(from, lo), std::min(to, mid), triangle.length / (mid - lo), lo);
  add_part(std::max(from, mid), std::min(to, hi), triangle.length / (mid - hi), hi);
}

void ChainMeasures::finish() {
  while (chain_ < chains_.chain_count()) end_chain();
}

void ChainMeasures::start_chain() {
  started_ = true;
  at_ = 0;
  changes_.clear();
  open_ = 0;
  length_ = {};
  longest_ = 0;
  level_ = level_of(graph_.lo[chains_.arcs(chain_)[0].value()]);
  start_arc();
}

void ChainMeasures::end_chain() {
  if (!started_) start_chain();
  const auto arcs = chains_.arcs(chain_);
  advance(level_of(graph_.hi[arcs.back().value()]));
  started_ = false;
  ++chain_;
}

void ChainMeasures::start_arc() {
  top_ = level_of(graph_.hi[chains_.arcs(chain_)[at_].value()]);
  shortest_ = std::numeric_limits<double>::infinity();
}

void ChainMeasures::end_arc() {
  ArcMeasures& arc = arcs_[chains_.arcs(chain_)[at_].value()];
  arc.shortest_contour = std::isinf(shortest_) ? std::numeric_limits<double>::quiet_NaN() : shortest_;
}

void ChainMeasures::add_part(double from, double to, double slope, double origin) {
  // Where the slope is no number, the part is lower than any difference of levels that could show it.
  if (!(from < to) || !std::isfinite(slope)) return;
  for (const bool begins : {true, false}) {
    changes_.push_back({begins ? from : to, from, origin, slope, begins});
    std::push_heap(changes_.begin(), changes_.end(), later);
  }
}

// An arc ends before anything changes at its upper end.
void ChainMeasures::advance(double level) {
  const std::size_t arcs = chains_.arcs(chain_).size();
  for (;;) {
    const double next = changes_.empty() ? std::numeric_limits<double>::infinity() : changes_.front().level;
    if (at_ < arcs && top_ <= std::min(next, level)) {
      see(top_);
      end_arc();
      if (++at_ < arcs) start_arc();
    } else if (next <= level) {
      std::pop_heap(changes_.begin(), changes_.end(), later);
      see(next);
      apply(changes_.back());
      changes_.pop_back();
    } else {
      break;
    }
  }
  see(level);
}

// The length is linear from level_ to here.
void ChainMeasures::see(double level) {
  if (level <= level_) return;
  if (at_ < chains_.arcs(chain_).size()) shortest_ = std::min({shortest_, length_at(level_), length_at(level)});
  level_ = level;
}

// REQUIRES: all changes up to level_ were applied.
double ChainMeasures::length_at(double level) {
  constexpr double kExact = 0x1p-40;
  if (open_ == 0) return 0;
  if (length_.error(level) > kExact * longest_) {
    length_ = {};
    for (const Change& end : changes_)
      if (!end.begins && end.from <= level_) length_.add(end.slope, end.origin);
  }
  return length_.at(level);
}

void ChainMeasures::apply(const Change& change) {
  if (change.begins) {
    ++open_;
    length_.add(change.slope, change.origin);
  } else if (--open_ == 0) {
    length_ = {};
  } else {
    length_.remove(change.slope, change.origin);
  }
}

}  // namespace reeb
