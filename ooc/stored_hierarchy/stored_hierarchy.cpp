#include "ooc/stored_hierarchy/stored_hierarchy.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "libreeb/hierarchy/bucket_versions.h"
#include "libreeb/hierarchy/canceller.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kAtOnce = 4096;  // records that are read

// Per node and per arc in the tables of a Canceller, and per arc in StoredLists.
constexpr std::uint64_t kNodeBytes = 16 + 8 + 4 + 4, kArcBytes = 32 + 4, kListBytes = 16;
// While nodes are paired; and after that, for the canceller's bits and exits.
constexpr std::uint64_t kPairingBytes = 16, kCancellingBytes = 2;
constexpr std::uint64_t kLeastSort = 512 << 10, kLeastTable = PageCache::kRequiredFrames * PageCache::kPageBytes;
constexpr std::uint64_t kTables = 9;  // with those of nodes

// The nodes as buckets know them.
class PagedNodes {
 public:
  PagedNodes(PagedTable<SweepKey>& keys, PagedTable<Point>& positions) : keys_(&keys), positions_(&positions) {}
  double value(NodeId node) const { return keys_->get(node.value()).value; }
  Point position(NodeId node) const { return positions_->get(node.value()); }
  void prefetch(NodeId /*node*/) const {}

 private:
  PagedTable<SweepKey>* keys_;
  PagedTable<Point>* positions_;
};

}  // namespace

std::uint64_t StoredHierarchy::least_bytes(std::uint64_t nodes) {
  return 4 * kLeastSort + kTables * kLeastTable + (kPairingBytes + kCancellingBytes) * nodes;
}

StoredHierarchy::Shares StoredHierarchy::share_out(std::uint64_t free, std::uint64_t nodes, std::uint64_t arcs,
                                                   bool embeds) {
  Shares shares;
  shares.sort = std::clamp<std::uint64_t>(free / 16, kLeastSort, 8 << 20);
  shares.positions = std::max(free / (embeds ? 16 : 64), kLeastTable);
  shares.keys = std::max(free / (embeds ? 8 : 32), kLeastTable);
  shares.all_tables = kNodeBytes * nodes + (kArcBytes + (embeds ? kListBytes : 0)) * arcs;
  const std::uint64_t fixed =
      2 * shares.sort + shares.keys + shares.positions + kTables * kLeastTable + kCancellingBytes * nodes;
  const auto room = [&](std::uint64_t taken) { return free - std::min(free, taken); };
  // Two thirds of the tables are filled while nodes are paired, or a little more.
  shares.tables = std::min(room(fixed), room(fixed + kPairingBytes * nodes) / 2 * 3);
  return shares;
}

StoredHierarchy::StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget,
                                 const Options& options)
    : StoredHierarchy(
          store, temp, budget, options,
          share_out(budget.free_bytes(), store.node_count(), store.arc_count(), options.bucket_exponent.has_value())) {}

StoredHierarchy::StoredHierarchy(SegmentStore& store, const io::TempDir& temp, MemoryBudget& budget,
                                 const Options& options, const Shares& shares)
    : store_(store),
      temp_(temp),
      budget_(budget),
      options_(options),
      shares_(shares),
      nodes_(static_cast<std::uint32_t>(store.node_count())),
      arcs_(static_cast<std::uint32_t>(store.arc_count())),
      tables_(temp, budget, shares.tables, shares.all_tables),
      keys_("keys of nodes", temp, budget, shares.keys, SweepKey{}),
      positions_("positions of nodes", temp, budget, shares.positions, Point{}),
      pairs_("pairs", temp, budget, {.allowance_bytes = shares.sort, .background = options.background}) {}

void StoredHierarchy::pair_nodes(const Poll& poll) {
  read_nodes();
  SortedByUpperEnd arcs("arcs", temp_, budget_, {.allowance_bytes = shares_.sort, .background = options_.background});
  graph_.emplace(nodes_, arcs_, tables_);
  if (options_.bucket_exponent) lists_.emplace(temp_, tables_, arcs_);
  sort_arcs(arcs, part_of(poll, 0, 0.5));
  pair_arcs(arcs, part_of(poll, 0.5, 1));
  spilled_ += arcs.spilled_bytes();
  pairs_.finish();
  kept_.resize(pairs_.size());
  // What pairing took goes to the tables, but for what cancelling takes.
  const std::uint64_t free = budget_.free_bytes();
  const std::uint64_t taken = sizeof(double) * pairs_.size() + kCancellingBytes * nodes_ + (kTables + 1) * kLeastTable;
  tables_.allow(tables_.resident_bytes() + free - std::min(free, taken));
}

