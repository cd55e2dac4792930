#include "support/linear_query.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace firstcontact::oracle {
namespace {

using Vec = Vector3<double>;

class Generator {
 public:
  Generator(LinearFamily family, std::uint64_t seed)
      : family_(family), rng_(seed * 64 + static_cast<std::uint64_t>(family)) {}

  LinearQuery query() {
    LinearQuery q;
    q.edges = rng_() % 2 == 0;
    has_few_bits_ = tilts() || rng_() % 3 == 0;
    gap_ = random_gap();
    t_ = family_ == LinearFamily::at_end ? static_cast<double>(rng_() % 2) : time();
    place(q.edges);
    choose_velocities(q.edges);
    if (tilts()) {
      tilt(q);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      q.from[k] = at_[k] - t_ * velocity_[k];
      q.to[k] = at_[k] + (1.0 - t_) * velocity_[k];
    }
    if (!has_few_bits_ && family_ != LinearFamily::thin) {
      rotate(q);
    }
    return q;
  }

 private:
  double uniform(double low, double high) {
    const double u = static_cast<double>(rng_() >> 11) * 0x1p-53;
    const double x = low + u * (high - low);
    return has_few_bits_ ? std::round(64.0 * x) / 64.0 : x;
  }
  Vec vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  double time() {
    return has_few_bits_ ? static_cast<double>(rng_() % 1025) / 1024.0 : uniform(0, 1);
  }

  double random_gap() {
    if (rng_() % 4 == 0) {
      return 0.0;
    }
    const auto exponent = static_cast<double>(10 + rng_() % 9);
    const double size = (1.0 + static_cast<double>(rng_() % 8)) * std::pow(10.0, -exponent);
    return rng_() % 2 == 0 ? size : -size;
  }

  /// Where the features are at t_: their nearest points at the origin, but for the gap, which is
  /// along z, or along x where all is in the plane z = 0 or one passes beside the other.
  void place(bool edges) {
    const bool beside = family_ == LinearFamily::passing || family_ == LinearFamily::coplanar;
    const double s = uniform(0.125, 0.875);
    if (edges) {
      const Vec u = flat(vector());
      const Vec v = family_ == LinearFamily::parallel ? u : flat(vector());
      at_[0] = -s * u;
      at_[1] = (1.0 - s) * u;
      const double w = beside ? 0.0 : uniform(0.125, 0.875);
      at_[2] = -w * v;
      at_[3] = (1.0 - w) * v;
      shift(2, beside ? side_of(u, v) : Vec{0, 0, gap_});
      shift(3, beside ? side_of(u, v) : Vec{0, 0, gap_});
    } else {
      const Vec u = flat(vector());
      const Vec v = flat(vector());
      const double w = beside ? 0.0 : uniform(0.25, 0.75) * (1.0 - s);
      at_[0] = -s * u - w * v;
      at_[1] = (1.0 - s) * u - w * v;
      at_[2] = -s * u + (1.0 - w) * v;
      at_[3] = beside ? side_of(u, v) : Vec{0, 0, gap_};
    }
    if (family_ == LinearFamily::thin) {
      for (Vec& v : at_) {
        v.z += std::ldexp(std::round(uniform(-4, 4)), -static_cast<int>(56 + rng_() % 8));
      }
    }
  }

  [[nodiscard]] static Vec flat(Vec v) {
    v.z = 0.0;
    return v;
  }
  /// Across u, away from v, by the gap.
  [[nodiscard]] Vec side_of(const Vec& u, const Vec& v) const {
    const Vec across{-u.y, u.x, 0.0};
    return (dot(across, v) > 0.0 ? -gap_ : gap_) * across;
  }
  void shift(std::size_t k, const Vec& by) { at_[k] = at_[k] + by; }

  void choose_velocities(bool edges) {
    const Vec shared = vector();
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_B = k > (edges ? 1u : 2u);
      Vec& v = velocity_[k];
      v = vector();
      switch (family_) {
        case LinearFamily::coplanar:
          v = flat(v);
          break;
        case LinearFamily::parallel:
          v = is_B ? shared : Vec{};
          break;
        case LinearFamily::carried:
          v = shared;
          break;
        case LinearFamily::thin:
          v.z *= rng_() % 2 == 0 ? 0.0 : 0x1p-58;
          break;
        default:
          break;
      }
    }
  }

