#include "ooc/stored_hierarchy/stored_hierarchy.h"

#include <algorithm>
#include <string>
#include <utility>

#include "libreeb/base/work.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/bucket_versions.h"
#include "libreeb/hierarchy/canceller.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kAtOnce = 4096;  // records that are read

// Per node and per arc in the tables of a Canceller, and per arc in StoredLists.
constexpr std::size_t kNodeBytes = 16 + 8 + 4 + 4, kArcBytes = 32 + 4, kListBytes = 16;
// Bytes per node for KeptIds of nodes and arcs; while nodes are paired; and after that, for the canceller's bits and
// exits.
constexpr std::uint64_t kIdBytes = 1, kPairingBytes = 16, kCancellingBytes = 1;
constexpr std::uint64_t kLeastSort = 512 << 10, kSlack = 512 << 10;

// Rows are dropped when one in so many is no longer needed.
constexpr std::uint64_t kDropShare = 5;

// The nodes as buckets know them.
class PagedNodes {
 public:
  explicit PagedNodes(StoredNodes& nodes) : nodes_(&nodes) {}
  double value(NodeId node) const { return nodes_->key(node).value; }
  Point position(NodeId node) const { return nodes_->position(node); }
  void prefetch(NodeId /*node*/) const {}

 private:
  StoredNodes* nodes_;
};

}  // namespace

std::uint64_t StoredHierarchy::least_bytes(std::uint64_t nodes) {
  return 4 * kLeastSort + 3 * PagedRows::kLeastBytes + kSlack + (kIdBytes + kPairingBytes) * nodes;
}

StoredHierarchy::Shares StoredHierarchy::share_out(std::uint64_t free, std::uint64_t nodes, bool embeds) {
  Shares shares;
  shares.sort = std::clamp<std::uint64_t>(free / 16, kLeastSort, 8 << 20);
  shares.nodes = std::max(free / (embeds ? 6 : 24), PagedRows::kLeastBytes);
  // More is allowed after pairing.
  const std::uint64_t taken = 2 * shares.sort + shares.nodes + (kIdBytes + kPairingBytes) * nodes + kSlack;
  shares.tables = free - std::min(free, taken);
  return shares;
}

StoredHierarchy::StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget,
                                 const Options& options)
    : StoredHierarchy(store, temp, budget, options,
                      share_out(budget.free_bytes(), store.node_count(), options.bucket_exponent.has_value())) {}

StoredHierarchy::StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget,
                                 const Options& options, const Shares& shares)
    : store_(store),
      temp_(temp),
      budget_(budget),
      options_(options),
      shares_(shares),
      nodes_(static_cast<std::uint32_t>(store.node_count())),
      arcs_(static_cast<std::uint32_t>(store.arc_count())),
      tables_(std::in_place, temp, budget, shares.tables, PagedTables::Size{nodes_, kNodeBytes},
              PagedTables::Size{arcs_, kArcBytes + (options.bucket_exponent ? kListBytes : 0)}),
      node_data_(temp, budget, nodes_, shares.nodes),
      pairs_("pairs", temp, budget, sort_options()) {}

void StoredHierarchy::pair_nodes(const Poll& poll) {
  read_nodes();
  SortedByUpperEnd arcs("arcs", temp_, budget_, sort_options());
  graph_.emplace(nodes_, arcs_, *tables_);
  if (options_.bucket_exponent) lists_.emplace(temp_, *tables_, arcs_);
  sort_arcs(arcs, part_of(poll, 0, 0.5));
  pair_arcs(arcs, part_of(poll, 0.5, 1));
  spilled_ += arcs.spilled_bytes();
  pairs_.finish();
  kept_.resize(pairs_.size());
  store_.set_aside();
  // What pairing and the store took goes to the tables, but for what cancelling takes.
  const std::uint64_t free = budget_.free_bytes();
  const std::uint64_t taken = sizeof(double) * pairs_.size() + kCancellingBytes * nodes_ + kSlack;
  tables_->allow(tables_->resident_bytes() + free - std::min(free, taken));
}

void StoredHierarchy::read_nodes() {
  store_.rewind_nodes();
  std::uint32_t rank = 0;
  for (std::vector<SettledNode> some; store_.read_nodes(some, kAtOnce);)
    for (const SettledNode& node : some) node_data_.set(NodeId(rank++), node);
}

// Arcs come by lower end, as their numbers are. So the ranks of these ends are found in passing.
void StoredHierarchy::sort_arcs(SortedByUpperEnd& arcs, const Poll& poll) {
  store_.rewind_arcs();
  std::uint32_t lo = 0, arc = 0;
  for (ArcPiece piece; store_.read_arcs(piece, kAtOnce, options_.bucket_exponent);) {
    if (poll) poll(static_cast<double>(arc) / arcs_);
    for (std::size_t i = 0; i < piece.arcs.size(); ++i) {
      const ArcKeys& keys = piece.arcs[i];
      while (lo < nodes_ && key(NodeId(lo)) < keys.lo) ++lo;
      if (lo == nodes_ || key(NodeId(lo)) != keys.lo)
        throw BrokenGraph("an arc begins in vertex " + std::to_string(keys.lo.vertex.value()) +
                          ", which is not a node");
      arcs.add({keys.hi, lo, arc});
      if (lists_) lists_->replace(arc, piece.lists.view().of(i));
      ++arc;
    }
  }
  arcs.finish();
}