void StoredHierarchy::read_nodes() {
  store_.rewind_nodes();
  std::uint64_t rank = 0;
  for (std::vector<SettledNode> some; store_.read_nodes(some, kAtOnce);)
    for (const SettledNode& node : some) {
      keys_.set(rank, node.key);
      positions_.set(rank++, node.position);
    }
}

// Arcs come by lower end, as their numbers are. So the ranks of these ends are found in passing.
void StoredHierarchy::sort_arcs(SortedByUpperEnd& arcs, const Poll& poll) {
  store_.rewind_arcs();
  std::uint32_t lo = 0, arc = 0;
  for (PackedArcPiece piece; store_.read_arcs(piece, kAtOnce, options_.bucket_exponent);) {
    if (poll) poll(static_cast<double>(arc) / arcs_);
    for (const StoredArc& stored : piece.records) {
      while (lo < nodes_ && keys_.get(lo) < stored.keys.lo) ++lo;
      if (lo == nodes_ || keys_.get(lo) != stored.keys.lo)
        throw std::logic_error("an arc begins in vertex " + std::to_string(stored.keys.lo.vertex.value()) +
                               ", which is no node");
      arcs.add({stored.keys.hi, lo, arc});
      if (lists_) lists_->replace(arc, piece.payload(stored));
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
      while (hi < nodes_ && keys_.get(hi) < arc.hi) ++hi;
      if (hi == nodes_ || keys_.get(hi) != arc.hi)
        throw std::logic_error("an arc ends in vertex " + std::to_string(arc.hi.vertex.value()) + ", which is no node");
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
  pairs_.add({keys_.get(pair.hi.value()).value - keys_.get(pair.lo.value()).value, pair});
}

void StoredHierarchy::rewind_pairs() {
  pairs_.rewind();
  batch_.clear();
  at_ = 0;
  pair_ = 0;
}

bool StoredHierarchy::next_ranked(RankedPair& ranked) {
  if (at_ == batch_.size()) {
    at_ = 0;
    if (!pairs_.read(batch_, kAtOnce)) return false;
  }
  ranked = batch_[at_++];
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
  if (!lists_) {
    Canceller canceller(std::move(*graph_), records, IgnoreContent());
    graph_.reset();
    return cancel_all(canceller, poll);
  }
  BucketVersions content(PagedNodes(keys_, positions_), std::move(*lists_), *options_.bucket_exponent, records);
  Canceller canceller(std::move(*graph_), records, std::move(content));
  graph_.reset();
  lists_.reset();
  const bool done = cancel_all(canceller, poll);
  spilled_ += canceller.content().lists().packed().spilled_bytes();
  return done;
}

template <class Canceller>
bool StoredHierarchy::cancel_all(Canceller& canceller, const Poll& poll) {
  constexpr std::uint64_t kPairsBetweenPolls = 1024;
  rewind_pairs();
  for (RankedPair ranked{}; next_ranked(ranked);) {
    if (ranked.pair.type == PairType::kExt0) break;
    if (pair_ % kPairsBetweenPolls == 0) {
      if (poll) poll(static_cast<double>(pair_) / static_cast<double>(pairs_.size()));
      refetches_ = tables_.refetches();
      if (refetches_ > options_.most_pages * (pair_ + kPairsBetweenPolls)) return false;
    }
    const bool done = canceller.cancel(ranked.pair);
    kept_[pair_ - 1] = !done;
    if (done) persistence_.push_back(ranked.persistence);
  }
  canceller.finish();
  refetches_ = tables_.refetches();
  spilled_ += tables_.spilled_bytes();
  return true;
}

std::uint64_t StoredHierarchy::spilled_bytes() const {
  return spilled_ + pairs_.spilled_bytes() + keys_.pages().spilled_bytes() + positions_.pages().spilled_bytes();
}

}  // namespace reeb::ooc
