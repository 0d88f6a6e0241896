#include "tools/report/skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "io/export/arc_line.h"
#include "libreeb/format/reeb_format.h"
#include "ooc/reeb_file/level_history.h"
#include "tools/report/page_text.h"

namespace reeb::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 60'000;
constexpr double kFirstTolerance = 1.0 / 2000;  // of the box

struct Stop {
  Point position{};
  double value = 0;
  double radius = 0;  // of the contour; 0 where the file has none
};

struct Record {
  FileArc arc;
  std::vector<Stop> line;  // with its nodes at both ends
};

// Where positions are not known, the value is the height.
Point place_of(const SettledNode& node, bool has_positions) {
  return has_positions ? node.position : Point{0, 0, node.key.value};
}

std::vector<Stop> full_line(const SettledNode& lo, const SettledNode& hi, std::span<const Bucket> buckets,
                            const FileHeader& header) {
  const bool positions = header.flags.has_positions;
  std::vector<Stop> line{{place_of(lo, positions), lo.key.value}};
  if (positions && !buckets.empty()) {
    std::vector<Point> points;
    io::draw_arc(lo.position, buckets, hi.position, points);
    std::vector<double> radii(points.size(), 0);
    const auto in_buckets = [&](double value) { return std::ldexp(value, -header.bucket_exponent); };
    if (header.flags.has_spreads)
      io::find_line_radii(in_buckets(lo.key.value), buckets, in_buckets(hi.key.value), radii);
    std::size_t next = 0;
    for (const Bucket& bucket : buckets)
      if (bucket.count != 0) {
        const double middle = std::ldexp(static_cast<double>(bucket.index) + 0.5, header.bucket_exponent);
        line.push_back({points[next], std::clamp(middle, lo.key.value, hi.key.value), radii[next]});
        ++next;
      }
  }
  line.push_back({place_of(hi, positions), hi.key.value, line.back().radius});
  if (line.size() > 1) line.front().radius = line[1].radius;
  return line;
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  double along = 0, length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (p[k] - a[k]) * (b[k] - a[k]);
    length += (b[k] - a[k]) * (b[k] - a[k]);
  }
  const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = a[k] + t * (b[k] - a[k]) - p[k];
    square += d * d;
  }
  return std::sqrt(square);
}

// Keeps the points without which the line would move by more than the tolerance (Douglas and Peucker).
void simplify(std::vector<Stop>& line, double tolerance) {
  std::vector<bool> keep(line.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, line.size() - 1}};
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    double largest = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = distance_to_segment(line[i].position, line[first].position, line[last].position);
      if (d > largest) {
        largest = d;
        at = i;
      }
    }
    if (at == first) continue;
    keep[at] = true;
    parts.emplace_back(first, at);
    parts.emplace_back(at, last);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (keep[i]) line[kept++] = line[i];
  line.resize(kept);
}

// Those that are drawn, in their order; the others are renumbered accordingly.
std::vector<SettledNode> needed_nodes(const std::vector<SettledNode>& all, std::vector<Record>& records,
                                      std::vector<std::uint32_t>& isolated) {
  std::vector<std::uint32_t> number(all.size(), 0);
  for (const Record& record : records) number[record.arc.lo] = number[record.arc.hi] = 1;
  for (const std::uint32_t node : isolated) number[node] = 1;
  std::vector<SettledNode> nodes;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (number[i] != 0) {
      number[i] = static_cast<std::uint32_t>(nodes.size());
      nodes.push_back(all[i]);
    }
  for (Record& record : records) {
    record.arc.lo = number[record.arc.lo];
    record.arc.hi = number[record.arc.hi];
  }
  for (std::uint32_t& node : isolated) node = number[node];
  return nodes;
}

// JSON has no infinity.
double doubled(double half) { return std::min(2 * half, std::numeric_limits<double>::max()); }

struct Box {
  Point min{}, max{};
  double half_size = 0;  // of its largest side, which can be beyond the doubles
};

Box box_of(const std::vector<SettledNode>& nodes, const std::vector<Record>& records, bool positions) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, 0};
  const auto add = [&](const Point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], p[k]);
      box.max[k] = std::max(box.max[k], p[k]);
    }
  };
  for (const SettledNode& node : nodes) add(place_of(node, positions));
  for (const Record& record : records)
    for (const Stop& stop : record.line) add(stop.position);
  if (nodes.empty()) return {};
  for (std::size_t k = 0; k < 3; ++k) box.half_size = std::max(box.half_size, box.max[k] / 2 - box.min[k] / 2);
  return box;
}

