// Fuzzer of the streaming mesh readers, for clang++ -fsanitize=fuzzer,address,undefined with the
// sources of libreeb and io/streaming; the samples of streaming meshes are a good start.
#include "tests/fuzz/stream_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  reeb::io::fuzz_stream(std::as_bytes(std::span(data, size)));
  return 0;
}
