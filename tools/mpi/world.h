// The processes of a run over MPI, and what they say to each other.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"

namespace reeb::tools {

// A communicator of its own, so that no message of others is taken for one of ours.
//
// THROWS: std::runtime_error of MPI. THREADS: only the thread that initialized MPI.
class World {
 public:
  World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World();

  std::uint32_t rank() const { return rank_; }
  std::uint32_t size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  // How many ranks share this machine.
  std::uint32_t ranks_here() const;

  void send(std::uint32_t to, std::span<const std::byte> bytes);
  // The next two add what they receive to `memory` before they allocate it.
  std::vector<std::byte> receive(std::uint32_t from, Reservation& memory);
  // Sends out[r] to each rank r, and returns what each has sent.
  std::vector<std::vector<std::uint64_t>> exchange(const std::vector<std::vector<std::uint64_t>>& out,
                                                   Reservation& memory);
  // At the root: the numbers of each rank, in turn. REQUIRES: all ranks give the same count.
  std::vector<std::uint64_t> gather(std::span<const std::uint64_t> numbers);
  std::uint64_t sum(std::uint64_t value);
  void wait_for_all();

  // Bytes sent so far to other ranks.
  std::uint64_t sent_bytes() const { return sent_bytes_; }

 private:
  MPI_Comm all_ = MPI_COMM_NULL;
  std::uint32_t rank_ = 0, size_ = 1;
  std::uint64_t sent_bytes_ = 0;
};

}  // namespace reeb::tools
