#include "libreeb/repair/exact_sign.h"

#include <array>
#include <cmath>

namespace reeb {
namespace {

// A sum of doubles that do not overlap, ascending in size: a number that is represented exactly (Shewchuk 1997).
template <std::size_t kMost>
struct Expansion {
  std::array<double, kMost> part{};
  std::size_t size = 0;

  void push(double x) {
    if (x != 0) part[size++] = x;
  }
  int sign() const { return size == 0 ? 0 : part[size - 1] > 0 ? 1 : -1; }
};

struct Pair {
  double high, low;
};

Pair two_sum(double a, double b) {
  const double sum = a + b, from_b = sum - a, from_a = sum - from_b;
  return {sum, (a - from_a) + (b - from_b)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

Expansion<2> difference(double a, double b) {
  const Pair pair = two_sum(a, -b);
  Expansion<2> result;
  result.push(pair.low);
  result.push(pair.high);
  return result;
}

// Adds the parts of b one by one, the smallest first.
template <std::size_t kA, std::size_t kB>
Expansion<kA + kB> sum_of(const Expansion<kA>& a, const Expansion<kB>& b) {
  Expansion<kA + kB> sum;
  for (std::size_t i = 0; i < a.size; ++i) sum.push(a.part[i]);
  for (std::size_t k = 0; k < b.size; ++k) {
    double x = b.part[k];
    std::size_t size = 0;
    for (std::size_t i = 0; i < sum.size; ++i) {
      const Pair pair = two_sum(x, sum.part[i]);
      x = pair.high;
      if (pair.low != 0) sum.part[size++] = pair.low;
    }
    sum.size = size;
    sum.push(x);
  }
  return sum;
}

template <std::size_t kA>
Expansion<2 * kA> scaled(const Expansion<kA>& a, double factor) {
  Expansion<2 * kA> product;
  for (std::size_t i = 0; i < a.size; ++i) {
    const Pair pair = two_product(a.part[i], factor);
    Expansion<2> term;
    term.push(pair.low);
    term.push(pair.high);
    Expansion<2 * kA + 2> sum = sum_of(product, term);
    product.size = 0;
    for (std::size_t k = 0; k < sum.size; ++k) product.push(sum.part[k]);
  }
  return product;
}

template <std::size_t kA>
Expansion<4 * kA> product_of(const Expansion<kA>& a, const Expansion<2>& b) {
  const Expansion<2 * kA> none{};
  return sum_of(b.size > 0 ? scaled(a, b.part[0]) : none, b.size > 1 ? scaled(a, b.part[1]) : none);
}

template <std::size_t kA>
Expansion<kA> negative(Expansion<kA> a) {
  for (std::size_t i = 0; i < a.size; ++i) a.part[i] = -a.part[i];
  return a;
}

using Difference = std::array<Expansion<2>, 3>;

Difference exact_difference(const Point& a, const Point& b) {
  return {difference(a[0], b[0]), difference(a[1], b[1]), difference(a[2], b[2])};
}

Expansion<16> minor(const Difference& p, const Difference& q, std::size_t i, std::size_t j) {
  return sum_of(product_of(p[i], q[j]), negative(product_of(p[j], q[i])));
}

int exact_side(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Difference p = exact_difference(b, a), q = exact_difference(c, a), r = exact_difference(d, a);
  return sum_of(sum_of(product_of(minor(p, q, 1, 2), r[0]), product_of(minor(p, q, 2, 0), r[1])),
                product_of(minor(p, q, 0, 1), r[2]))
      .sign();
}

}  // namespace

int side_of_plane(const Point& a, const Point& b, const Point& c, const Point& d) {
  Point p, q, r;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = b[k] - a[k];
    q[k] = c[k] - a[k];
    r[k] = d[k] - a[k];
  }
  double sum = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double plus = p[i] * q[j], minus = p[j] * q[i];
    sum += (plus - minus) * r[k];
    size += (std::abs(plus) + std::abs(minus)) * std::abs(r[k]);
  }
  // Rounding changes the sum by less than 8 units in the last place of `size`.
  const double bound = 1e-15 * size;
  if (sum > bound) return 1;
  if (sum < -bound) return -1;
  return exact_side(a, b, c, d);
}

int turn_without(std::size_t dropped, const Point& a, const Point& b, const Point& c) {
  const std::size_t i = (dropped + 1) % 3, j = (dropped + 2) % 3;
  const double plus = (b[i] - a[i]) * (c[j] - a[j]), minus = (b[j] - a[j]) * (c[i] - a[i]);
  const double bound = 1e-15 * (std::abs(plus) + std::abs(minus));
  if (plus - minus > bound) return 1;
  if (plus - minus < -bound) return -1;
  return minor(exact_difference(b, a), exact_difference(c, a), i, j).sign();
}

}  // namespace reeb
