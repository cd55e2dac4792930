#include <firstcontact/math/interval_vector.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Geometry>

#include "support/wide.h"

namespace firstcontact {
namespace {

using oracle::Matrix3;
using oracle::Vector3;
using oracle::Wide;

constexpr int kCases = 2'000;

/// Random intervals, each with a member.
class Members {
 public:
  struct Number {
    Interval interval;
    double member = 0.0;
  };
  struct Vector {
    IntervalVector3 interval;
    Vector3<Wide> member;
  };
  struct Matrix {
    IntervalMatrix3 interval;
    Matrix3<Wide> member;
  };

  /// @param width  width of the intervals; 0 for points
  explicit Members(double width) : width_(width) {}

  Number number() {
    const double middle = uniform();
    const double lower = middle - width_ * std::abs(uniform());
    const double upper = middle + width_ * std::abs(uniform());
    return {Interval(lower, upper), width_ > 0.0 ? std::clamp(uniform(), lower, upper) : middle};
  }
  Vector vector() {
    const std::array<Number, 3> n = {number(), number(), number()};
    return {{{n[0].interval, n[1].interval, n[2].interval}},
            {n[0].member, n[1].member, n[2].member}};
  }
  Matrix matrix() {
    const std::array<Vector, 3> v = {vector(), vector(), vector()};
    return {{{v[0].interval, v[1].interval, v[2].interval}},
            {{v[0].member, v[1].member, v[2].member}}};
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(-2.0, 2.0)(random_); }

  double width_;
  std::mt19937_64 random_{1};
};

void expect_contains(const Interval& interval, const Wide& exact) {
  ASSERT_LE(interval.lower(), exact.lower());
  ASSERT_GE(interval.upper(), exact.upper());
}

void expect_contains(const IntervalVector3& interval, const Vector3<Wide>& exact) {
  expect_contains(interval.c[0], exact.x);
  expect_contains(interval.c[1], exact.y);
  expect_contains(interval.c[2], exact.z);
}

Vector3<Wide> turned(const Vector3<Wide>& axis, const Wide& angle, const Vector3<Wide>& v) {
  const Vector3<Wide> once = cross(axis, v);
  return v + sin(angle) * once + (Wide(1.0) - cos(angle)) * cross(axis, once);
}

/// All operations on random operands; hands results and exact results to `use`.
template <class Use>
void for_each_operation(double width, const Use& use) {
  Members random(width);
  for (int i = 0; i < kCases; ++i) {
    SCOPED_TRACE(i);
    const auto a = random.vector();
    const auto b = random.vector();
    const auto s = random.number();
    const auto m = random.matrix();
    const auto n = random.matrix();
    use(a.interval + b.interval, a.member + b.member);
    use(a.interval - b.interval, a.member - b.member);
    use(s.interval * a.interval, Wide(s.member) * a.member);
    use(cross(a.interval, b.interval), cross(a.member, b.member));
    use(m.interval * a.interval, m.member * a.member);
    use((m.interval * n.interval).columns[1], m.member * n.member.column[1]);
    use(transpose(m.interval).columns[2],
        Vector3<Wide>{m.member.column[0].z, m.member.column[1].z, m.member.column[2].z});
    use(rotated(a.interval, s.interval, b.interval), turned(a.member, s.member, b.member));
    const IntervalTransform X{m.interval, a.interval};
    const IntervalTransform Y{n.interval, b.interval};
    use(X * b.interval, a.member + m.member * b.member);
    use((X * Y).position, a.member + m.member * b.member);
    use(IntervalVector3{{dot(a.interval, b.interval), norm(a.interval), s.interval}},
        Vector3<Wide>{dot(a.member, b.member), norm(a.member), s.member});
    use(hull(a.interval, b.interval), a.member);
    use(hull(a.interval, b.interval), b.member);
  }
}

TEST(IntervalVector3, ContainsTheResultsOfItsMembers) {
  for (const double width : {0.0, 1e-10, 0.1, 3.0}) {
    for_each_operation(width, [](const IntervalVector3& interval, const Vector3<Wide>& exact) {
      expect_contains(interval, exact);
    });
  }
}

/// Else the entire line would do.
TEST(IntervalVector3, StaysAsNarrowAsRoundingAllows) {
  Members random(0.0);
  for (int i = 0; i < kCases; ++i) {
    const auto a = random.vector();
    const auto b = random.vector();
    const auto m = random.matrix();
    for (const IntervalVector3& v :
         {a.interval + b.interval, cross(a.interval, b.interval), m.interval * a.interval,
          rotated(a.interval, random.number().interval, b.interval)}) {
      for (const Interval& x : v.c) {
        ASSERT_LE(x.width_bound(), 1e-13);
      }
    }
    ASSERT_LE(norm(a.interval).width_bound(), 1e-14);
  }
}

TEST(IntervalTransform, IsUndoneByItsInverse) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  const IntervalTransform X{enclose(R), enclose(Eigen::Vector3d(4.0, 5.0, 6.0))};
  const Eigen::Vector3d p(0.1, 0.2, 0.3);
  const IntervalVector3 back = inverse(X) * (X * enclose(p));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(back.c[static_cast<std::size_t>(k)].midpoint(), p[k], 1e-14);
    EXPECT_LE(back.c[static_cast<std::size_t>(k)].width_bound(), 1e-13);
  }
}

}  // namespace
}  // namespace firstcontact
