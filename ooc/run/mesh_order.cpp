#include "ooc/run/mesh_order.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/coherence.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/run/stopwatch.h"
#include "ooc/whole_mesh/mesh_pieces.h"
#include "ooc/whole_mesh/piece_order.h"
#include "ooc/whole_mesh/reorder.h"

namespace reeb::ooc {
namespace {

using Phase = ComputeProgress::Phase;

constexpr std::uint64_t kUnknown = ~std::uint64_t{0};

// The front of a sorted mesh, in square roots of its vertices, is hardly ever smaller.
constexpr double kSortedFront = 2;
// Along a Hilbert curve it is rarely larger.
constexpr double kHilbertFront = 14;
// A front of this share of the vertices costs less time than sorting.
constexpr std::uint64_t kQuickShare = 8;
// Of this share, less than finding pieces; up to this front, whose graph takes some 90 MB where memory is free.
constexpr std::uint64_t kQuickerShare = 64, kMostOfShare = 131072;
// Of a budget that is free, for the list of pieces.
constexpr std::uint64_t kPiecesShare = 4, kPieceBytes = 48;

std::uint64_t value_bytes(const RunContext& run, std::uint64_t vertices) {
  std::uint64_t bytes = 0;
  for (const VertexFunction* function : run.functions) bytes += function->lookup_bytes(vertices);
  return bytes;
}

// The mesh in pieces, in another order.
struct Tried {
  std::unique_ptr<PiecewiseMesh> mesh;
  std::size_t pieces;
  LastUse uses;
};

class Ordering {
 public:
  Ordering(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh> mesh, const Checkpoint* start,
           bool use_sidecar)
      : run_(run),
        input_(input),
        start_(start),
        use_sidecar_(use_sidecar),
        vertices_(mesh->vertex_count()),
        mesh_(std::move(mesh)) {}

  OrderedMesh run() {
    if (start_ != nullptr)
      order_as_before();
    else
      choose();
    const MemoryPlan plan = plan_for(needs(uses_->summary(), order_bytes_));
    return {.mesh = std::move(mesh_),
            .origin = origin_,
            .uses = std::move(*uses_),
            .of_sidecar = of_sidecar_ && origin_ == ChunkOrigin::kLookedUp,
            .plan = plan,
            .spilled_bytes = spilled_bytes_,
            .seconds = seconds_,
            .notes = std::move(notes_)};
  }

 private:
  void order_as_before() {
    origin_ = start_->origin;
    if (origin_ == ChunkOrigin::kPieces)
      if (auto tried = try_pieces(~std::uint64_t{0})) adopt(std::move(*tried));
    if (is_sorted()) sort_on_disk();
    if (!uses_) find_last_uses(false);
  }

  void choose() {
    find_last_uses(true);
    if (uses_ && suits(uses_->summary())) return;
    const std::uint64_t front = uses_ ? uses_->summary().max_live_vertices : kUnknown;
    if (auto tried = try_pieces(run_.budget.free_bytes() / kPiecesShare / kPieceBytes)) {
      const UseSummary& summary = tried->uses.summary();
      const std::uint64_t bytes = tried->mesh->memory_bytes();
      const bool suffices = !run_.options.may_reorder || suits(summary, bytes) || is_quick(summary, bytes);
      if (summary.max_live_vertices < front && suffices) return adopt(std::move(*tried));
      mesh_ = tried->mesh->release();
    }
    if (uses_ && (is_quick(uses_->summary()) || !sorting_helps(front))) return;
    if (!run_.options.may_reorder) {
      if (!uses_) find_last_uses(false);
      return;
    }
    uses_.reset();
    choose_sorting();
    sort_on_disk();
  }

  // ---- the order of the mesh

  // Finds nothing if it may give up, and the mesh is so incoherent that it will be glued in another order.
  void find_last_uses(bool may_give_up) {
    const Stopwatch watch;
    uses_ = known_or_scanned(may_give_up);
    seconds_.finalization += watch.seconds();
    if (uses_) spilled_bytes_ += uses_->spilled_bytes();
  }

  // Takes the last uses from the sidecar if there is one that fits, and if it may be used; else from scan().
  std::optional<LastUse> known_or_scanned(bool may_give_up) {
    const std::string sidecar = sidecar_path(run_, input_);
    if (sidecar.empty()) return scan(*mesh_, may_give_up);
    const MeshIdentity identity = identify_mesh(input_.path);
    SidecarLoad known;
    if (use_sidecar_)
      known = load_sidecar(sidecar, identity, mesh_->vertex_count(), run_.temp, run_.budget, run_.plan.table_bytes);
    of_sidecar_ = known.uses && can_start(known.uses->summary()) && !run_.plan.exceeds(needs(known.uses->summary()));
    if (of_sidecar_) return std::move(known.uses);
    if (!known.note.empty()) notes_.push_back(known.note);
    known.uses.reset();
    std::optional<LastUse> uses = scan(*mesh_, may_give_up && !run_.options.keep_sidecar);
    if (uses && run_.options.keep_sidecar) {
      run_.check_inputs();
      save_sidecar(sidecar, identity, *uses);
    }
    return uses;
  }

