#include "tools/program/process_memory.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <string>

namespace reeb::tools {
namespace {

// The flags of the mapping that holds the address, as the system names them; empty if it does not tell.
std::string flags_at(const void* address) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream maps("/proc/self/smaps");
  bool here = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::istringstream words(line);
    if (words >> std::hex >> begin >> dash >> end && dash == '-') here = begin <= wanted && wanted < end;
    if (here && line.starts_with("VmFlags:")) return line + ' ';
  }
  return {};
}

bool wants_huge_pages(const std::byte* block, std::size_t size) {
  return flags_at(block + size / 2).find(" hg ") != std::string::npos;
}

bool has_huge_pages() {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;  // operator new is another one
#else
  return static_cast<bool>(std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"));
#endif
}

TEST(ProcessMemory, LargeBlocksAskForHugePages) {
  if (!has_huge_pages()) GTEST_SKIP() << "not here: huge pages, or the system's own operator new";
  set_up_process_memory();
  constexpr std::size_t kSmall = 3 << 20, kLarge = 4 << 20;
  const auto small = std::make_unique_for_overwrite<std::byte[]>(kSmall);
  const auto large = std::make_unique_for_overwrite<std::byte[]>(kLarge);
  EXPECT_TRUE(wants_huge_pages(large.get(), kLarge));
  EXPECT_FALSE(wants_huge_pages(small.get(), kSmall));
}

TEST(ProcessMemory, ABlockThatIsTooLargeIsRefused) {
  const volatile std::size_t too_large = std::numeric_limits<std::size_t>::max() / 4;
  EXPECT_THROW(::operator delete(::operator new(too_large)), std::bad_alloc);
}

}  // namespace
}  // namespace reeb::tools
