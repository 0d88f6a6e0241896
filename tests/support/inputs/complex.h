// A small mesh in memory, as tests build it: the vertices and simplices of an input stream, in order
// (docs/SEMANTICS.md, Input).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reeb::test {

struct Complex {
  std::vector<double> values;  // one per vertex; -0.0 may occur
  // Each simplex has one or more corners, in any order, possibly repeated.
  std::vector<std::vector<std::uint64_t>> simplices;
  std::vector<std::array<double, 3>> positions;  // one per vertex
  std::string kind;                              // how it was made, for messages

  std::size_t vertex_count() const { return positions.size(); }
};

// A complex from given values and simplices, all positions zero.
Complex make_complex(std::vector<double> values, std::vector<std::vector<std::uint64_t>> simplices);

// The distinct edges and triangles of all simplices, corners ascending by index, sorted.
struct Skeleton {
  std::vector<std::array<std::uint64_t, 2>> edges;
  std::vector<std::array<std::uint64_t, 3>> triangles;
};
Skeleton two_skeleton(const Complex& complex);

// The vertices in the total order: by value, ties by index.
std::vector<std::uint64_t> sweep_order(const Complex& complex);

// The same complex with its simplices, and the corners of each, in another order.
Complex shuffled(Complex complex, std::uint64_t seed);

// Its first vertices and simplices. REQUIRES: these simplices use only these vertices.
Complex beginning(const Complex& complex, std::size_t vertices, std::size_t simplices);

// Connected components, isolated vertices included.
std::uint64_t component_count(const Complex& complex);

// The whole complex as text, for the message of a failed comparison.
std::string describe(const Complex& complex);

}  // namespace reeb::test
