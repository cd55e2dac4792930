#include <firstcontact/geometry/screw_sliding_bounds.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/geometry/screw_sliding_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After the loop over targets.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kNumbers = ScrewSlidingNode::kNumbers;
constexpr std::size_t kHalf = kNumbers / 2;
constexpr float kUnbounded = 1e30f;
constexpr float kNarrow = 0.1f;    // [rad]
constexpr float kHalfTurn = 3.0f;  // [rad]  Almost half a turn.
constexpr float kWidest = 2.5f;    // [rad]
constexpr float kMostBend = 1e6f;  // [rad]  Greater than any turn.
constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;

using DF = hn::CappedTag<float, kNumbers>;
using VF = hn::Vec<DF>;
constexpr std::size_t kLanes = hn::MaxLanes(DF());
constexpr std::size_t kParts = kNumbers / kLanes;

/// The numbers of one part.
struct Numbers {
  VF part[kParts];
};

HWY_INLINE Numbers load(const float* from) {
  Numbers numbers;
  for (std::size_t p = 0; p < kParts; ++p) {
    numbers.part[p] = hn::Load(DF(), from + p * kLanes);
  }
  return numbers;
}

HWY_INLINE void store(const Numbers& numbers, float* to) {
  for (std::size_t p = 0; p < kParts; ++p) {
    hn::Store(numbers.part[p], DF(), to + p * kLanes);
  }
}

HWY_INLINE Numbers greater(const Numbers& x, const Numbers& y) {
  Numbers most;
  for (std::size_t p = 0; p < kParts; ++p) {
    most.part[p] = hn::Max(x.part[p], y.part[p]);
  }
  return most;
}

HWY_INLINE Numbers add_scaled(const Numbers& x, const Numbers& factors, float scale) {
  Numbers sum;
  for (std::size_t p = 0; p < kParts; ++p) {
    sum.part[p] = hn::MulAdd(factors.part[p], hn::Set(DF(), scale), x.part[p]);
  }
  return sum;
}

HWY_INLINE Numbers all(float value) {
  Numbers numbers;
  for (std::size_t p = 0; p < kParts; ++p) {
    numbers.part[p] = hn::Set(DF(), value);
  }
  return numbers;
}

/// Finds the greatest numbers of the parts of a node.
HWY_INLINE Numbers greatest_of(const ScrewSlidingNode& node) {
  return greater(greater(load(node.most[0]), load(node.most[1])),
                 greater(load(node.most[2]), load(node.most[3])));
}

/// Computes the angle of a point about the axis.
template <class D>
HWY_INLINE hn::Vec<D> angle_of(D d, hn::Vec<D> x, hn::Vec<D> y) {
  const auto ax = hn::Abs(x);
  const auto ay = hn::Abs(y);
  const auto longer = hn::Max(hn::Max(ax, ay), hn::Set(d, std::numeric_limits<float>::min()));
  auto angle = hn::Atan(d, hn::Div(hn::Min(ax, ay), longer));
  angle = hn::IfThenElse(hn::Gt(ay, ax),
                         hn::Sub(hn::Set(d, 0.5f * std::numbers::pi_v<float>), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)),
                         hn::Sub(hn::Set(d, std::numbers::pi_v<float>), angle), angle);
  return hn::CopySign(angle, y);
}

/// Places some vertices, one to a lane, in cylindrical coordinates.
template <class D>
HWY_INLINE void place(D d, const double* vertices, const Eigen::Matrix3d& R,
                      const Eigen::Vector3d& p, float* radius, float* angle, float* height) {
  const hn::Rebind<float, D> df;
  hn::Vec<D> x;
  hn::Vec<D> y;
  hn::Vec<D> z;
  hn::LoadInterleaved3(d, vertices, x, y, z);
  hn::Vec<decltype(df)> placed[3];
  for (int k = 0; k < 3; ++k) {
    const auto sum = hn::MulAdd(
        hn::Set(d, R(k, 0)), x,
        hn::MulAdd(hn::Set(d, R(k, 1)), y, hn::MulAdd(hn::Set(d, R(k, 2)), z, hn::Set(d, p[k]))));
    placed[k] = hn::DemoteTo(df, sum);
  }
  const auto square = hn::MulAdd(placed[0], placed[0], hn::Mul(placed[1], placed[1]));
  hn::StoreU(hn::Sqrt(square), df, radius);
  hn::StoreU(angle_of(df, placed[0], placed[1]), df, angle);
  hn::StoreU(placed[2], df, height);
}

