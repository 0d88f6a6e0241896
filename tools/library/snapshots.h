// Exact graphs of a stream while it is read (`ComputeOptions::snapshot_every`).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/file/atomic_file.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"

namespace reeb {

// Passes on what `reader` delivers, and keeps an on-line graph (libreeb/engine/online_reeb.h) of every function beside
// it. Each time `every` further simplices have been delivered, the exact graph of all events so far is written as
// OUT-000001.reeb, OUT-000002.reeb, ... where OUT is the function's output without ".reeb": whole files without levels,
// each appearing in one step. Such files are replaced only if `existing` says so; then warnings() names those of an
// earlier run that are left. `functions` must outlive the reader and is not evaluated elsewhere at the same time.
// COST: the on-line graphs come on top of the run. They, and what a snapshot takes, are in memory_bytes().
std::unique_ptr<MeshReader> with_snapshots(std::unique_ptr<MeshReader> reader, std::uint64_t every,
                                           std::span<VertexFunction* const> functions,
                                           std::span<const std::string> outputs, io::Existing existing);

}  // namespace reeb