  // Whether the place to resume from is at the end of a block.
  bool can_start(const UseSummary& summary) const {
    if (start_ == nullptr) return true;
    const std::uint64_t triangles = start_->place.triangles;
    return triangles == summary.triangle_count || triangles % summary.block_triangles == 0;
  }

  std::optional<LastUse> scan(IndexedMesh& mesh, bool may_give_up) {
    LastUseOptions options = scan_options(may_give_up);
    options.progress = [this, &mesh](std::uint64_t bytes_read) { tell(bytes_read, mesh.bytes_total()); };
    std::optional<LastUse> uses = scan_last_use(mesh, run_.temp, run_.budget, options);
    if (uses) check_blocks(*uses);
    return uses;
  }

  LastUseOptions scan_options(bool may_give_up) const {
    LastUseOptions options;
    options.allowance_bytes = run_.plan.table_bytes;
    if (may_give_up) {
      options.give_up_when_incoherent = true;
      options.most_live_vertices = largest_front();
    }
    // A chunk is whole blocks, so small chunks need small blocks.
    options.block_triangles = std::min<std::uint64_t>(options.block_triangles, run_.plan.chunk.first);
    if (start_ != nullptr) options.block_triangles = start_->block_triangles;
    options.threads = run_.plan.threads;
    return options;
  }

  void check_blocks(const LastUse& uses) const {
    if (start_ != nullptr && !has_usual_blocks(uses.summary())) throw DamagedState();
  }

  // ---- pieces in another order

  // Takes the mesh, unless it returns nothing.
  std::optional<Tried> try_pieces(std::uint64_t most_pieces) {
    const Stopwatch watch;
    PieceOptions options;
    options.coordinates = input_.dimension;
    options.most_pieces = most_pieces;
    options.progress = [this](std::uint64_t bytes_read) { tell(bytes_read, mesh_->bytes_total()); };
    std::optional<Tried> tried;
    if (std::optional<MeshPieces> pieces = cut_into_pieces(*mesh_, run_.budget, options)) {
      order_pieces(*pieces);
      count_simplices();
      const std::size_t count = pieces->pieces.size();
      auto mesh = std::make_unique<PiecewiseMesh>(std::move(mesh_), std::move(*pieces));
      LastUse uses = std::move(*scan(*mesh, false));
      spilled_bytes_ += uses.spilled_bytes();
      tried = Tried{std::move(mesh), count, std::move(uses)};
    }
    seconds_.finalization += watch.seconds();
    return tried;
  }

  void adopt(Tried tried) {
    notes_.push_back("the mesh consists of " + count_of(tried.pieces, "piece") + ", read in another order");
    order_bytes_ = tried.mesh->memory_bytes();
    mesh_ = std::move(tried.mesh);
    uses_ = std::move(tried.uses);
    origin_ = ChunkOrigin::kPieces;
  }

  // Only a mesh that was read from the first simplex to the last knows how many it has. It was not if its last uses
  // come from a sidecar, or if the run is resumed.
  void count_simplices() {
    constexpr std::size_t kTrianglesAtOnce = 16384;
    if (mesh_->simplex_counts() != SimplexCounts{}) return;
    mesh_->rewind();
    for (std::vector<VertexId> corners; mesh_->read(corners, kTrianglesAtOnce);)
      tell(mesh_->bytes_read(), mesh_->bytes_total());
  }

  // ---- sorted on disk

  bool is_sorted() const { return origin_ == ChunkOrigin::kSorted || origin_ == ChunkOrigin::kSortedInSlabs; }

  // A long sort must not be in vain.
  // THROWS: Error{kResource} if the live graphs cannot fit afterwards.
  void choose_sorting() {
    FrontNeeds front = needs(vertices_, sorted_front(kSortedFront));
    plan_for(front);
    front.live_vertices = sorted_front(kHilbertFront);
    origin_ = run_.plan.fits(front) ? ChunkOrigin::kSorted : ChunkOrigin::kSortedInSlabs;
  }

  void sort_on_disk() {
    constexpr std::uint64_t kSortBytesLimit = 64u << 20;
    const Stopwatch watch;
    auto [sorted, uses] = reorder_with_last_uses(
        *mesh_, run_.temp, run_.budget,
        {.allowance_bytes = std::min<std::uint64_t>(run_.budget.free_bytes() / 2, kSortBytesLimit),
         .coordinates = std::min(input_.dimension, 3u),
         .threads = run_.threads,
         .in_slabs = origin_ == ChunkOrigin::kSortedInSlabs,
         .progress = [this](double done) { tell_sorting(done); }},
        scan_options(/*may_give_up=*/false));
    check_blocks(uses);
    notes_.push_back("neighbouring triangles lie far apart in this file, so they were sorted on disk first");
    spilled_bytes_ += sorted->spilled_bytes();
    for (const std::string& warning : mesh_->warnings()) notes_.push_back(warning);
    mesh_ = std::move(sorted);
    uses_ = std::move(uses);
    spilled_bytes_ += uses_->spilled_bytes();
    seconds_.reorder += watch.seconds();
  }