HWY_INLINE void place_vertices(const std::vector<Eigen::Vector3d>& vertices,
                               const Eigen::Matrix3d& R, const Eigen::Vector3d& p, float* radius,
                               float* angle, float* height) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t v = 0;
  for (; v + lanes <= vertices.size(); v += lanes) {
    place(d, vertices[v].data(), R, p, radius + v, angle + v, height + v);
  }
  const hn::CappedTag<double, 1> one;
  for (; v < vertices.size(); ++v) {
    place(one, vertices[v].data(), R, p, radius + v, angle + v, height + v);
  }
}

/// The factors of a radius, a height, an angle and the bends of a triangle in its numbers.
struct Factors {
  Numbers radius;
  Numbers height;
  Numbers angle;
  Numbers sagitta;
  Numbers bend;
  Numbers slack;

  Factors(const ScrewSliding& screw_sliding, double stray, double error, bool mirrored) {
    alignas(64) float of[6][kNumbers] = {};
    for (std::size_t k = 0; k < kNumbers; ++k) {
      const std::size_t to = mirrored ? (k + kHalf) % kNumbers : k;
      const bool is_least = k < kHalf;
      const double sign = is_least ? -1.0 : 1.0;
      if (k % kHalf == ScrewSliding::kDirections) {
        of[2][to] = static_cast<float>(sign);
        of[5][to] = 0x1p-19f;
        continue;
      }
      const Eigen::Vector2d& f = screw_sliding.directions[k % kHalf];
      const double bends = sign * f.x();
      of[0][to] = static_cast<float>(sign * f.x());
      of[1][to] = static_cast<float>(sign * f.y());
      const double pitch = k % kHalf == ScrewSliding::kHeight ? 0.0 : screw_sliding.pitch;
      of[2][to] = static_cast<float>(-sign * f.y() * pitch);
      of[3][to] = bends < 0.0 ? static_cast<float>(-bends * (1.0 + 0x1p-20)) : 0.0f;
      of[4][to] = static_cast<float>(std::abs(f.y() * pitch) * (1.0 + 0x1p-20));
      of[5][to] = static_cast<float>((slope_of(screw_sliding, k % kHalf) * stray + error) *
                                     (1.0 + 0x1p-20));
    }
    radius = load(of[0]);
    height = load(of[1]);
    angle = load(of[2]);
    sagitta = load(of[3]);
    bend = load(of[4]);
    slack = load(of[5]);
  }

  [[nodiscard]] HWY_INLINE Numbers at(float r, float z, float a) const {
    return add_scaled(add_scaled(add_scaled(all(0.0f), radius, r), height, z), angle, a);
  }
};

/// Bounds triangles and nodes from places of vertices.
class Bounder {
 public:
  HWY_INLINE Bounder(const ScrewSliding& screw_sliding, const Hierarchy& hierarchy,
                     const ScrewSlidingPath& path, bool mirrored, ScrewSlidingBounds& bounds)
      : hierarchy_(hierarchy),
        bounds_(bounds),
        factors_(screw_sliding, path.stray, bounds.error, mirrored),
        least_radius_(static_cast<float>(2.0 * screw_sliding.least_radius)),
        first_(mirrored ? kHalf : 0),
        greatest_(mirrored ? 0 : kHalf) {}

  HWY_INLINE void bound_vertices() {
    for (std::size_t v = 0; v < hierarchy_.vertices.size(); ++v) {
      store(greater(at(0, v, false), at(1, v, false)), bounds_.of_vertices[v].most);
    }
  }

  HWY_INLINE void bound_nodes(std::span<const std::uint32_t> order) {
    bound_level(0, order.size(), [&](std::size_t k) HWY_ATTR {
      return order[k] == kNoTriangle ? all(-kUnbounded) : of_triangle(order[k]);
    });
    for (std::size_t level = 1; level < ScrewSlidingBounds::kLevels; ++level) {
      const std::vector<ScrewSlidingNode>& below = bounds_.levels[level - 1];
      bound_level(level, below.size(),
                  [&](std::size_t k) HWY_ATTR { return greatest_of(below[k]); });
    }
  }

 private:
  template <class Part>
  HWY_INLINE void bound_level(std::size_t level, std::size_t count, const Part& part) {
    std::vector<ScrewSlidingNode>& nodes = bounds_.levels[level];
    nodes.resize((count + ScrewSlidingNode::kParts - 1) / ScrewSlidingNode::kParts);
    for (std::size_t k = 0; k < ScrewSlidingNode::kParts * nodes.size(); ++k) {
      store(k < count ? part(k) : all(-kUnbounded),
            nodes[k / ScrewSlidingNode::kParts].most[k % ScrewSlidingNode::kParts]);
    }
  }

