#include "tools/checks/node_check.h"

#include <filesystem>
#include <limits>
#include <span>

#include "libreeb/base/error.h"

namespace reeb::tools {

NodeCheck::NodeCheck(const std::string& file, const std::string& mesh, const std::string& function,
                     const ReebGraph& graph)
    : graph_(graph),
      mesh_(mesh),
      places_(mesh, graph),
      range_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()} {
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
  read_ = batch.first_vertex.value() + batch.vertex_count;
  places_.add(batch, [&](std::size_t node, std::size_t i) {
    if (source_ && graph_.nodes[node].value != values_[i]) places_.fail(node, "has another value in the mesh");
  });
}

std::optional<ValueRange> NodeCheck::finish() {
  places_.finish();
  if (source_) {
    source_->check_count(read_);
    source_->check_unchanged();
  }
  if (!source_ || range_.min > range_.max) return std::nullopt;
  return range_;
}

}  // namespace reeb::tools
