// The functions that a user names, as the engine wants them: a VertexFunction for any FunctionSpec.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/functions/function_source.h"
#include "libreeb/port/vertex_function.h"

namespace reeb::io {

class MeshFunction : public VertexFunction {
 public:
  // As FunctionSource; `mesh_name` is for messages.
  MeshFunction(const FunctionSpec& spec, const MeshInfo& info, std::span<const std::string> properties = {},
               const std::string& mesh_name = {})
      : name_(spec.text),
        source_file_(spec.kind == FunctionSpec::Kind::kFile ? spec.argument : ""),
        source_(spec, info, properties, mesh_name) {
    if (source_.column()) columns_.push_back(*source_.column());
  }

  std::string name() const override { return name_; }
  std::string source_file() const override { return source_file_; }
  std::span<const unsigned> columns() const override { return columns_; }
  void check_count(std::uint64_t vertex_count) override { source_.check_count(vertex_count); }
  std::uint64_t lookup_bytes(std::uint64_t vertex_count) const override { return source_.lookup_bytes(vertex_count); }
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> columns,
                std::span<double> values) override {
    source_.evaluate(ids, columns.empty() ? std::span<const double>() : columns[0], values);
  }

 private:
  std::string name_, source_file_;
  FunctionSource source_;
  std::vector<unsigned> columns_;
};

}  // namespace reeb::io
