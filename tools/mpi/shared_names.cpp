#include "tools/mpi/shared_names.h"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/distributed/names_file.h"

namespace reeb::tools {
namespace {

using Numbers = std::vector<std::uint64_t>;
using Table = ooc::PagedTable<std::uint32_t>;

// Memory is reserved before it is needed.
void add(Numbers& numbers, std::initializer_list<std::uint64_t> more, Reservation& memory) {
  if (numbers.capacity() - numbers.size() < more.size()) {
    const std::size_t capacity = std::max<std::size_t>(48, 2 * numbers.capacity());
    memory.resize(memory.bytes() + (capacity - numbers.capacity()) * sizeof(std::uint64_t));
    numbers.reserve(capacity);
  }
  numbers.insert(numbers.end(), more);
}

// Of each rank: first vertex and count, in turn.
std::vector<Numbers> runs_by_owner(World& world, ooc::RunContext& run, ooc::WholeMesh& mesh, Reservation& memory) {
  const ooc::Shares& shares = mesh.info.shares;
  const std::uint64_t owned = std::max<std::uint64_t>(1, shares.first_vertex(1));
  std::vector<Numbers> runs(world.size());
  ooc::visit_names(run, mesh, world.rank(), [&](std::uint64_t first, std::uint64_t count) {
    while (count != 0) {
      const auto owner = static_cast<std::uint32_t>(first / owned);
      const std::uint64_t here = std::min(count, shares.first_vertex(owner + 1) - first);
      add(runs[owner], {first, here}, memory);
      first += here;
      count -= here;
    }
  });
  return runs;
}

// Whether triangles are where sizes tell is known when each rank has read its own.
std::vector<Numbers> own_runs(World& world, ooc::RunContext& run, ooc::WholeMesh& mesh, Reservation& memory) {
  if (mesh.by_size) {
    std::vector<Numbers> runs;
    bool fits = true;
    try {
      runs = runs_by_owner(world, run, mesh, memory);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kBadInput) throw;
      fits = false;
    }
    if (world.sum(fits ? 0 : 1) == 0) return runs;
    ooc::count_triangles(run, mesh);
  }
  return runs_by_owner(world, run, mesh, memory);
}

template <class Visit>
void for_each_vertex(const Numbers& runs, const Visit& visit) {
  for (std::size_t i = 0; i < runs.size(); i += 2)
    for (std::uint64_t v = runs[i]; v < runs[i] + runs[i + 1]; ++v) visit(v);
}

// Of each rank: first vertex, count and entry, in turn.
std::vector<Numbers> answers(const std::vector<Numbers>& named, Table& table, Reservation& memory) {
  std::vector<Numbers> out(named.size());
  for (std::uint32_t r = 0; r < named.size(); ++r)
    for_each_vertex(named[r], [&](std::uint64_t v) {
      const ooc::UseEntry entry(table.get(v));
      if (entry.last_block() == r && entry.span() == 0) return;
      Numbers& runs = out[r];
      const bool extends =
          !runs.empty() && runs[runs.size() - 3] + runs[runs.size() - 2] == v && runs.back() == entry.packed();
      if (extends)
        ++runs[runs.size() - 2];
      else
        add(runs, {v, 1, entry.packed()}, memory);
    });
  return out;
}

}  // namespace

ooc::PartUses exchange_names(World& world, ooc::RunContext& run, ooc::WholeMesh& mesh) {
  Reservation memory = run.budget.reserve("messages", 0);
  const std::vector<Numbers> own = own_runs(world, run, mesh, memory);
  Table table = ooc::empty_uses(run);
  const std::vector<Numbers> named = world.exchange(own, memory);
  for (std::uint32_t r = 0; r < world.size(); ++r)
    for_each_vertex(named[r], [&](std::uint64_t v) {
      std::uint32_t& entry = table.change(v);
      entry = ooc::UseEntry(entry).used_by(r).packed();
    });
  const std::vector<Numbers> shared = world.exchange(answers(named, table, memory), memory);
  for (std::uint32_t owner = 0; owner < world.size(); ++owner) {
    if (owner == world.rank()) continue;
    for_each_vertex(own[owner], [&](std::uint64_t v) { table.set(v, ooc::UseEntry(world.rank(), 0).packed()); });
    for (std::size_t i = 0; i < shared[owner].size(); i += 3)
      for (std::uint64_t k = 0; k < shared[owner][i + 1]; ++k)
        table.set(shared[owner][i] + k, static_cast<std::uint32_t>(shared[owner][i + 2]));
  }
  return ooc::uses_of_table(std::move(table), mesh.info.shares);
}

}  // namespace reeb::tools
