#include "libreeb/base/memory_budget.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb {
namespace {

const ScopedBudgetFault::Refuses* budget_fault = nullptr;

bool refused_by_test(const char* owner) { return budget_fault != nullptr && (*budget_fault)(owner); }

}  // namespace

ScopedBudgetFault::ScopedBudgetFault(Refuses refuses) : refuses_(std::move(refuses)) { budget_fault = &refuses_; }

ScopedBudgetFault::~ScopedBudgetFault() { budget_fault = nullptr; }

Reservation::Reservation(Reservation&& other) noexcept
    : budget_(std::exchange(other.budget_, nullptr)), owner_(other.owner_), bytes_(std::exchange(other.bytes_, 0)) {}

Reservation& Reservation::operator=(Reservation&& other) noexcept {
  if (this != &other) {
    release();
    budget_ = std::exchange(other.budget_, nullptr);
    owner_ = other.owner_;
    bytes_ = std::exchange(other.bytes_, 0);
  }
  return *this;
}

bool Reservation::try_resize(std::uint64_t bytes) noexcept {
  if (budget_ == nullptr) return true;
  if (!budget_->change(owner_, bytes_, bytes)) return false;
  bytes_ = bytes;
  return true;
}

void Reservation::resize(std::uint64_t bytes) {
  const bool refused = bytes > bytes_ && budget_ != nullptr && refused_by_test(owner_);
  if (refused || !try_resize(bytes)) budget_->refuse(owner_, bytes_, bytes);
}

void Reservation::release() noexcept {
  if (budget_ != nullptr) budget_->change(owner_, bytes_, 0);
  bytes_ = 0;
}

Reservation MemoryBudget::try_reserve(const char* owner, std::uint64_t bytes) noexcept {
  Reservation reservation;
  reservation.budget_ = this;
  reservation.owner_ = owner;
  reservation.try_resize(bytes);
  return reservation;
}

Reservation MemoryBudget::reserve(const char* owner, std::uint64_t bytes) {
  if (refused_by_test(owner)) refuse(owner, 0, bytes);
  Reservation reservation = try_reserve(owner, bytes);
  if (reservation.bytes() != bytes) refuse(owner, 0, bytes);
  return reservation;
}

std::uint64_t MemoryBudget::used_bytes() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

std::uint64_t MemoryBudget::peak_bytes() const {
  const std::lock_guard lock(mutex_);
  return peak_;
}

std::uint64_t MemoryBudget::free_bytes() const {
  const std::lock_guard lock(mutex_);
  return limit_ - std::min(used_, limit_);
}

std::uint64_t MemoryBudget::refusals() const {
  const std::lock_guard lock(mutex_);
  return refusals_;
}

bool MemoryBudget::change(const char* owner, std::uint64_t from, std::uint64_t to) noexcept {
  const std::lock_guard lock(mutex_);
  if (to > from && to - from > limit_ - std::min(used_, limit_)) return false;
  auto it = owners_.find(owner);
  if (it == owners_.end()) {
    try {
      it = owners_.emplace(owner, 0).first;
    } catch (const std::bad_alloc&) {  // the system has not even this much
      return false;
    }
  }
  it->second += to - from;
  used_ += to - from;
  peak_ = std::max(peak_, used_);
  return true;
}

void MemoryBudget::refuse(const char* owner, std::uint64_t from, std::uint64_t to) {
  std::string in_use;
  const std::lock_guard lock(mutex_);
  ++refusals_;
  // What grew until now will likely grow further.
  const std::uint64_t limit = set_aside_ + limit_;
  const std::uint64_t enough = std::max(2 * limit, limit + 2 * (to - from));
  for (const auto& [name, bytes] : owners_)
    if (bytes != 0) in_use += (in_use.empty() ? "" : ", ") + name + " " + format_bytes(bytes);
  throw Error(ErrorKind::kResource,
              std::string(owner) + " needs " + format_bytes(to - from) + " more memory, but " +
                  format_bytes(limit_ - std::min(used_, limit_)) + " of " + format_bytes(limit_) +
                  " is free (in use: " + (in_use.empty() ? "nothing" : in_use) + ")",
              "allow more, for instance --memory " + std::to_string((enough >> 20) + 1) + "M")
      .because(ErrorCause::kMemory);
}

std::string format_bytes(std::uint64_t bytes) {
  if (bytes == 1) return "1 byte";
  static constexpr std::array<const char*, 5> kUnits = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  double size = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (size >= 1024 && unit + 1 < kUnits.size()) {
    size /= 1024;
    ++unit;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", size, kUnits[unit]);
  return text.data();
}

}  // namespace reeb
