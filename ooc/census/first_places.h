// How many places there are of one kind, and the first of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ooc/census/mesh_census.h"

namespace reeb::ooc {

class FirstPlaces {
 public:
  // One, two or three vertices, the rest VertexId::none().
  using Vertices = std::array<VertexId, 3>;

  static Vertices ascending(VertexId a, VertexId b = VertexId::none(), VertexId c = VertexId::none()) {
    Vertices vertices{a, b, c};
    std::ranges::sort(vertices);
    return vertices;
  }

  // Counts a place `times`, which is listed once.
  void add(const Vertices& vertices, const Point& position, std::uint64_t times = 1) {
    count_ += times;
    if (places_.size() == CensusCount::kMostPlaces && !comes_before(vertices, places_.back().first)) return;
    const auto at = std::ranges::lower_bound(places_, vertices, comes_before, &Place::first);
    if (at != places_.end() && at->first == vertices) return;
    places_.insert(at, {vertices, position});
    if (places_.size() > CensusCount::kMostPlaces) places_.pop_back();
  }

  std::uint64_t count() const { return count_; }

  CensusCount result() const {
    CensusCount result{.count = count_, .places = {}};
    for (const auto& [vertices, position] : places_) {
      CensusPlace place{.vertices = {}, .position = position};
      for (const VertexId v : vertices)
        if (v != VertexId::none()) place.vertices.push_back(v);
      result.places.push_back(std::move(place));
    }
    return result;
  }

 private:
  using Place = std::pair<Vertices, Point>;

  // An absent vertex is before all others.
  static bool comes_before(const Vertices& a, const Vertices& b) {
    return std::ranges::lexicographical_compare(a, b, {}, next, next);
  }
  static std::uint64_t next(VertexId v) { return v.value() + 1; }

  std::uint64_t count_ = 0;
  std::vector<Place> places_;  // ascending
};

// Keeps the first kMostPlaces of `list` in the order of `before`.
template <class Item, class Before>
void keep_first(std::vector<Item>& list, Item item, const Before& before) {
  if (list.size() == CensusCount::kMostPlaces && !before(item, list.back())) return;
  list.insert(std::upper_bound(list.begin(), list.end(), item, before), std::move(item));
  if (list.size() > CensusCount::kMostPlaces) list.pop_back();
}

}  // namespace reeb::ooc
