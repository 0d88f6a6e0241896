#include "libreeb/repair/curve_band.h"

#include <algorithm>
#include <cstddef>

namespace reeb {

std::optional<std::array<PatchNumbers, 2>> sides_of(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  std::array<PatchNumbers, 2> sides;
  PatchNumbers first;
  patch.for_each_at_edge(curve[0], curve[1], [&](std::uint32_t t) { first.push_back(t); });
  if (first.size() != 2) return std::nullopt;
  const std::size_t n = curve.size();
  for (std::size_t side = 0; side < 2; ++side) {
    std::uint32_t t = first[side];
    for (std::size_t i = 1; i <= n; ++i) {
      // Around this vertex from the edge before it to the edge after it.
      const std::uint32_t x = curve[i % n], next = curve[(i + 1) % n];
      std::uint32_t at = curve[i - 1];
      for (std::size_t steps = patch.all_at(x).size() + 1;; --steps) {
        if (steps == 0) return std::nullopt;
        sides[side].push_back(t);
        at = patch.third_corner(t, x, at);
        if (at == next) break;
        t = patch.across(t, x, at);
        if (t == EditablePatch::kNone) return std::nullopt;
      }
    }
    if (t != first[side]) return std::nullopt;
    make_set(sides[side]);
  }
  return sides;
}

CurveBand::CurveBand(const EditablePatch& patch, std::span<const std::uint32_t> curve, const PatchNumbers& side,
                     const PatchNumbers& other)
    : patch_(patch), curve_(curve) {
  for (const std::uint32_t v : curve) on_curve_.add(v);
  for (const std::uint32_t t : other) forbidden_.add(t);
  for (const std::uint32_t t : side) ok_ = ok_ && !forbidden_.has(t) && inside_.add(t);
}

void CurveBand::grow() {
  const PatchNumbers before = inside_.list();
  for (const std::uint32_t t : before)
    for (const std::uint32_t v : patch_.triangle(t).corners)
      if (!on_curve_.has(v)) add_around(v);
}

PatchNumbers CurveBand::close_rim() {
  constexpr int kMostRounds = 12;
  for (int round = 0; ok_ && round < kMostRounds; ++round) {
    find_edges();
    bool pinched = false;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const std::uint32_t v = edges_[i].first;
      if (on_curve_.has(v)) return {};
      // Each vertex is at two edges, each of which is listed in both directions.
      if ((i == 0 || edges_[i - 1].first != v) && i + 2 < edges_.size() && edges_[i + 2].first == v) {
        add_around(v);
        pinched = true;
      }
    }
    if (pinched) continue;
    std::vector<PatchNumbers> rims = paths();
    if (rims.empty()) return {};
    if (rims.size() == 1) return rims[0].size() >= 3 ? rims[0] : PatchNumbers{};
    if (!enclose(rims)) return {};
  }
  return {};
}

void CurveBand::add(std::uint32_t t) {
  if (forbidden_.has(t))
    ok_ = false;
  else
    inside_.add(t);
}

void CurveBand::add_around(std::uint32_t v) {
  ok_ = ok_ && patch_.vertex(v).whole;
  patch_.for_each_at(v, [&](std::uint32_t t) { add(t); });
}

bool CurveBand::is_on_curve(std::uint32_t a, std::uint32_t b) const {
  if (!on_curve_.has(a) || !on_curve_.has(b)) return false;
  for (std::size_t i = 0; i < curve_.size(); ++i) {
    const std::uint32_t c = curve_[i], d = curve_[(i + 1) % curve_.size()];
    if ((a == c && b == d) || (a == d && b == c)) return true;
  }
  return false;
}

void CurveBand::find_edges() {
  edges_.clear();
  for (const std::uint32_t t : inside_.list()) {
    const auto& c = patch_.triangle(t).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = c[i], b = c[(i + 1) % 3], other = patch_.across(t, a, b);
      if (other == EditablePatch::kNone) {
        ok_ = false;
        return;
      }
      if (inside_.has(other) || is_on_curve(a, b)) continue;
      edges_.emplace_back(a, b);
      edges_.emplace_back(b, a);
    }
  }
  std::sort(edges_.begin(), edges_.end());
}

// REQUIRES: each vertex is at two edges.
std::vector<PatchNumbers> CurveBand::paths() const {
  std::vector<PatchNumbers> result;
  std::vector<std::uint8_t> seen(edges_.size(), 0);
  for (std::size_t first = 0; first < edges_.size(); first += 2) {
    if (seen[first] != 0) continue;
    PatchNumbers path;
    std::size_t at = first;  // of the two entries of a vertex the first one
    std::uint32_t before = EditablePatch::kNone;
    while (seen[at] == 0) {
      seen[at] = 1;
      const std::uint32_t v = edges_[at].first;
      path.push_back(v);
      if (at + 1 >= edges_.size() || edges_[at + 1].first != v) return {};
      const std::uint32_t next = edges_[at].second != before ? edges_[at].second : edges_[at + 1].second;
      before = v;
      const auto it = std::lower_bound(edges_.begin(), edges_.end(), std::pair(next, std::uint32_t{0}));
      at = static_cast<std::size_t>(it - edges_.begin());
    }
    result.push_back(std::move(path));
  }
  return result;
}

// Adds the parts of the surface beyond all rims but one if they are small. Returns whether there was one.
bool CurveBand::enclose(const std::vector<PatchNumbers>& rims) {
  constexpr std::size_t kMostEnclosed = 200;
  bool any = false;
  for (const PatchNumbers& rim : rims) {
    NumberSet part;
    patch_.for_each_at_edge(rim[0], rim[1], [&](std::uint32_t t) {
      if (!inside_.has(t)) part.add(t);
    });
    bool open = false;
    for (std::size_t i = 0; i < part.list().size() && !open; ++i) {
      const std::uint32_t t = part.list()[i];
      open = part.list().size() > kMostEnclosed || forbidden_.has(t);
      const auto& c = patch_.triangle(t).corners;
      for (std::size_t k = 0; k < 3 && !open; ++k) {
        const std::uint32_t other = patch_.across(t, c[k], c[(k + 1) % 3]);
        if (other == EditablePatch::kNone)
          open = true;
        else if (!inside_.has(other))
          part.add(other);
      }
    }
    if (open) continue;
    any = true;
    for (const std::uint32_t t : part.list()) add(t);
  }
  return any;
}

}  // namespace reeb
