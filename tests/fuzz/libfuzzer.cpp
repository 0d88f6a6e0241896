// The targets under libFuzzer (preset `fuzz`, see README.md): guided by coverage, with the mutations of the project in
// addition to its own. The first argument names the target: --target=smc.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "tests/fuzz/mutator.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace reeb::test;

const FuzzTarget* target = nullptr;
std::unique_ptr<Mutator> mutator;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument.starts_with("--target=")) target = find_fuzz_target(argument.substr(9));
  }
  if (target == nullptr) {
    std::fprintf(stderr, "name a target:");
    for (const FuzzTarget& known : fuzz_targets())
      std::fprintf(stderr, " --target=%s", std::string(known.name).c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  mutator = std::make_unique<Mutator>(*target, 0);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  std::string bytes;
  mutator->reseed(seed);
  const unsigned choice = seed % 16;
  if (choice < 8) {
    size = LLVMFuzzerMutate(data, size, most);
    bytes.assign(reinterpret_cast<const char*>(data), size);
    if (target->fix_checksums != nullptr) target->fix_checksums(bytes);
  } else if (choice < 15) {
    bytes.assign(reinterpret_cast<const char*>(data), size);
    mutator->mutate(bytes);
  } else {
    bytes = mutator->sample();
  }
  if (bytes.size() > most) bytes.resize(most);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}