  [[nodiscard]] bool tilts() const {
    return family_ == LinearFamily::grazing || family_ == LinearFamily::tilting;
  }

  /// A tilts about the y axis, on which its nearest point is; B stays at a height, and goes across
  /// where it is to graze. With few bits all of that is exact.
  ///
  /// Derivation: A's plane, or edge, has the height a s x at the time s after t_. A corner at x = b
  /// s is gap - a b s^2 above it, and so is an edge along v from one along u, with b the rate at
  /// which they cross: b = u.x (way x v) / (u x v). So for a b < 0 the gap is least at s = 0, where
  /// it is nearest. Along the common normal it is less by the cosine of its inclination.
  void tilt(LinearQuery& q) {
    const Vec way = family_ == LinearFamily::grazing ? flat(vector()) : Vec{};
    const Vec u = at_[1] - at_[0];
    const Vec v = q.edges ? at_[3] - at_[2] : at_[2] - at_[0];
    const double area = u.x * v.y - u.y * v.x;
    const double b = q.edges && area != 0.0 ? u.x * (way.x * v.y - way.y * v.x) / area : way.x;
    const double a = b > 0.0 ? -0.5 : 0.5;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_B = k > (q.edges ? 1u : 2u);
      velocity_[k] = is_B ? way : Vec{0.0, 0.0, a * at_[k].x};
    }
    const double size = std::sqrt(dot(u, u) * dot(v, v));
    if (area == 0.0 || (family_ == LinearFamily::grazing && b == 0.0)) {
      return;
    }
    if (gap_ == 0.0 || (gap_ < 0.0 && family_ == LinearFamily::grazing && std::abs(b) > 0.01)) {
      q.built_in = BuiltIn::touch;
    } else if (gap_ > 0.0 || family_ == LinearFamily::tilting) {
      q.built_in = BuiltIn::gap;
      q.least_distance = 0.25 * std::abs(gap_) * std::abs(area) / size;
    }
  }

  /// By a rotation that is rounded, so that coordinates have all their bits.
  void rotate(LinearQuery& q) {
    const Vec axis = vector();
    const double w = uniform(-1, 1);
    const double n = w * w + dot(axis, axis);
    const Vec away = vector();
    for (auto* corners : {&q.from, &q.to}) {
      for (Vec& v : *corners) {
        const Vec c = cross(axis, v);
        v = away + (1.0 / n) * ((w * w - dot(axis, axis)) * v + (2.0 * dot(axis, v)) * axis +
                                (2.0 * w) * c);
      }
    }
  }

  LinearFamily family_;
  std::mt19937_64 rng_;
  bool has_few_bits_ = false;
  double gap_ = 0.0;
  double t_ = 0.0;
  std::array<Vec, 4> at_;
  std::array<Vec, 4> velocity_;
};

}  // namespace

LinearQuery linear_query(LinearFamily family, std::uint64_t seed) {
  return Generator(family, seed).query();
}

std::array<MovingSoup, 2> soups_of(const LinearQuery& query) {
  std::array<MovingSoup, 2> soups;
  const std::size_t split = query.edges ? 2 : 3;
  for (std::size_t k = 0; k < 4; ++k) {
    soups[k < split ? 0 : 1].vertices.push_back(query.from[k]);
    soups[k < split ? 0 : 1].to.push_back(query.to[k]);
  }
  soups[0].triangles.push_back({0, 1, split - 1});
  soups[1].triangles.push_back({0, 3 - split, 3 - split});
  return soups;
}

/// More are spent only where a tiny gap lasts.
constexpr std::size_t kWindows = 4000;

LinearTruth linear_truth(const LinearQuery& query, double tolerance) {
  LinearTruth truth;
  if (query.built_in != BuiltIn::nothing) {
    truth.touches = query.built_in == BuiltIn::touch;
    truth.is_apart = query.least_distance > tolerance;
    return truth;
  }
  const auto [A, B] = soups_of(query);
  const Truth exact = FirstContactOracle(A, B, 0.0).first_contact(kWindows);
  if (exact.kind == TruthKind::contact) {
    truth.touches = true;
    truth.t = exact.hi;
  } else {
    truth.is_apart =
        FirstContactOracle(A, B, tolerance).first_contact(kWindows).kind == TruthKind::free;
  }
  return truth;
}

}  // namespace firstcontact::oracle
