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
}

double LinearSum::at(double level) const {
  const double product = slope_.high * level;
  Sum sum = offset_;
  sum.add(product);
  sum.add(std::fma(slope_.high, level, -product));
  sum.add(slope_.low * level);
  return std::max(0.0, sum.high);
}

void ChainMeasures::add(const CrossingTriangle& triangle) {
  while (chain_ < triangle.chain) end_chain();
  if (!started_) start_chain();
  advance(triangle.from);
  const auto [chain, from, to, lo, mid, hi, length, width] = triangle;
  add_part(std::max(from, lo), std::min(to, mid), length, width, mid - lo, lo);
  add_part(std::max(from, mid), std::min(to, hi), -length, -width, hi - mid, hi);
}

void ChainMeasures::finish() {
  while (chain_ < chains_.chain_count()) end_chain();
}

void ChainMeasures::start_chain() {
  started_ = true;
  at_ = 0;
  changes_.clear();
  open_ = 0;
  length_ = width_ = {};
  level_ = graph_.nodes[graph_.lo[chains_.arcs(chain_)[0].value()].value()].value;
  start_arc();
}

void ChainMeasures::end_chain() {
  if (!started_) start_chain();
  const auto arcs = chains_.arcs(chain_);
  advance(graph_.nodes[graph_.hi[arcs.back().value()].value()].value);
  started_ = false;
  ++chain_;
}

void ChainMeasures::start_arc() {
  top_ = graph_.nodes[graph_.hi[chains_.arcs(chain_)[at_].value()].value()].value;
  shortest_ = std::numeric_limits<double>::infinity();
}

void ChainMeasures::end_arc() {
  ArcMeasures& arc = arcs_[chains_.arcs(chain_)[at_].value()];
  arc.shortest_contour = std::isinf(shortest_) ? std::numeric_limits<double>::quiet_NaN() : shortest_;
}

void ChainMeasures::add_part(double from, double to, double length, double width, double height, double origin) {
  const double length_slope = length / height, width_slope = width / height;
  // Where a slope is no number, the part is lower than any difference of levels that could show it.
  if (!(from < to) || !std::isfinite(length_slope) || !std::isfinite(width_slope)) return;
  for (const bool begins : {true, false}) {
    changes_.push_back({begins ? from : to, origin, length_slope, width_slope, begins});
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

// Length and width are linear from level_ to here.
void ChainMeasures::see(double level) {
  if (level <= level_) return;
  if (at_ < chains_.arcs(chain_).size()) {
    const auto here = [&](const LinearSum& sum, double at) { return open_ == 0 ? 0 : sum.at(at); };
    shortest_ = std::min({shortest_, here(length_, level_), here(length_, level)});
    arcs_[chains_.arcs(chain_)[at_].value()].area +=
        (here(width_, level_) / 2 + here(width_, level) / 2) * (level - level_);
  }
  level_ = level;
}

void ChainMeasures::apply(const Change& change) {
  if (change.begins) {
    ++open_;
    length_.add(change.length_slope, change.origin);
    width_.add(change.width_slope, change.origin);
  } else if (--open_ == 0) {
    length_ = width_ = {};
  } else {
    length_.remove(change.length_slope, change.origin);
    width_.remove(change.width_slope, change.origin);
  }
}

}  // namespace reeb
