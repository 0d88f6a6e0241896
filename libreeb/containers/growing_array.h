// An array of plain elements that grows by realloc. For large blocks realloc remaps pages instead of copying, so there
// are never two copies, and spare capacity is not resident until it is used. So memory_bytes() is right even while the
// array grows; a vector would need twice that for a moment.
//
// For arrays that live as long as a run and count against its memory budget.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "libreeb/base/state_stream.h"

namespace reeb {

template <class T>
class GrowingArray {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  GrowingArray() = default;
  GrowingArray(const GrowingArray& other) {
    grow_by(other.size_);
    std::copy_n(other.data_.get(), size_, data_.get());
  }
  GrowingArray(GrowingArray&& other) noexcept
      : data_(std::move(other.data_)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)),
        most_(std::exchange(other.most_, 0)) {}
  GrowingArray& operator=(GrowingArray other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    std::swap(most_, other.most_);
    return *this;
  }
  ~GrowingArray() = default;

  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }
  T* data() { return data_.get(); }
  std::size_t size() const { return size_; }
  std::span<const T> all() const { return {data_.get(), size_}; }
  std::size_t memory_bytes() const { return most_ * sizeof(T); }

  // Grows by elements that the caller sets.
  // THROWS: std::bad_alloc.
  void grow_by(std::size_t count) {
    if (size_ + count > capacity_) reserve(size_ + count);
    size_ += count;
    most_ = std::max(most_, size_);
  }
  // `value` is a copy: it may come from this array, which can move.
  // THROWS: std::bad_alloc.
  void append(T value) {
    grow_by(1);
    data_.get()[size_ - 1] = value;
  }

  // Keeps the memory.
  void clear() { size_ = 0; }

  void save(StateWriter& out) const { out.put_array(std::span<const T>(data_.get(), size_)); }
  void restore(StateReader& in) {
    size_ = 0;
    grow_by(in.get_array_size<T>());
    in.read(std::as_writable_bytes(std::span(data_.get(), size_)));
  }

 private:
  void reserve(std::size_t least) {
    constexpr std::size_t kInitialCapacity = 256;
    const std::size_t capacity = std::max({kInitialCapacity, least, capacity_ + capacity_ / 4});
    void* moved = std::realloc(data_.get(), capacity * sizeof(T));
    if (moved == nullptr) throw std::bad_alloc();
    static_cast<void>(data_.release());
    data_.reset(static_cast<T*>(moved));
    capacity_ = capacity;
  }

  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0, capacity_ = 0, most_ = 0;
};

}  // namespace reeb
