#include <firstcontact/geometry/detail/orientation.h>

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include <firstcontact/math/double_double.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// An exact sum of doubles without overflow, the least term first; zeros left out.
class Expansion {
 public:
  Expansion() = default;
  Expansion(const DoubleDouble& x) {
    add(x.lo);
    add(x.hi);
  }

  [[nodiscard]] const double* begin() const { return terms_.data(); }
  [[nodiscard]] const double* end() const { return terms_.data() + size_; }

  void add(double b) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const DoubleDouble s = two_sum(b, terms_[i]);
      terms_[size] = s.lo;
      size += s.lo != 0.0 ? 1 : 0;
      b = s.hi;
    }
    terms_[size] = b;
    size_ = size + (b != 0.0 ? 1 : 0);
  }
  void add(const Expansion& e, double sign) {
    for (const double a : e) {
      add(sign * a);
    }
  }

  /// The last term decides the sign: it is larger than all others together.
  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : terms_[size_ - 1] > 0.0 ? 1 : -1; }

 private:
  // A 3x3 determinant: 3 times 2 times 2 products of three sums of two terms, each with a tail.
  static constexpr std::size_t kMostTerms = 3 * 2 * 2 * 2 * 2 * 4;
  std::array<double, kMostTerms + 1> terms_;
  std::size_t size_ = 0;
};

Expansion product(const Expansion& e, const Expansion& f) {
  Expansion result;
  for (const double a : e) {
    for (const double b : f) {
      const DoubleDouble p = two_product(a, b);
      result.add(p.lo);
      result.add(p.hi);
    }
  }
  return result;
}

Expansion difference(double a, double b) { return two_sum(a, -b); }

Expansion determinant(const Expansion& a, const Expansion& b, const Expansion& c,
                      const Expansion& d) {
  Expansion result = product(a, d);
  result.add(product(b, c), -1.0);
  return result;
}

int exact_sign(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  std::array<std::array<Expansion, 3>, 3> m;
  for (int k = 0; k < 3; ++k) {
    m[0][k] = difference(b[k], a[k]);
    m[1][k] = difference(c[k], a[k]);
    m[2][k] = difference(d[k], a[k]);
  }
  Expansion result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    result.add(product(m[2][k], determinant(m[0][i], m[0][j], m[1][i], m[1][j])), 1.0);
  }
  return result.sign();
}

}  // namespace

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a;
  const Vector3d v = c - a;
  const Vector3d w = d - a;
  const double volume = w.dot(u.cross(v));
  // Six products of three factors, each rounded a few times.
  const auto permanent = [&](int i, int j) {
    return std::abs(u[i] * v[j]) + std::abs(u[j] * v[i]);
  };
  // Six products of three factors, each rounded a few times.
  const double size = std::abs(w.x()) * permanent(1, 2) + std::abs(w.y()) * permanent(2, 0) +
                      std::abs(w.z()) * permanent(0, 1);
  if (std::abs(volume) > 0x1p-49 * size && size > 0x1p-900) {
    return volume > 0.0 ? 1 : -1;
  }
  return exact_sign(a, b, c, d);
}

int orientation(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a;
  const Vector2d v = c - a;
  const double area = u.x() * v.y() - u.y() * v.x();
  const double size = std::abs(u.x() * v.y()) + std::abs(u.y() * v.x());
  if (std::abs(area) > 0x1p-49 * size && size > 0x1p-900) {
    return area > 0.0 ? 1 : -1;
  }
  return determinant(difference(b.x(), a.x()), difference(b.y(), a.y()), difference(c.x(), a.x()),
                     difference(c.y(), a.y()))
      .sign();
}

}  // namespace firstcontact::detail
