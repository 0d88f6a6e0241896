// Comparisons of long strings and lists. EXPECT_EQ would print them whole, EXPECT_TRUE(a == b) nothing.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

namespace reeb::test {

// Says where two strings differ first, and prints the text there.
inline testing::AssertionResult same(const std::string& actual, const std::string& expected) {
  if (actual == expected) return testing::AssertionSuccess();
  const auto [a, e] = std::mismatch(actual.begin(), actual.end(), expected.begin(), expected.end());
  const auto at = static_cast<std::size_t>(a - actual.begin());
  const std::size_t from = at - std::min<std::size_t>(at, 20);
  return testing::AssertionFailure() << "byte " << at << ": " << testing::PrintToString(actual.substr(from, 60))
                                     << " instead of " << testing::PrintToString(expected.substr(from, 60)) << " ("
                                     << actual.size() << " bytes, expected " << expected.size() << ")";
}

// Says which element of two lists differs first.
template <class List>
testing::AssertionResult same(const List& actual, const List& expected) {
  const auto [a, e] = std::mismatch(actual.begin(), actual.end(), expected.begin(), expected.end());
  if (a == actual.end() && e == expected.end()) return testing::AssertionSuccess();
  auto result = testing::AssertionFailure() << "element " << std::distance(actual.begin(), a) << ": ";
  result << (a == actual.end() ? "none" : testing::PrintToString(*a)) << " instead of "
         << (e == expected.end() ? "none" : testing::PrintToString(*e));
  return result << " (" << actual.size() << " elements, expected " << expected.size() << ")";
}

}  // namespace reeb::test
