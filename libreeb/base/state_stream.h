// Saving and restoring flat state: values and arrays, with their bytes as in memory.
//
// Only a later process of the same program on the same kind of machine can restore them. The code that stores the
// bytes adds a checksum. Arrays are saved with their length and element size; a length for which there are not enough
// bytes is an error.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace reeb {

// The bytes are not the requested state.
class DamagedState : public std::exception {
 public:
  const char* what() const noexcept override { return "the saved state is damaged"; }
};

// For what was restored. THROWS: DamagedState.
inline void require_state(bool is_sound) {
  if (!is_sound) throw DamagedState();
}

class StateWriter {
 public:
  StateWriter() = default;
  StateWriter(const StateWriter&) = delete;
  StateWriter& operator=(const StateWriter&) = delete;
  virtual ~StateWriter() = default;

  virtual void write(std::span<const std::byte> bytes) = 0;

  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    write(std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void put_array(const std::vector<T>& array) {
    put_array(std::span<const T>(array));
  }
  template <class T>
  void put_array(std::span<const T> array) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t{array.size()});
    put(std::uint64_t{sizeof(T)});
    write(std::as_bytes(array));
  }
};

// THROWS: DamagedState, from every call.
class StateReader {
 public:
  StateReader() = default;
  StateReader(const StateReader&) = delete;
  StateReader& operator=(const StateReader&) = delete;
  virtual ~StateReader() = default;

  virtual void read(std::span<std::byte> bytes) = 0;
  virtual std::uint64_t left() const = 0;  // bytes

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    read(std::as_writable_bytes(std::span(&value, 1)));
  }
  template <class T>
  T get() {
    T value{};
    get(value);
    return value;
  }
  // A byte other than 0 and 1 is no bool.
  bool get_bool() {
    const auto byte = get<std::uint8_t>();
    if (byte > 1) throw DamagedState();
    return byte != 0;
  }
  template <class T>
  void get_array(std::vector<T>& array) {
    array.resize(get_array_size<T>());
    read(std::as_writable_bytes(std::span(array)));
  }
  // The number of elements of the array that follows; never more than the remaining bytes can hold.
  template <class T>
  std::size_t get_array_size() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = get<std::uint64_t>();
    if (get<std::uint64_t>() != sizeof(T) || count > left() / sizeof(T)) throw DamagedState();
    return static_cast<std::size_t>(count);
  }
};

// A state in memory: read from its beginning, in the order in which it was written.
class StateBytes : public StateWriter, public StateReader {
 public:
  explicit StateBytes(std::vector<std::byte> bytes = {}) : bytes_(std::move(bytes)) {}
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  void write(std::span<const std::byte> more) override { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
  void read(std::span<std::byte> out) override {
    if (out.size() > left()) throw DamagedState();
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), out.size(), out.begin());
    at_ += out.size();
  }
  std::uint64_t left() const override { return bytes_.size() - at_; }
  // With those that were read.
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace reeb