// The tolerance grows until few enough points are left: lines of a thousand nodes keep all that can be seen.
void simplify_all(std::vector<Record>& records, double size) {
  for (double tolerance = kFirstTolerance; tolerance < 1; tolerance *= 2) {
    std::size_t points = 0;
    for (Record& record : records) {
      simplify(record.line, tolerance * size);
      points += record.line.size() - 2;
    }
    if (points <= kMostPoints) return;
  }
  for (Record& record : records) simplify(record.line, std::numeric_limits<double>::infinity());
}

// The radius that few points exceed: a few large contours, as of the faces of a box, do not make all lines thin.
double widest_radius(const std::vector<Record>& records) {
  std::vector<double> radii;
  for (const Record& record : records)
    for (const Stop& stop : record.line) radii.push_back(stop.radius);
  if (radii.empty()) return 0;
  const auto large = radii.begin() + static_cast<std::ptrdiff_t>((radii.size() - 1) * 97 / 100);
  std::nth_element(radii.begin(), large, radii.end());
  return *large;
}

Json nodes_json(const std::vector<SettledNode>& nodes, const Box& box, bool positions) {
  Json vertices = Json::array(), values = Json::array();
  std::vector<std::uint16_t> places;
  for (const SettledNode& node : nodes) {
    vertices.push_back(node.key.vertex.value());
    values.push_back(node.key.value);
    const Point place = place_of(node, positions);
    for (std::size_t k = 0; k < 3; ++k) places.push_back(in_65535ths(place[k], box.min[k], box.half_size));
  }
  return {{"vertex", std::move(vertices)}, {"value", std::move(values)}, {"place", base64(places)}};
}

Json arcs_json(const std::vector<Record>& records, const Box& box, double least, double half_range) {
  Json lo = Json::array(), hi = Json::array(), born = Json::array(), died = Json::array(), points = Json::array();
  std::vector<std::uint16_t> line, widths;
  const double widest = widest_radius(records);
  for (const auto& [arc, stops] : records) {
    lo.push_back(arc.lo);
    hi.push_back(arc.hi);
    born.push_back(arc.born);
    died.push_back(arc.died == kNeverDies ? Json() : Json(arc.died));
    points.push_back(stops.size() - 2);
    for (std::size_t i = 1; i + 1 < stops.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) line.push_back(in_65535ths(stops[i].position[k], box.min[k], box.half_size));
      line.push_back(in_65535ths(stops[i].value, least, half_range));
    }
    for (const Stop& stop : stops) widths.push_back(in_65535ths(stop.radius, 0, widest / 2));
  }
  return {{"lo", std::move(lo)},         {"hi", std::move(hi)},  {"born", std::move(born)}, {"died", std::move(died)},
          {"points", std::move(points)}, {"line", base64(line)}, {"width", base64(widths)}};
}

// A version is a level if the next cancellation is larger, since no threshold divides equal ones.
Json levels_json(const std::vector<VersionCounts>& versions, std::uint32_t finest) {
  Json version = Json::array(), threshold = Json::array(), nodes = Json::array(), arcs = Json::array();
  for (std::size_t i = 0; i < versions.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(finest + i);
    const double least = level_threshold(number, versions[i].persistence);
    if (i + 1 < versions.size() && level_threshold(number + 1, versions[i + 1].persistence) <= least) continue;
    version.push_back(number);
    threshold.push_back(least);
    nodes.push_back(versions[i].nodes);
    arcs.push_back(versions[i].arcs);
  }
  return {{"version", std::move(version)},
          {"threshold", std::move(threshold)},
          {"nodes", std::move(nodes)},
          {"arcs", std::move(arcs)}};
}

}  // namespace

Json skeleton_json(const ooc::ReebFile& file, std::uint32_t finest) {
  const FileHeader& header = file.header();
  const bool positions = header.flags.has_positions;
  std::vector<Record> records;
  const ooc::LevelHistory history = ooc::read_history(
      file.path(), finest,
      [&](const FileArc& arc, const SettledNode& lo, const SettledNode& hi, std::span<const Bucket> buckets) {
        records.push_back({arc, full_line(lo, hi, buckets, header)});
      });
  std::vector<std::uint32_t> isolated = history.isolated;
  const std::vector<SettledNode> nodes = needed_nodes(history.nodes, records, isolated);
  const Box box = box_of(nodes, records, positions);
  simplify_all(records, doubled(box.half_size));

  const double half_range = header.function_max / 2 - header.function_min / 2;
  return {{"positions", positions},
          {"box", {{"min", box.min}, {"size", doubled(box.half_size)}}},
          {"values", {{"min", header.function_min}, {"size", doubled(half_range)}}},
          {"nodes", nodes_json(nodes, box, positions)},
          {"arcs", arcs_json(records, box, header.function_min, half_range)},
          {"levels", levels_json(history.versions, finest)},
          {"isolated", isolated}};
}

}  // namespace reeb::tools
