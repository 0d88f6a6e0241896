#include "ooc/distributed/open_part_state.h"

#include <vector>

namespace reeb::ooc {
namespace {

// How nodes are stored: no padding.
struct NodeState {
  double value;
  std::uint64_t vertex;
  Point position;
  std::uint32_t first, last;
  std::uint64_t kind;  // 0: can be contracted, 1: settled, 2: other shares name it
};
static_assert(sizeof(NodeState) == 56);
static_assert(sizeof(BucketSum) == 80 && sizeof(Fragment::Arc) == 8 && sizeof(Fragment::SharedEdge) == 8);

enum Kind : std::uint64_t { kContractible = 0, kSettled = 1, kOpen = 2 };

}  // namespace

void write_open_part(StateWriter& out, const OpenPart& part) {
  const Fragment& live = part.live;
  out.put(std::uint64_t{live.nodes.size()});
  for (std::size_t n = 0; n < live.nodes.size(); ++n) {
    const Fragment::Node& node = live.nodes[n];
    out.put(NodeState{node.key.value, node.key.vertex.value(), live.positions[n], part.spans[n].first,
                      part.spans[n].last,
                      node.uses != kUsedHereOnly ? kOpen
                      : node.settled             ? kSettled
                                                 : kContractible});
  }
  out.put_array(live.arcs);
  out.put_array(live.edges);
  out.put_array(live.path_begin);
  out.put_array(live.path_arcs);
  out.put(std::uint64_t{live.options.bucket_exponent.has_value()});
  if (!live.options.bucket_exponent) return;
  out.put(std::int64_t{*live.options.bucket_exponent});
  out.put_array(live.bucket_begin);
  out.put_array(live.buckets);
}

void read_open_part(StateReader& in, std::uint32_t parts, OpenPart& part) {
  Fragment& live = part.live;
  live.clear();
  const auto nodes = in.get<std::uint64_t>();
  if (nodes > in.left() / sizeof(NodeState)) throw DamagedState();
  live.nodes.reserve(static_cast<std::size_t>(nodes));
  live.positions.reserve(static_cast<std::size_t>(nodes));
  part.spans.clear();
  part.spans.reserve(static_cast<std::size_t>(nodes));
  for (std::uint64_t n = 0; n < nodes; ++n) {
    const auto state = in.get<NodeState>();
    if (state.kind > kOpen) throw DamagedState();
    live.nodes.push_back({{state.value, VertexId(state.vertex)},
                          static_cast<std::uint8_t>(state.kind == kOpen ? kUsedLater : kUsedHereOnly),
                          state.kind == kSettled});
    live.positions.push_back(state.position);
    part.spans.push_back({state.first, state.last});
  }
  in.get_array(live.arcs);
  in.get_array(live.edges);
  in.get_array(live.path_begin);
  in.get_array(live.path_arcs);
  const auto embeds = in.get<std::uint64_t>();
  if (embeds > 1) throw DamagedState();
  if (embeds == 1) {
    const auto exponent = in.get<std::int64_t>();
    if (exponent < -4096 || exponent > 4096) throw DamagedState();
    live.options.bucket_exponent = static_cast<int>(exponent);
    in.get_array(live.bucket_begin);
    in.get_array(live.buckets);
  }
  check_open_part(part, parts);
}

}  // namespace reeb::ooc