  [[nodiscard]] HWY_INLINE Numbers at(std::size_t pose, std::size_t v, bool across_cut) const {
    return factors_.at(bounds_.radius[pose][v], bounds_.height[pose][v],
                       angle(pose, v, across_cut));
  }

  [[nodiscard]] HWY_INLINE float angle(std::size_t pose, std::size_t v, bool across_cut) const {
    const float angle = bounds_.angle[pose][v];
    return across_cut && angle < 0.0f ? angle + kTurn : angle;
  }

  [[nodiscard]] HWY_INLINE Numbers of_triangle(std::uint32_t triangle) const {
    const auto& t = hierarchy_.triangles[triangle];
    const Numbers corners =
        greater(greater(load(bounds_.of_vertices[t[0]].most), load(bounds_.of_vertices[t[1]].most)),
                load(bounds_.of_vertices[t[2]].most));
    alignas(64) float values[kNumbers];
    store(corners, values);
    const float wide = span(values);
    if (!(wide < kNarrow)) {
      return of_wide(t, wide > kHalfTurn);
    }
    const float sagitta = 0.125f * (1.0f + 0x1p-20f) * values[greatest_] * wide * wide;
    return with_bend(add_scaled(corners, factors_.sagitta, sagitta), values, sagitta);
  }

  /// Bounds a wide triangle: the radius of each corner is projected on the middle direction.
  ///
  /// @param across_cut  whether the triangle lies where the angle jumps, or around the axis
  [[nodiscard]] HWY_INLINE Numbers of_wide(const std::array<std::uint32_t, 3>& t,
                                           bool across_cut) const {
    Numbers most = all(-kUnbounded);
    for (const std::uint32_t v : t) {
      most = greater(most, greater(at(0, v, across_cut), at(1, v, across_cut)));
    }
    alignas(64) float values[kNumbers];
    store(most, values);
    if (!(span(values) < kWidest)) {
      return near_axis(values);
    }
    const float middle =
        0.5f * (values[kNumbers - 1] - values[kHalf - 1]) * (first_ == 0 ? 1.0f : -1.0f);
    Numbers bent = all(-kUnbounded);
    float least = values[greatest_];
    for (const std::uint32_t v : t) {
      for (std::size_t pose = 0; pose < 2; ++pose) {
        const float radius = bounds_.radius[pose][v];
        const float seen = radius * (std::cos(angle(pose, v, across_cut) - middle) - 0x1p-18f);
        least = std::min(least, seen);
        bent = greater(bent, add_scaled(at(pose, v, across_cut), factors_.sagitta, radius - seen));
      }
    }
    return with_bend(bent, values, -values[first_] - least);
  }

  /// The angle between corners, with its rounding.
  [[nodiscard]] static HWY_INLINE float span(const float* values) {
    return values[kHalf - 1] + values[kNumbers - 1] + 0x1p-18f;
  }

  /// Adds the bend of a triangle to the numbers of its corners.
  ///
  /// @param values  of the corners
  /// @param dip     [m]  how much nearer to the axis than the corners the triangle may come
  [[nodiscard]] HWY_INLINE Numbers with_bend(const Numbers& corners, const float* values,
                                             float dip) const {
    const float most = values[greatest_];
    const float least = -values[first_] - dip;
    if (!(least >= least_radius_)) {
      return near_axis(values);
    }
    const float across = most * span(values);
    const float along = most - least;
    const float circle = 0.25f * (across * across + along * along);  // Its radius squared.
    const float bend = (0.5f + 0x1p-18f) * circle / (least * least);
    if (!(bend < kMostBend)) {  // False, too, where `least` is too small to be squared.
      return near_axis(values);
    }
    return add_scaled(add_scaled(corners, factors_.bend, bend), factors_.slack, 1.0f);
  }

  /// Bounds a triangle near the axis: by its height and greatest radius only.
  [[nodiscard]] HWY_INLINE Numbers near_axis(const float* values) const {
    alignas(64) float most[kNumbers];
    store(all(kUnbounded), most);
    most[first_] = 0.0f;
    most[greatest_] = values[greatest_];
    most[first_ + 1] = values[first_ + 1];
    most[greatest_ + 1] = values[greatest_ + 1];
    return add_scaled(load(most), factors_.slack, 1.0f);
  }

  const Hierarchy& hierarchy_;
  ScrewSlidingBounds& bounds_;
  Factors factors_;
  float least_radius_;
  std::size_t first_;  // Index of the least values; the first direction is the radius.
  std::size_t greatest_;
};

