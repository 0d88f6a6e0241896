#include "ooc/compute.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/hierarchy/cancel.h"
#include "ooc/graph_collector.h"
#include "ooc/last_use.h"
#include "ooc/last_use_sidecar.h"
#include "ooc/reeb_file_writer.h"
#include "ooc/spooled_mesh.h"
#include "ooc/temp_dir.h"

namespace reeb::ooc {
namespace {

using Clock = std::chrono::steady_clock;
using Phase = ComputeProgress::Phase;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Measures a scope.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += seconds_since(start_); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

class Run {
 public:
  Run(MeshInput input, std::span<VertexFunction* const> functions, std::span<const std::string> outputs,
      const ComputeOptions& options)
      : functions_(functions),
        outputs_(outputs),
        options_(options),
        budget_(options.memory_bytes),
        temp_(options.temp_dir.empty() ? TempDir::default_folder(outputs[0]) : options.temp_dir),
        input_(std::move(input)),
        values_(functions, input_.dimension),
        collectors_(functions.size()) {}

  std::vector<ComputeResult> run() {
    {
      const Stopwatch wall(common_.seconds.wall);
      first_stage();
      input_ = {};
    }
    std::vector<ComputeResult> results;
    for (std::size_t f = 0; f < functions_.size(); ++f) results.push_back(second_stage(f));
    return results;
  }

 private:
  void first_stage();
  void spool();
  LastUse find_last_uses();
  LastUse scan();
  ComputeResult second_stage(std::size_t f);
  void run_chunks(ChunkSource& source);
  ChunkSize chunk_size() const;
  std::uint64_t table_allowance() const;
  void tell(Phase phase, std::uint64_t done, std::uint64_t total, std::uint64_t triangles = 0) const {
    if (options_.progress) options_.progress({phase, done, total, triangles});
  }

