// Lists of events read back, and an independent check that they are a legal, compact stream.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace reeb::test {

struct EventList {
  struct Event {
    char kind;
    std::vector<std::size_t> vertices;
  };
  using Position = std::array<float, 3>;

  std::vector<Position> positions;
  std::vector<Event> events;

  // The triangles by the positions of their corners, which no renumbering changes; sorted.
  std::vector<std::array<Position, 3>> triangles() const {
    std::vector<std::array<Position, 3>> all;
    for (const Event& event : events) {
      if (event.kind != 't') continue;
      std::array<Position, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = positions[event.vertices[c]];
      std::sort(corners.begin(), corners.end());
      all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  std::vector<Position> sorted_positions() const {
    auto all = positions;
    std::sort(all.begin(), all.end());
    return all;
  }
};

inline EventList parse_events(const std::string& text) {
  EventList list;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    EventList::Event event;
    words >> event.kind;
    std::size_t vertex = 0;
    if (event.kind == 'v') {
      std::array<std::string, 3> numbers;
      words >> vertex >> numbers[0] >> numbers[1] >> numbers[2];
      list.positions.push_back({std::stof(numbers[0]), std::stof(numbers[1]), std::stof(numbers[2])});
      event.vertices.push_back(vertex);
    } else {
      while (words >> vertex) event.vertices.push_back(vertex);
    }
    list.events.push_back(event);
  }
  return list;
}

// A compact stream: vertices in order, each before its first triangle, and final directly after its last.
struct CompactStream {
  std::string fault;            // empty: none
  std::size_t front_width = 0;  // the largest number of vertices that were introduced and not yet final
};

inline CompactStream check_compact(const EventList& list) {
  constexpr std::size_t kNever = ~std::size_t{0};
  std::vector<std::size_t> last_use(list.positions.size(), kNever), first_use(list.positions.size(), kNever);
  for (std::size_t e = 0; e < list.events.size(); ++e)
    if (list.events[e].kind == 't')
      for (const std::size_t v : list.events[e].vertices) {
        if (v >= list.positions.size()) return {"a triangle names vertex " + std::to_string(v), 0};
        last_use[v] = e;
        first_use[v] = std::min(first_use[v], e);
      }
  CompactStream result;
  std::vector<bool> final_now(list.positions.size());
  std::size_t introduced = 0, finalized = 0, triangle_before = kNever;
  std::vector<std::size_t> fresh;  // introduced since the last triangle
  for (std::size_t e = 0; e < list.events.size(); ++e) {
    const auto& event = list.events[e];
    const std::string at = "event " + std::to_string(e) + ": ";
    if (event.kind == 'v') {
      if (event.vertices[0] != introduced++) return {at + "vertices out of order", 0};
      fresh.push_back(event.vertices[0]);
    } else if (event.kind == 't') {
      for (const std::size_t v : event.vertices)
        if (v >= introduced || final_now[v]) return {at + "a corner is not live", 0};
      for (const std::size_t v : fresh)
        if (first_use[v] != e) return {at + "a vertex came too early", 0};
      fresh.clear();
      triangle_before = e;
    } else {
      const std::size_t v = event.vertices[0];
      if (v >= introduced || final_now[v]) return {at + "finalizes what is not live", 0};
      if (last_use[v] != kNever && last_use[v] != triangle_before)
        return {at + "is not directly after the last use", 0};
      final_now[v] = true;
      ++finalized;
    }
    result.front_width = std::max(result.front_width, introduced - finalized);
  }
  if (finalized != introduced) result.fault = "not all vertices were finalized";
  return result;
}

}  // namespace reeb::test
