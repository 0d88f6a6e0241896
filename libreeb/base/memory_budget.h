// The account from which everything that holds much memory reserves it (DESIGN.md 4).
//
// One MemoryBudget exists a run. An owner asks before it allocates and holds a move-only
// Reservation for as long as it holds the memory; the destructor gives it back. Allocator hooks
// were not chosen: they see bytes, not owners, and come too late to choose another plan.
//
// THREADS: any thread may reserve and release.
#pragma once

#include <cstdint>
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
  // Changes the size. THROWS: as MemoryBudget::reserve, with the old size kept.
  void resize(std::uint64_t bytes);
  // Changes the size if that is possible; says whether it was.
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

  // `set_aside_bytes` were taken off a user's limit beforehand; hints add them again.
  explicit MemoryBudget(std::uint64_t limit_bytes = kUnlimited, std::uint64_t set_aside_bytes = 0)
      : limit_(limit_bytes), set_aside_(set_aside_bytes) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // `owner` is a string literal that names the holder in error texts ("live graph").
  // THROWS: Error{kResource} with what was asked, what is in use by whom, and what to do.
  Reservation reserve(const char* owner, std::uint64_t bytes);
  // The same, but an empty reservation of the same owner when it does not fit; ask bytes().
  Reservation try_reserve(const char* owner, std::uint64_t bytes) noexcept;

  std::uint64_t limit_bytes() const { return limit_; }
  std::uint64_t used_bytes() const;
  std::uint64_t peak_bytes() const;
  std::uint64_t free_bytes() const;

 private:
  friend class Reservation;
  bool change(const char* owner, std::uint64_t from, std::uint64_t to) noexcept;
  [[noreturn]] void refuse(const char* owner, std::uint64_t from, std::uint64_t to) const;

  const std::uint64_t limit_, set_aside_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0, peak_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> owners_;
};

// "64.0 MiB", "512 bytes": sizes as messages print them.
std::string format_bytes(std::uint64_t bytes);

}  // namespace reeb