  std::span<VertexFunction* const> functions_;
  std::span<const std::string> outputs_;
  const ComputeOptions& options_;
  MemoryBudget budget_;
  TempDir temp_;
  MeshInput input_;  // a spooled mesh holds reservations and files of the two above
  FunctionValues values_;
  std::vector<GraphCollector> collectors_;
  ComputeResult common_;  // what all functions share
};

void Run::first_stage() {
  if (!input_.indexed && !input_.reader->info().finalizes) spool();
  if (!input_.indexed) {
    const auto source = chunks_of(*input_.reader, values_, chunk_size());
    run_chunks(*source);
    for (std::string& warning : input_.reader->warnings()) common_.notes.push_back(std::move(warning));
    return;
  }
  LastUse last_use = find_last_uses();
  const UseSummary& summary = last_use.summary();
  common_.vertices = summary.vertex_count;
  common_.unused_vertices = summary.unused_vertices;
  common_.degenerate_triangles = summary.degenerate_triangles;
  common_.spilled_bytes += last_use.spilled_bytes();
  const auto source = chunks_of(*input_.indexed, last_use, values_, chunk_size());
  run_chunks(*source);
}

void Run::spool() {
  const Stopwatch watch(common_.seconds.finalization);
  SpoolOptions options;
  options.allowance_bytes = table_allowance();
  options.progress = [this](const MeshReader& reader) {
    tell(Phase::kSpool, reader.bytes_read(), reader.info().file_bytes);
  };
  auto mesh = ooc::spool(*input_.reader, temp_, budget_, options);
  for (std::string& warning : input_.reader->warnings()) common_.notes.push_back(std::move(warning));
  common_.spilled_bytes += mesh->spilled_bytes();
  input_.indexed = std::move(mesh);
  input_.reader.reset();
}

LastUse Run::find_last_uses() {
  const Stopwatch watch(common_.seconds.finalization);
  const bool has_file = !input_.path.empty() && input_.path != "-" && options_.chunk_triangles == 0;
  if (!has_file) return scan();
  const std::string sidecar = input_.path + ".final";
  const MeshIdentity identity = identify_mesh(input_.path);
  SidecarLoad known = load_sidecar(sidecar, identity, input_.indexed->vertex_count(), temp_, budget_,
                                   table_allowance());
  if (known.uses) return std::move(*known.uses);
  if (!known.note.empty()) common_.notes.push_back(known.note);
  LastUse uses = scan();
  if (options_.keep_sidecar) save_sidecar(sidecar, identity, uses);
  return uses;
}

LastUse Run::scan() {
  LastUseOptions options;
  options.allowance_bytes = table_allowance();
  // A chunk is whole blocks, so small chunks need small blocks.
  if (options_.chunk_triangles != 0)
    options.block_triangles = std::min<std::uint64_t>(options.block_triangles, options_.chunk_triangles);
  options.progress = [this](const IndexedMesh& mesh) {
    tell(Phase::kFinalization, mesh.bytes_read(), mesh.bytes_total());
  };
  return std::move(*scan_last_use(*input_.indexed, temp_, budget_, options));
}

void Run::run_chunks(ChunkSource& source) {
  const Stopwatch watch(common_.seconds.reeb);
  std::vector<GraphSink*> sinks;
  for (GraphCollector& collector : collectors_) sinks.push_back(&collector);
  PipelineOptions options;
  options.threads = options_.threads;
  options.progress = [this](const ChunkSource& s) {
    tell(Phase::kReeb, s.bytes_read(), s.bytes_total(), s.triangles_read());
  };
  common_.live = run_pipeline(source, sinks, budget_, options);
  common_.triangles = source.triangles_read();
  common_.vertices = source.vertex_count();
}

// Tables of the finalization pass and of spooled meshes: they page beyond this.
std::uint64_t Run::table_allowance() const {
  constexpr std::uint64_t kDefault = 8u << 20;
  return std::min<std::uint64_t>(kDefault, options_.memory_bytes / 8);
}

ChunkSize Run::chunk_size() const {
  if (options_.chunk_triangles != 0) return {options_.chunk_triangles, options_.chunk_triangles};
  return {};
}

ComputeResult Run::second_stage(std::size_t f) {
  ComputeResult result = common_;
  result.function = functions_[f]->name();
  result.output = outputs_[f];
  result.range = values_.range(f);
  const auto start = Clock::now();
  {
    const Stopwatch watch(result.seconds.hierarchy);
    const ReebGraph graph = collectors_[f].take();
    result.nodes = graph.node_count();
    result.arcs = graph.arc_count();
    result.betti = betti_numbers(graph);
    tell(Phase::kHierarchy, 0, 1);

    FileMeta meta;
    meta.function = result.function;
    if (result.vertices != 0) {
      meta.function_min = result.range.min;
      meta.function_max = result.range.max;
    }
    meta.mesh_vertices = result.vertices;
    meta.mesh_triangles = result.triangles;
    if (options_.graph_only) {
      write_graph_file(result.output, meta, graph);
    } else {
      const Hierarchy hierarchy = build_hierarchy(graph);
      for (const PersistencePair& pair : hierarchy.pairs) {
        ++result.pairs[static_cast<std::size_t>(pair.type)];
        result.kept_loops += pair.kept ? 1u : 0u;
      }
      constexpr std::size_t kLargest = 5;
      for (auto it = hierarchy.pairs.rbegin(); it != hierarchy.pairs.rend() && result.largest.size() < kLargest; ++it)
        if (it->type != PairType::kExt0)
          result.largest.push_back({it->type, graph.nodes[it->lo.value()], graph.nodes[it->hi.value()]});
      write_hierarchy_file(result.output, meta, graph, hierarchy);
    }
  }
  result.seconds.wall += seconds_since(start);
  return result;
}

}  // namespace

std::vector<ComputeResult> compute(MeshInput input, std::span<VertexFunction* const> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options) {
  return Run(std::move(input), functions, outputs, options).run();
}

}  // namespace reeb::ooc
