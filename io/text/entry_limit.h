// How many entries of a kind a file may list. Readers hold these entries, and a packed file of a few kilobytes can list
// millions. The limits are far above what files of meshes have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "libreeb/base/count_text.h"

namespace reeb::io {

class EntryLimit {
 public:
  static constexpr std::uint64_t kUsual = 10000;

  // `what` names the entries in messages ("properties").
  explicit EntryLimit(const char* what, std::uint64_t most = kUsual) : what_(what), most_(most) {}

  // Counts `entries` more, each with `bytes_each` bytes of text.
  // THROWS: what place.fail(what, hint) throws, if they are too many.
  template <class Place>
  void add(std::uint64_t entries, std::uint64_t bytes_each, const Place& place) {
    entries_ += entries;
    bytes_ += entries * bytes_each;
    if (entries_ > most_) place.fail(std::string("the file has more than ") + with_commas(most_) + ' ' + what_, kHint);
    if (bytes_ > kBytesEach * most_)
      place.fail(std::string("the ") + what_ + " of the file have more than " + with_commas(kBytesEach * most_) +
                     " characters in all",
                 kHint);
  }
  // REQUIRES: add() counted one.
  void remove(std::uint64_t bytes) {
    --entries_;
    bytes_ -= bytes;
  }

 private:
  static constexpr std::uint64_t kBytesEach = 100;  // on average
  static constexpr const char* kHint = "if the file is not damaged, write it again with fewer of them";

  const char* what_;
  std::uint64_t most_;
  std::uint64_t entries_ = 0, bytes_ = 0;
};

}  // namespace reeb::io
