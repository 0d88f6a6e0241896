#include "tools/checks/node_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <span>

namespace reeb::tools {

NodeCheck::NodeCheck(const std::string& file, const std::string& mesh, const std::string& function,
                     const ReebGraph& graph)
    : graph_(graph),
      mesh_(mesh),
      by_vertex_(graph.node_count()),
      range_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()} {
  std::iota(by_vertex_.begin(), by_vertex_.end(), std::size_t{0});
  std::sort(by_vertex_.begin(), by_vertex_.end(),
            [&](std::size_t a, std::size_t b) { return graph.nodes[a].vertex < graph.nodes[b].vertex; });
  try {
    spec_ = io::parse_function(function);
  } catch (const Error& error) {
    throw Error(ErrorKind::kBadInput, std::string("its function: ") + error.what(),
                "the file names a function that this program does not know")
        .at(file);
  }
  properties_ = io::needed_properties(std::span(&spec_, 1));
}

std::string NodeCheck::missing_file() const {
  const bool is_file = spec_.kind == io::FunctionSpec::Kind::kFile;
  return is_file && !std::filesystem::exists(spec_.argument) ? spec_.argument : "";
}

void NodeCheck::start(const MeshInfo& info, const io::OpenMesh& open_again, const std::string& temp_folder,
                      std::uint64_t memory_bytes) {
  if (const std::string missing = missing_file(); !missing.empty()) {
    unchecked_ = missing + " is gone, so the values were not checked";
    return;
  }
  const bool reads_twice = spec_.needs_field() || spec_.kind == io::FunctionSpec::Kind::kDistanceToVertex;
  if (reads_twice && !open_again) {
    unchecked_ = "the mesh can be read only once, so the values of " + spec_.text + " were not checked";
    return;
  }
  const auto fields = io::read_fields(std::span(&spec_, 1), open_again, mesh_, temp_folder, memory_bytes);
  source_.emplace(spec_, info, properties_, mesh_, &fields.front());
  if (source_->needs_lookup()) source_->look_up(*open_again());
}

void NodeCheck::add(const MeshBatch& batch) {
  if (source_) {
    values_.resize(batch.vertex_count);
    source_->evaluate(batch, values_);
    for (const double value : values_) {
      range_.add(value);
    }
  }
  const std::uint64_t first = batch.first_vertex.value(), end = first + batch.vertex_count;
  read_ = end;
  for (; next_ < by_vertex_.size() && graph_.nodes[by_vertex_[next_]].vertex.value() < end; ++next_) {
    const std::size_t node = by_vertex_[next_];
    const auto i = static_cast<std::size_t>(graph_.nodes[node].vertex.value() - first);
    if (source_ && graph_.nodes[node].value != values_[i]) fail(node, "has another value in the mesh");
    for (std::size_t k = 0; k < 3 && !graph_.positions.empty(); ++k)
      if (graph_.positions[node][k] != (k < batch.coordinates.size() ? batch.coordinates[k][i] : 0.0))
        fail(node, "has another position in the mesh");
  }
}

std::optional<ValueRange> NodeCheck::finish() {
  if (next_ != by_vertex_.size()) fail(by_vertex_[next_], "is not in the mesh");
  if (failure_) throw *failure_;
  if (source_) {
    source_->check_count(read_);
    source_->check_unchanged();
  }
  if (!source_ || range_.min > range_.max) return std::nullopt;
  return range_;
}

void NodeCheck::fail(std::size_t node, const char* why) {
  if (!failure_) failure_ = wrong_mesh(mesh_, graph_.nodes[node].vertex, why);
}

Error wrong_mesh(const std::string& mesh, VertexId vertex, const char* why) {
  return Error(ErrorKind::kBadInput, fmt::format("the node of vertex {} {}", vertex.value(), why),
               "name the mesh that the file was computed from")
      .at(mesh);
}

}  // namespace reeb::tools
