#include <firstcontact/narrowphase/convex_closest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/detail/difference_simplex.h>
#include <firstcontact/narrowphase/detail/flat_direction.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Most rounds of a search; smooth bodies that nearly touch take a dozen.
constexpr int kMostRounds = 64;

/// [-]  Relative to the sizes; gaps and distances count as equal below it.
constexpr double kRounding = 0x1p-50;

/// A difference b - a of points of both cores.
struct Difference {
  Vector3d own_A;  // Points in the cores' own frames.
  Vector3d own_B;
  Vector3d a;  // Points as placed.
  Vector3d b;
};

class Search {
 public:
  Search(const PlacedConvex& A, const PlacedConvex& B, const ConvexWanted& wanted)
      : A_(A),
        B_(B),
        wanted_(wanted),
        rounding_(kRounding * (A.core.reach + B.core.reach + (B.centre - A.centre).norm())) {}

  ConvexClosest run(ConvexGuess& guess) {
    begin(guess);
    best_.distance = std::numeric_limits<double>::infinity();
    while (true) {
      simplex_.reduce();
      take_points();
      ++best_.rounds;
      if (best_.distance <= wanted_.close || best_.rounds >= kMostRounds ||
          simplex_.holds_origin() || !is_nearer_ || !look_along(simplex_.direction())) {
        break;
      }
      if (is_good() || is_known()) {
        break;
      }
      add(next_);
    }
    if (best_.n.isZero()) {
      (void)look_along(simplex_.direction());
    }
    try_flat_directions();
    keep(guess);
    return best_;
  }

 private:
  [[nodiscard]] Difference support(const Vector3d& n) const {
    Difference d;
    d.own_A = A_.core.support_point(A_.to_own_axes(n));
    d.own_B = B_.core.support_point(-B_.to_own_axes(n));
    d.a = A_.to_frame(d.own_A);
    d.b = B_.to_frame(d.own_B);
    return d;
  }

  void add(const Difference& d) { at_[simplex_.add(d.b - d.a)] = d; }

  void begin(const ConvexGuess& guess) {
    for (std::size_t k = 0; k < guess.count; ++k) {
      add({guess.p_A[k], guess.p_B[k], A_.to_frame(guess.p_A[k]), B_.to_frame(guess.p_B[k])});
    }
    if (guess.count == 0) {
      add(support(guess.n));
    }
  }

  /// Takes the points of both cores that belong to the simplex's nearest point.
  void take_points() {
    Vector3d a = Vector3d::Zero();
    Vector3d b = Vector3d::Zero();
    for (std::size_t k = 0; k < simplex_.count(); ++k) {
      const auto& [place, share] = simplex_.corner(k);
      a += share * at_[place].a;
      b += share * at_[place].b;
    }
    const double distance = (b - a).norm();
    is_nearer_ = distance < best_.distance;
    if (is_nearer_) {
      best_.p_A = a;
      best_.p_B = b;
      best_.distance = distance;
    }
  }

  /// Looks along v, and sets `next_` to the difference least far along it. False where v is zero.
  bool look_along(const Vector3d& v) {
    const double length = v.norm();
    if (!(length > 0.0)) {
      return false;
    }
    const Vector3d n = v / length;
    next_ = support(n);
    const double gap = n.dot(next_.b - next_.a);
    if (gap > best_.gap || best_.n.isZero()) {
      best_.gap = gap;
      best_.n = n;
    }
    return true;
  }

  /// Tries the exact normals of flat faces and straight lines near the best direction.
  ///
  /// The search finds such a normal only approximately, and a small tilt loses the gap of a large
  /// face.
  void try_flat_directions() {
    if (best_.n.isZero() || !(best_.distance - best_.gap > rounding_)) {
      return;
    }
    const Vector3d flat_A = detail::flat_direction(A_.core, A_.to_own_axes(best_.n));
    if (!flat_A.isZero(0.0)) {
      (void)look_along(A_.R * flat_A);
    }
    const Vector3d flat_B = detail::flat_direction(B_.core, -B_.to_own_axes(best_.n));
    if (!flat_B.isZero(0.0)) {
      (void)look_along(-(B_.R * flat_B));
    }
  }

  [[nodiscard]] bool is_good() const {
    const double beyond = best_.gap - wanted_.least;
    return best_.distance - best_.gap <= rounding_ ||
           (beyond > 0.0 && wanted_.near < 1.0 &&
            beyond >= wanted_.near * (best_.distance - wanted_.least));
  }

  /// Whether the next difference is a corner already, so that nothing is gained.
  [[nodiscard]] bool is_known() const {
    for (std::size_t k = 0; k < simplex_.count(); ++k) {
      const Difference& d = at_[simplex_.corner(k).place];
      if (d.a == next_.a && d.b == next_.b) {
        return true;
      }
    }
    return false;
  }

  void keep(ConvexGuess& guess) const {
    guess.count = simplex_.holds_origin() ? 0 : simplex_.count();
    for (std::size_t k = 0; k < guess.count; ++k) {
      const Difference& d = at_[simplex_.corner(k).place];
      guess.p_A[k] = d.own_A;
      guess.p_B[k] = d.own_B;
    }
    if (!best_.n.isZero()) {
      guess.n = best_.n;
    }
  }

  const PlacedConvex& A_;
  const PlacedConvex& B_;
  const ConvexWanted& wanted_;
  double rounding_;
  detail::DifferenceSimplex simplex_;
  std::array<Difference, 4> at_;
  Difference next_;
  bool is_nearer_ = false;  // Whether this round came nearer than all before.
  ConvexClosest best_;
};

}  // namespace

ConvexClosest closest_points(const PlacedConvex& A, const PlacedConvex& B,
                             const ConvexWanted& wanted, ConvexGuess& guess) {
  return Search(A, B, wanted).run(guess);
}

}  // namespace firstcontact