void StoredHierarchy::pair_arcs(SortedByUpperEnd& arcs, const Poll& poll) {
  const Reservation memory = budget_.reserve("pairing", kPairingBytes * nodes_);
  const auto take = [this](const PersistencePair& pair) { add_pair(pair); };
  UpSweep up(nodes_);
  std::uint32_t hi = 0, done = 0;
  // The arcs of a node still come in the order of their numbers, both those above it and those below it.
  for (std::vector<ArcToSort> some; arcs.read(some, kAtOnce);) {
    if (poll) poll(static_cast<double>(done) / arcs_ * 0.8);
    for (const ArcToSort& arc : some) {
      while (hi < nodes_ && key(NodeId(hi)) < arc.hi) ++hi;
      if (hi == nodes_ || key(NodeId(hi)) != arc.hi)
        throw BrokenGraph("an arc ends in vertex " + std::to_string(arc.hi.vertex.value()) + ", which is not a node");
      graph_->put(ArcId(arc.arc), NodeId(arc.lo), NodeId(hi));
      up.add(arc.lo, hi, take);
      ++done;
    }
  }
  if (poll) poll(0.8);
  DownSweep down(nodes_);
  const auto& graph = std::as_const(*graph_);
  for (std::uint32_t arc = arcs_; arc-- > 0;) down.add(graph.end(ArcId(arc), kDown), graph.end(ArcId(arc), kUp), take);
  pair_components(nodes_, up, down, take);
  for (NodeId node; node < NodeId(nodes_); ++node)
    if (graph.nearest(node, kDown) == ArcId::none() && graph.nearest(node, kUp) == ArcId::none())
      isolated_.push_back(node);
}

void StoredHierarchy::add_pair(const PersistencePair& pair) {
  pairs_.add({key(pair.hi).value - key(pair.lo).value, pair});
}

void StoredHierarchy::rewind_pairs() {
  cursor_.rewind(pairs_);
  pair_ = 0;
}

bool StoredHierarchy::next_ranked(RankedPair& ranked) {
  if (!cursor_.next(pairs_, ranked)) return false;
  ranked.pair.kept = kept_[pair_++];
  return true;
}

bool StoredHierarchy::next_pair(PersistencePair& pair) {
  RankedPair ranked{};
  if (!next_ranked(ranked)) return false;
  pair = ranked.pair;
  return true;
}

bool StoredHierarchy::cancel(RecordSink& records, const Poll& poll) {
  steps_charge_ = budget_.reserve("steps", sizeof(double) * pairs_.size());
  persistence_.reserve(pairs_.size());
  bool done = false;
  if (lists_) {
    BucketVersions content(PagedNodes(node_data_), std::move(*lists_), *options_.bucket_exponent, records);
    Canceller canceller(std::move(*graph_), records, std::move(content));
    done = cancel_all(canceller, poll);
    spilled_ += canceller.content().lists().packed().spilled_bytes();
  } else {
    Canceller canceller(std::move(*graph_), records, IgnoreContent());
    done = cancel_all(canceller, poll);
  }
  refetches_ = tables_->refetches();
  spilled_ += tables_->spilled_bytes();
  lists_.reset();
  graph_.reset();
  tables_.reset();
  introduced_.emplace(temp_, budget_, sort_options());
  return done;
}

template <class Canceller>
bool StoredHierarchy::cancel_all(Canceller& canceller, const Poll& poll) {
  constexpr std::uint64_t kPairsBetweenPolls = 1024;
  rewind_pairs();
  std::uint64_t next_drop = steps_between_drops();
  for (RankedPair ranked{}; next_ranked(ranked);) {
    if (ranked.pair.type == PairType::kExt0) break;
    if (pair_ % kPairsBetweenPolls == 0) {
      if (poll) poll(static_cast<double>(pair_) / static_cast<double>(pairs_.size()));
      refetches_ = tables_->refetches();
      if (refetches_ > options_.most_pages * (pair_ + kPairsBetweenPolls)) return false;
    }
    const bool done = canceller.cancel(ranked.pair);
    kept_[pair_ - 1] = !done;
    if (done) persistence_.push_back(ranked.persistence);
    if (persistence_.size() == next_drop) next_drop += drop_rows(canceller.graph());
  }
  canceller.finish();
  return true;
}

// A step takes two nodes and at least two arcs away.
std::uint64_t StoredHierarchy::steps_between_drops() const {
  return std::max<std::uint64_t>(tables_->nodes().count() / 2 / kDropShare, 1);
}

// Drops the rows of what is no longer in the graph, unless memory holds all rows. Returns the number of steps until it
// is to be called again.
template <class Graph>
std::uint64_t StoredHierarchy::drop_rows(const Graph& graph) {
  if (tables_->nodes().fits_in_memory() && tables_->arcs().fits_in_memory()) return pairs_.size();
  tables_->nodes().keep_if([&](std::uint32_t id) {
    return graph.nearest(NodeId(id), kDown) != ArcId::none() || graph.nearest(NodeId(id), kUp) != ArcId::none();
  });
  tables_->arcs().keep_if([&](std::uint32_t id) { return graph.alive(ArcId(id)); });
  return steps_between_drops();
}

std::uint64_t StoredHierarchy::spilled_bytes() const {
  return spilled_ + pairs_.spilled_bytes() + node_data_.spilled_bytes() +
         (introduced_ ? introduced_->spilled_bytes() : 0);
}

}  // namespace reeb::ooc
