// A vector that is indexed by ids of one kind, so that an arc's id cannot be used in an array of nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace reeb {

template <class Key, class T>
class IdVector : private std::vector<T> {
  using Base = std::vector<T>;
  using Rep = decltype(Key().value());

 public:
  using Base::assign, Base::clear, Base::resize, Base::reserve;
  using Base::begin, Base::end, Base::size, Base::empty, Base::capacity;

  T& operator[](Key id) { return Base::operator[](id.value()); }
  const T& operator[](Key id) const { return Base::operator[](id.value()); }

  // Appends an element and returns its id.
  Key add(T element) {
    const Key id = end_id();
    Base::push_back(std::move(element));
    return id;
  }
  // One more than the last id.
  Key end_id() const { return Key(static_cast<Rep>(size())); }
};

}  // namespace reeb