void BoundScrewSliding(const ScrewSliding& screw_sliding, const Hierarchy& hierarchy,
                       std::span<const std::uint32_t> order, const ScrewSlidingPath& path,
                       bool mirrored, ScrewSlidingBounds& bounds) {
  for (std::size_t k = 0; k < 2; ++k) {
    place_vertices(hierarchy.vertices, path.R_SB[k], path.p_SB[k], bounds.radius[k].data(),
                   bounds.angle[k].data(), bounds.height[k].data());
  }
  Bounder bounder(screw_sliding, hierarchy, path, mirrored, bounds);
  bounder.bound_vertices();
  bounder.bound_nodes(order);
}

/// Whether no sum is below its limit, once `turns` is added. A NaN is not below.
HWY_INLINE bool none_below(const Numbers& a, const Numbers& b, const Numbers& turns,
                           const Numbers& least) {
  const DF d;
  auto below = hn::FirstN(d, 0);
  for (std::size_t p = 0; p < kParts; ++p) {
    const VF sum = hn::Add(hn::Add(a.part[p], b.part[p]), turns.part[p]);
    below = hn::Or(below, hn::Lt(sum, least.part[p]));
  }
  return hn::AllFalse(d, below);
}

HWY_INLINE unsigned near_after_turns(const ScrewSlidingNode& a, const ScrewSlidingNode& mirrored,
                                     const Numbers& turns, const Numbers& least) {
  unsigned lanes = 0;
  for (int i = 0; i < 4; ++i) {
    const Numbers of_a = load(a.most[i]);
    for (int j = 0; j < 4; ++j) {
      lanes |= (none_below(of_a, load(mirrored.most[j]), turns, least) ? 1u : 0u) << (4 * i + j);
    }
  }
  return lanes;
}

/// Finds near parts. Angles jump somewhere: parts on both sides of the jump are tested with one
/// turn more and one turn less as well.
unsigned NearByScrewSliding(const ScrewSlidingNode& a, const ScrewSlidingNode& mirrored,
                            const ScrewSlidingLimits& limits) {
  const Numbers least = load(limits.least.data());
  const Numbers turn = load(limits.turn.data());
  unsigned lanes = near_after_turns(a, mirrored, all(0.0f), least);
  alignas(64) float of_a[kNumbers];
  alignas(64) float of_b[kNumbers];
  store(greatest_of(a), of_a);
  store(greatest_of(mirrored), of_b);
  if (!(of_a[kHalf - 1] + of_b[kHalf - 1] + limits.turn[kHalf - 1] < limits.least[kHalf - 1])) {
    lanes |= near_after_turns(a, mirrored, turn, least);
  }
  if (!(of_a[kNumbers - 1] + of_b[kNumbers - 1] - limits.turn[kNumbers - 1] <
        limits.least[kNumbers - 1])) {
    lanes |= near_after_turns(a, mirrored, add_scaled(all(0.0f), turn, -1.0f), least);
  }
  return lanes;
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact {
namespace detail {
HWY_EXPORT(BoundScrewSliding);
HWY_EXPORT(NearByScrewSliding);
}  // namespace detail

double slope_of(const ScrewSliding& screw_sliding, std::size_t direction) {
  const Eigen::Vector2d& f = screw_sliding.directions[direction];
  const double steepness = screw_sliding.pitch / screw_sliding.least_radius;
  return std::sqrt(f.x() * f.x() + f.y() * f.y() * (1.0 + steepness * steepness)) * (1.0 + 0x1p-40);
}

void bound_screw_sliding(const ScrewSliding& screw_sliding, const Hierarchy& hierarchy,
                         std::span<const std::uint32_t> order, const ScrewSlidingPath& path,
                         bool mirrored, ScrewSlidingBounds& bounds) {
  using namespace detail;
  const double size = hierarchy.radius + std::max(path.p_SB[0].norm(), path.p_SB[1].norm());
  const double steepness = std::abs(screw_sliding.pitch) / screw_sliding.least_radius;
  bounds.error = 0x1p-19 * (size * (1.0 + steepness) + 8.0 * std::abs(screw_sliding.pitch));
  const std::size_t count = hierarchy.vertices.size();
  for (std::size_t k = 0; k < 2; ++k) {
    bounds.radius[k].resize(count);
    bounds.angle[k].resize(count);
    bounds.height[k].resize(count);
  }
  bounds.of_vertices.resize(count);
  HWY_DYNAMIC_DISPATCH(BoundScrewSliding)(screw_sliding, hierarchy, order, path, mirrored, bounds);
}

unsigned near_by_screw_sliding(const ScrewSlidingNode& a, const ScrewSlidingNode& mirrored,
                               const ScrewSlidingLimits& limits) {
  using namespace detail;
  return HWY_DYNAMIC_DISPATCH(NearByScrewSliding)(a, mirrored, limits);
}

}  // namespace firstcontact
#endif
