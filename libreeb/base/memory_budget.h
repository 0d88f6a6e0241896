// The budget from which every large user of memory reserves it (docs/ARCHITECTURE.md, Decisions worth knowing).
//
// Each run has one MemoryBudget. An owner reserves memory before it allocates, and holds a move-only Reservation for
// as long as it holds the memory; the destructor returns it. Allocator hooks would not do: they see bytes, not
// owners, and come too late to choose another plan.
//
// THREADS: any thread may reserve and release.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace reeb {

class MemoryBudget;

class Reservation {
 public:
  Reservation() = default;
  Reservation(Reservation&& other) noexcept;
  Reservation& operator=(Reservation&& other) noexcept;
  ~Reservation() { release(); }

  std::uint64_t bytes() const { return bytes_; }
  // Changes the size. THROWS: as MemoryBudget::reserve; the size then stays as it was.
  void resize(std::uint64_t bytes);
  // Changes the size if the budget allows it; returns whether it did.
  bool try_resize(std::uint64_t bytes) noexcept;
  void release() noexcept;

 private:
  friend class MemoryBudget;
  MemoryBudget* budget_ = nullptr;
  const char* owner_ = "";
  std::uint64_t bytes_ = 0;
};

class MemoryBudget {
 public:
  static constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};

  // `set_aside_bytes` were subtracted from the user's limit beforehand; hints add them again.
  explicit MemoryBudget(std::uint64_t limit_bytes = kUnlimited, std::uint64_t set_aside_bytes = 0)
      : limit_(limit_bytes), set_aside_(set_aside_bytes) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // `owner` is a string literal that names the holder in error texts ("live graph").
  // THROWS: Error{kResource} with the bytes requested, the bytes in use by each owner, and what to do.
  Reservation reserve(const char* owner, std::uint64_t bytes);
  // The same, but when it does not fit, returns an empty reservation of that owner: bytes() is 0.
  Reservation try_reserve(const char* owner, std::uint64_t bytes) noexcept;

  std::uint64_t limit_bytes() const { return limit_; }
  std::uint64_t used_bytes() const;
  std::uint64_t peak_bytes() const;
  std::uint64_t free_bytes() const;
  // How often reserve() and resize() refused memory.
  std::uint64_t refusals() const;

 private:
  friend class Reservation;
  bool change(const char* owner, std::uint64_t from, std::uint64_t to) noexcept;
  [[noreturn]] void refuse(const char* owner, std::uint64_t from, std::uint64_t to);

  const std::uint64_t limit_, set_aside_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0, peak_ = 0, refusals_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> owners_;
};

// For tests: during its lifetime every budget asks `refuses(owner)` before it grants a request of reserve() or resize()
// for more memory. REQUIRES: one at a time; no budget is in use when it begins or ends; `refuses` may be called by any
// number of threads at once.
class ScopedBudgetFault {
 public:
  using Refuses = std::function<bool(const char* owner)>;
  explicit ScopedBudgetFault(Refuses refuses);
  ScopedBudgetFault(const ScopedBudgetFault&) = delete;
  ScopedBudgetFault& operator=(const ScopedBudgetFault&) = delete;
  ~ScopedBudgetFault();

 private:
  Refuses refuses_;
};

// "64.0 MiB", "512 bytes": sizes as messages print them.
std::string format_bytes(std::uint64_t bytes);

}  // namespace reeb
