// From fragments to the file of a Reeb graph, or to a fragment of more shares.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/vertex_function.h"
#include "ooc/distributed/part_info.h"
#include "ooc/run/compute.h"
#include "ooc/run/compute_result.h"
#include "ooc/run/first_stage.h"

namespace reeb::ooc {

struct GlueOptions {
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  unsigned threads = 1;  // 0: all of the machine
  std::string temp_dir;
  bool replace = true;
  bool graph_only = false;               // also if the fragments do not say so
  std::optional<std::uint32_t> buckets;  // 0: without the embedding; else as in the fragments
  std::function<void(const ComputeProgress&)> progress = {};
  std::function<bool()> interrupted = {};
};

struct GlueResult {
  PartInfo info;                        // of all that was glued
  std::uint64_t open_vertices = 0;      // that missing shares name
  std::optional<ComputeResult> result;  // of a whole graph
};

// Glues the fragments to `output`: a fragment if `as_fragment`, else the Reeb graph of all parts.
// THROWS: Error: kBadInput that names a fragment that does not fit or is damaged, or the part that is missing;
//         kUsage if there is none; kResource; kInterrupted.
GlueResult glue_fragments(std::span<const std::string> fragments, const std::string& output, bool as_fragment,
                          const GlueOptions& options);

// The options of a run that ends with what was glued.
ComputeOptions options_of_glue(const PartInfo& united, const GlueOptions& options);

// What the second stage of such a run has to know.
FirstStageResult first_stage_of(const PartInfo& united);

// A function of which only the name is known.
class NamedFunction : public VertexFunction {
 public:
  explicit NamedFunction(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  std::span<const unsigned> columns() const override { return {}; }
  void evaluate(std::span<const VertexId>, std::span<const std::span<const double>>, std::span<double>) override {}

 private:
  std::string name_;
};

}  // namespace reeb::ooc