  // ---- fronts and memory

  FrontNeeds needs(std::uint64_t vertices, std::uint64_t live_vertices, std::uint64_t order_bytes = 0) const {
    return {.vertices = vertices,
            .live_vertices = live_vertices,
            .function_bytes = value_bytes(run_, vertices),
            .order_bytes = order_bytes};
  }
  FrontNeeds needs(const UseSummary& summary, std::uint64_t order_bytes = 0) const {
    return needs(summary.vertex_count, summary.max_live_vertices, order_bytes);
  }

  std::uint64_t sorted_front(double square_roots) const {
    return static_cast<std::uint64_t>(square_roots * std::sqrt(static_cast<double>(vertices_)));
  }

  // A front that is glued as quickly as pieces are found.
  std::uint64_t quick_front(std::uint64_t most_triangles) const {
    return std::max(std::min(vertices_ / kQuickerShare, kMostOfShare), usual_front(vertices_, most_triangles));
  }

  // No larger front than this suits.
  std::uint64_t largest_front() const {
    return std::max(sorted_front(kSortedFront),
                    std::min(run_.plan.most_live_vertices(), quick_front(run_.plan.chunk.most)));
  }

  // Whether another order could hardly be better.
  bool suits(const UseSummary& summary, std::uint64_t order_bytes = 0) const {
    const FrontNeeds front = needs(summary, order_bytes);
    if (!run_.plan.fits(front)) return !sorting_helps(front.live_vertices);
    MemoryPlan plan = run_.plan;
    plan.share_out(front);
    return front.live_vertices <= quick_front(plan.chunk.most);
  }

  // Whether the mesh can be glued in less time than sorting it takes.
  bool is_quick(const UseSummary& summary, std::uint64_t order_bytes = 0) const {
    return run_.plan.fits(needs(summary, order_bytes)) &&
           summary.max_live_vertices <= summary.vertex_count / kQuickShare;
  }

  bool sorting_helps(std::uint64_t front) const { return front > sorted_front(kSortedFront); }

  // The plan with a known front: chunks get what the live graphs leave.
  // THROWS: Error{kResource} if the live graphs cannot fit.
  MemoryPlan plan_for(const FrontNeeds& front) const {
    MemoryPlan plan = run_.plan;
    if (plan.exceeds(front)) {
      const std::string megabytes = std::to_string((plan.needed_bytes(front) >> 20) + 1) + "M";
      throw Error(ErrorKind::kResource,
                  count_of(front.live_vertices, "vertex") + " are live at once, and their graph will not fit " +
                      format_bytes(plan.set_aside_bytes + plan.budget_bytes) + " of memory",
                  "allow --memory " + megabytes +
                      (run_.options.may_reorder ? "" : ", or let the triangles be sorted (without --no-reorder)"))
          .because(ErrorCause::kMemory);
    }
    plan.share_out(front);
    return plan;
  }

  void tell(std::uint64_t bytes_read, std::uint64_t total) const {
    run_.tell({Phase::kFinalization, bytes_read, total});
  }
  void tell_sorting(double done) const {
    constexpr std::uint64_t kSteps = 10000;
    run_.tell({Phase::kReorder, static_cast<std::uint64_t>(done * kSteps), kSteps});
  }

  RunContext& run_;
  const MeshInput& input_;
  const Checkpoint* start_;
  bool use_sidecar_, of_sidecar_ = false;
  std::uint64_t vertices_;
  std::unique_ptr<IndexedMesh> mesh_;  // null while it is in pieces that are tried
  ChunkOrigin origin_ = ChunkOrigin::kLookedUp;
  std::optional<LastUse> uses_;
  std::uint64_t order_bytes_ = 0;
  std::uint64_t spilled_bytes_ = 0;
  PhaseSeconds seconds_;
  std::vector<std::string> notes_;
};

}  // namespace

OrderedMesh order_mesh(RunContext& run, const MeshInput& input, std::unique_ptr<IndexedMesh> mesh,
                       const Checkpoint* start, bool use_sidecar) {
  return Ordering(run, input, std::move(mesh), start, use_sidecar).run();
}

Reservation prepare_values(RunContext& run, std::uint64_t vertices) {
  Reservation reservation = run.budget.reserve("function values", value_bytes(run, vertices));
  for (VertexFunction* function : run.functions) function->check_count(vertices);
  return reservation;
}

std::string sidecar_path(const RunContext& run, const MeshInput& input) {
  const bool has_file = !input.path.empty() && input.path != "-" && run.options.chunk_triangles == 0;
  return has_file ? input.path + ".final" : "";
}

}  // namespace reeb::ooc
