#include "ooc/threads/kept_arena.h"

#include <map>
#include <memory>
#include <mutex>

namespace reeb::ooc {

tbb::task_arena& kept_arena(unsigned threads) {
  // Never destroyed: at the end of the process, TBB can be gone already.
  static auto& mutex = *new std::mutex;
  static auto& arenas = *new std::map<unsigned, std::unique_ptr<tbb::task_arena>>;
  const std::scoped_lock lock(mutex);
  auto& arena = arenas[threads];
  if (!arena) arena = std::make_unique<tbb::task_arena>(static_cast<int>(threads));
  return *arena;
}

}  // namespace reeb::ooc
