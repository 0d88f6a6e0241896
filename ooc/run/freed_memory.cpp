#include "ooc/run/freed_memory.h"

#include <atomic>
#include <cstdint>
#include <cstdlib>  // says which library it is

#ifdef __GLIBC__
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <string>
#endif

namespace reeb::ooc {
namespace {

std::atomic<bool> owns_process = false;

}  // namespace

void own_process() { owns_process = true; }

#ifdef __GLIBC__

namespace {

bool is_traced() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "TracerPid:") return !(status >> word) || word != "0";
  return true;  // not known
}

int return_read_only_pages(dl_phdr_info* object, std::size_t, void*) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGE_SIZE));
  for (std::size_t i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    // What can be written was changed by the loader, and has no other copy.
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t begin = (object->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t end = (object->dlpi_addr + segment.p_vaddr + segment.p_memsz) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);  // or all stays as it is
  }
  return 0;
}

}  // namespace

void return_freed_memory() { malloc_trim(0); }

void return_code() {
  if (owns_process && !is_traced()) dl_iterate_phdr(return_read_only_pages, nullptr);
}

#else

void return_freed_memory() {}
void return_code() {}

#endif

}  // namespace reeb::ooc
