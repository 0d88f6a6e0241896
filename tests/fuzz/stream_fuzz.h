// One input of the streaming mesh fuzzers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/streaming/open_stream.h"
#include "io/streaming/stream_mesh_reader.h"
#include "libreeb/base/error.h"

namespace reeb::io {

// Reads `bytes` to the end, or to their first fault; through the adapter too, so that post-order
// streams wait. A well-predicted code stream can stand for very many triangles: stops at some.
inline void fuzz_stream(std::span<const std::byte> bytes) {
  static constexpr std::size_t kMostBatches = 2000;
  try {
    ReadOptions options;
    options.batch_events = 16;
    const auto reader =
        make_stream_mesh_reader(open_stream(std::make_unique<SpanSource>(bytes)), options);
    MeshBatch batch;
    for (std::size_t i = 0; i < kMostBatches && reader->read(batch); ++i) {
    }
    (void)reader->warnings();
  } catch (const Error& error) {
    if (error.message().empty() || error.hint().empty()) __builtin_trap();
  }
}

}  // namespace reeb::io
