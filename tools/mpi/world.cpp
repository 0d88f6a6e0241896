#include "tools/mpi/world.h"

#include <algorithm>
#include <numeric>

namespace reeb::tools {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of a message: MPI counts in int
constexpr int kTag = 1;

}  // namespace

World::World() {
  MPI_Comm_dup(MPI_COMM_WORLD, &all_);
  int rank = 0, size = 1;
  MPI_Comm_rank(all_, &rank);
  MPI_Comm_size(all_, &size);
  rank_ = static_cast<std::uint32_t>(rank);
  size_ = static_cast<std::uint32_t>(size);
}

World::~World() { MPI_Comm_free(&all_); }

std::uint32_t World::ranks_here() const {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(all_, MPI_COMM_TYPE_SHARED, static_cast<int>(rank_), MPI_INFO_NULL, &here);
  int size = 1;
  MPI_Comm_size(here, &size);
  MPI_Comm_free(&here);
  return static_cast<std::uint32_t>(size);
}

void World::send(std::uint32_t to, std::span<const std::byte> bytes) {
  const std::uint64_t size = bytes.size();
  sent_bytes_ += size;
  MPI_Send(&size, 1, MPI_UINT64_T, static_cast<int>(to), kTag, all_);
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kMostBytes, bytes.size())))
    MPI_Send(bytes.data(), static_cast<int>(std::min(kMostBytes, bytes.size())), MPI_BYTE, static_cast<int>(to), kTag,
             all_);
}

std::vector<std::byte> World::receive(std::uint32_t from, Reservation& memory) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, static_cast<int>(from), kTag, all_, MPI_STATUS_IGNORE);
  memory.resize(memory.bytes() + size);
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  for (std::size_t at = 0; at < bytes.size(); at += kMostBytes)
    MPI_Recv(bytes.data() + at, static_cast<int>(std::min(kMostBytes, bytes.size() - at)), MPI_BYTE,
             static_cast<int>(from), kTag, all_, MPI_STATUS_IGNORE);
  return bytes;
}

// Most pairs of ranks have nothing to say, so only those that have are sent a message.
std::vector<std::vector<std::uint64_t>> World::exchange(const std::vector<std::vector<std::uint64_t>>& out,
                                                        Reservation& memory) {
  constexpr std::size_t kMostNumbers = kMostBytes / sizeof(std::uint64_t);
  std::vector<std::uint64_t> sizes(size_), coming(size_);
  for (std::uint32_t r = 0; r < size_; ++r) sizes[r] = out[r].size();
  MPI_Alltoall(sizes.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, all_);
  memory.resize(memory.bytes() +
                std::accumulate(coming.begin(), coming.end(), std::uint64_t{0}) * sizeof(std::uint64_t));
  std::vector<std::vector<std::uint64_t>> in(size_);
  std::vector<MPI_Request> requests;
  const auto pieces = [&](std::size_t size, const auto& start) {
    for (std::size_t at = 0; at < size; at += kMostNumbers) {
      requests.push_back(MPI_REQUEST_NULL);
      start(at, static_cast<int>(std::min(kMostNumbers, size - at)));
    }
  };
  for (std::uint32_t r = 0; r < size_; ++r) {
    in[r].resize(static_cast<std::size_t>(coming[r]));
    pieces(in[r].size(), [&](std::size_t at, int count) {
      MPI_Irecv(in[r].data() + at, count, MPI_UINT64_T, static_cast<int>(r), kTag, all_, &requests.back());
    });
  }
  for (std::uint32_t r = 0; r < size_; ++r) {
    if (r != rank_) sent_bytes_ += out[r].size() * sizeof(std::uint64_t);
    pieces(out[r].size(), [&](std::size_t at, int count) {
      MPI_Isend(out[r].data() + at, count, MPI_UINT64_T, static_cast<int>(r), kTag, all_, &requests.back());
    });
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return in;
}

std::vector<std::uint64_t> World::gather(std::span<const std::uint64_t> numbers) {
  std::vector<std::uint64_t> all(is_root() ? size_ * numbers.size() : 0);
  const int count = static_cast<int>(numbers.size());
  MPI_Gather(numbers.data(), count, MPI_UINT64_T, all.data(), count, MPI_UINT64_T, 0, all_);
  return all;
}

std::uint64_t World::sum(std::uint64_t value) {
  std::uint64_t all = 0;
  MPI_Allreduce(&value, &all, 1, MPI_UINT64_T, MPI_SUM, all_);
  return all;
}

void World::wait_for_all() { MPI_Barrier(all_); }

}  // namespace reeb::tools
