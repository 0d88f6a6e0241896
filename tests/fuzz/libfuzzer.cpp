// The targets under libFuzzer (preset `fuzz`, see README.md): guided by coverage, with the mutations of the project in
// addition to its own. The first argument names the target: --target=smc. With --write-corpus=FOLDER, its samples are
// written there, and nothing is run.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "tests/fuzz/mutator.h"
#include "tests/support/files.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace reeb::test;

const FuzzTarget* target = nullptr;
std::unique_ptr<Mutator> mutator;

void write_corpus(const std::string& folder) {
  std::size_t number = 0;
  for (const std::string& bytes : target->corpus()) write_file(folder + "/sample-" + std::to_string(number++), bytes);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kTarget = "--target=", kWriteCorpus = "--write-corpus=";
  std::string corpus;
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument.starts_with(kTarget)) target = find_fuzz_target(argument.substr(kTarget.size()));
    if (argument.starts_with(kWriteCorpus)) corpus = argument.substr(kWriteCorpus.size());
  }
  if (target == nullptr) {
    std::fprintf(stderr, "name a target:");
    for (const FuzzTarget& known : fuzz_targets())
      std::fprintf(stderr, " --target=%s", std::string(known.name).c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  if (!corpus.empty()) {
    write_corpus(corpus);
    std::exit(0);
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
