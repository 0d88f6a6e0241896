#include "tests/support/inputs/plain_surface.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace reeb::test {
namespace {

std::size_t size_of(const std::string& type) {
  static const std::map<std::string, std::size_t> kSizes = {{"char", 1}, {"uchar", 1}, {"short", 2}, {"ushort", 2},
                                                            {"int", 4},  {"uint", 4},  {"float", 4}, {"double", 8}};
  return kSizes.at(type);
}

}  // namespace

PlainSurface read_plain_ply(const std::string& bytes) {
  PlainSurface surface;
  const std::size_t end = bytes.find("end_header\n") + 11;
  surface.header = bytes.substr(0, end);
  if (surface.header.find("format binary_little_endian") == std::string::npos)
    throw std::runtime_error("not the expected PLY");
  std::istringstream lines(surface.header);
  std::size_t vertices = 0, faces = 0, stride = 0;
  bool in_vertices = false, is_double = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "element") {
      in_vertices = type == "vertex";
      (in_vertices ? vertices : faces) = std::stoul(name);
    }
    if (word == "property" && in_vertices) {
      stride += size_of(type);
      if (name == "x") is_double = type == "double";
    }
  }
  const char* at = bytes.data() + end;
  for (std::size_t i = 0; i < vertices; ++i, at += stride) {
    std::array<double, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      float number = 0;
      if (is_double)
        std::memcpy(&p[k], at + 8 * k, 8);
      else
        std::memcpy(&number, at + 4 * k, 4);
      if (!is_double) p[k] = static_cast<double>(number);
    }
    surface.vertices.push_back(p);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    if (*at++ != 3) throw std::runtime_error("not a triangle");
    std::array<std::uint32_t, 3> t{};
    std::memcpy(t.data(), at, 12);
    at += 12;
    surface.triangles.push_back(t);
  }
  if (at != bytes.data() + bytes.size()) throw std::runtime_error("another size than expected");
  return surface;
}

PlainSurface read_plain_off(const std::string& text) {
  PlainSurface surface;
  std::istringstream in(text);
  std::string word;
  std::size_t vertices = 0, faces = 0, zero = 0;
  in >> word >> vertices >> faces >> zero;
  surface.vertices.resize(vertices);
  for (auto& p : surface.vertices) in >> p[0] >> p[1] >> p[2];
  surface.triangles.resize(faces);
  for (auto& t : surface.triangles) in >> zero >> t[0] >> t[1] >> t[2];
  return surface;
}

SurfaceCount recount(const PlainSurface& surface) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  SurfaceCount count;
  std::map<Edge, std::pair<int, int>> edges;  // times in either direction
  std::map<std::array<std::uint32_t, 3>, int> triangles;
  std::vector<std::vector<Edge>> links(surface.vertices.size());
  std::vector<std::uint32_t> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const std::function<std::uint32_t(std::uint32_t)> find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : surface.triangles) {
    auto sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (triangles[sorted]++ > 0) ++count.coincident;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      auto& times = edges[std::minmax(a, b)];
      ++(a < b ? times.first : times.second);
      parent[find(a)] = find(b);
      links[t[i]].emplace_back(t[(i + 1) % 3], t[(i + 2) % 3]);
    }
  }
  std::int64_t used = 0;
  for (std::uint32_t v = 0; v < links.size(); ++v) {
    if (links[v].empty()) {
      ++count.unused_vertices;
      continue;
    }
    ++used;
    if (find(v) == v) ++count.components;
    // The link must be one path or one cycle: connected, with at most two edges at each vertex.
    std::map<std::uint32_t, std::vector<std::uint32_t>> next;
    for (const auto& [a, b] : links[v]) {
      next[a].push_back(b);
      next[b].push_back(a);
    }
    std::set<std::uint32_t> reached = {next.begin()->first};
    std::vector<std::uint32_t> open(reached.begin(), reached.end());
    bool odd = false;
    while (!open.empty()) {
      const std::uint32_t a = open.back();
      open.pop_back();
      odd = odd || next[a].size() > 2;
      for (const std::uint32_t b : next[a])
        if (reached.insert(b).second) open.push_back(b);
    }
    if (odd || reached.size() != next.size()) ++count.nonmanifold_vertices;
  }
  for (const auto& [edge, times] : edges) {
    const int all = times.first + times.second;
    if (all == 1) ++count.boundary_edges;
    if (all > 2) ++count.nonmanifold_edges;
    if (all == 2 && times.first != 1) ++count.unoriented_edges;
  }
  count.euler = used - static_cast<std::int64_t>(edges.size()) + static_cast<std::int64_t>(triangles.size());
  return count;
}

}  // namespace reeb::test
