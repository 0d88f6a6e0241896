#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>

#include "io/export/graph_lines.h"
#include "io/export/line_points.h"
#include "io/text/base64_encoder.h"
#include "io/text/json_text.h"

namespace reeb::io {
namespace {

struct Box {
  std::array<double, 3> min, max;
};

// The box of all points that visit_points() passes on.
template <class VisitPoints>
Box box_of(const VisitPoints& visit_points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  visit_points([&](const std::array<double, 3>& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], point[axis]);
      box.max[axis] = std::max(box.max[axis], point[axis]);
    }
  });
  return box;
}

// The point as it is written. A coordinate beyond the floats is the largest of them: JSON has no infinities.
std::array<float, 3> relative(const std::array<double, 3>& point, const std::array<double, 3>& origin) {
  std::array<float, 3> result;
  constexpr double kMost = std::numeric_limits<float>::max();
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = static_cast<float>(std::clamp(point[axis] - origin[axis], -kMost, kMost));
  return result;
}

void write_float_point(const std::array<float, 3>& point, OutputBuffer& out) {
  write_json_point({point[0], point[1], point[2]}, out);
}

}  // namespace

// Two primitives of one mesh: all lines by index, and the nodes as points.
void write_gltf_lines(const GraphView& view, OutputBuffer& out) {
  const std::uint64_t nodes = view.graph.node_count(), points = all_points(view);
  require_few_points(points, kMostGltfPoints, "glTF");
  out << "{\"asset\": {\"version\": \"2.0\", \"generator\": \"reeb\"}, \"scene\": 0, \"scenes\": [{";
  if (nodes == 0) {
    out << "}]}\n";
    return;
  }
  std::uint64_t segments = 0;
  for_each_segment(view, [&](std::uint64_t, std::uint64_t) { ++segments; });
  const Box box = box_of([&](const auto& visit) { for_each_point(view, visit); });
  std::array<double, 3> origin;
  for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] = box.min[axis] + (box.max[axis] / 2 - box.min[axis] / 2);

  const std::uint64_t point_bytes = 12 * points, segment_bytes = 8 * segments;
  out << "\"nodes\": [0]}],\n\"nodes\": [{\"name\": \"Reeb graph\", \"mesh\": 0, \"translation\": ";
  write_json_point(origin, out);
  out << "}],\n\"meshes\": [{\"primitives\": [";
  if (segments != 0) out << "{\"attributes\": {\"POSITION\": 0}, \"indices\": 2, \"mode\": 1}, ";
  out << "{\"attributes\": {\"POSITION\": 1}, \"mode\": 0}]}],\n\"accessors\": [";
  const auto write_accessor = [&](std::uint64_t count, const Box& bounds) {
    out << "{\"bufferView\": 0, \"componentType\": 5126, \"count\": " << count << ", \"type\": \"VEC3\", \"min\": ";
    write_float_point(relative(bounds.min, origin), out);
    out << ", \"max\": ";
    write_float_point(relative(bounds.max, origin), out);
    out << '}';
  };
  write_accessor(points, box);
  out << ", ";
  write_accessor(nodes, box_of([&](const auto& visit) { for_each_node_point(view, visit); }));
  if (segments != 0)
    out << ", {\"bufferView\": 1, \"componentType\": 5125, \"count\": " << 2 * segments << ", \"type\": \"SCALAR\"}";
  out << "],\n\"bufferViews\": [{\"buffer\": 0, \"byteLength\": " << point_bytes << ", \"target\": 34962}";
  if (segments != 0)
    out << ", {\"buffer\": 0, \"byteOffset\": " << point_bytes << ", \"byteLength\": " << segment_bytes
        << ", \"target\": 34963}";
  out << "],\n\"buffers\": [{\"byteLength\": " << point_bytes + segment_bytes
      << ", \"uri\": \"data:application/octet-stream;base64,";
  Base64Encoder data([&](std::string_view digits) { out << digits; });
  const auto put = [&](std::uint32_t word) {  // little endian
    for (unsigned shift = 0; shift < 32; shift += 8) data.put(static_cast<std::uint8_t>(word >> shift));
  };
  for_each_point(view, [&](const auto& point) {
    for (const float coordinate : relative(point, origin)) put(std::bit_cast<std::uint32_t>(coordinate));
  });
  for_each_segment(view, [&](std::uint64_t a, std::uint64_t b) {
    put(static_cast<std::uint32_t>(a));
    put(static_cast<std::uint32_t>(b));
  });
  data.finish();
  out << "\"}]}\n";
}

}  // namespace reeb::io
