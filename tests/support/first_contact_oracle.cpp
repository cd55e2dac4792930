#include "support/first_contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "support/closest_points.h"
#include "support/exact_motion.h"

namespace firstcontact::oracle {
namespace {

constexpr double kRoundoff = 0x1p-53;
/// Covers the sums and products of `plain` positions and their projection (fewer than 32).
constexpr double kPlainError = 64.0 * kRoundoff;
constexpr double kContactSlack = 1e-20;  // [-]  Relative to the size, as the truth allows.

double length(const Vector3<double>& v) { return std::sqrt(dot(v, v)); }

/// Exact time in [0, 1]: a multiple of 2^-120.
__extension__ using Ticks = __int128;
constexpr int kTickBits = 120;

Ticks ticks(double t) {
  const double high = std::floor(std::ldexp(t, 60));
  const double low = std::ldexp(t - std::ldexp(high, -60), kTickBits);
  return (static_cast<Ticks>(high) << 60) + static_cast<Ticks>(low);
}

Wide wide(Ticks t) {
  // Three parts, each of which a double holds exactly.
  const auto part = [&](int shift) {
    return Wide(static_cast<double>(
                    static_cast<std::int64_t>((t >> shift) & ((Ticks(1) << 41) - 1))))
        .scaled(shift - kTickBits);
  };
  return part(0) + part(41) + part(82);
}

double width_upper(Ticks w) {
  return std::ldexp(static_cast<double>(w), -kTickBits) * (1.0 + 4.0 * kRoundoff);
}

/// A vector under a rotation of growing angle: constant + cos cosine + sin sine.
struct Turning {
  Vector3<Wide> constant, cosine, sine;

  Turning(const Vector3<Wide>& v, const Vector3<Wide>& axis)
      : constant(dot(axis, v) * axis), cosine(v - constant), sine(cross(axis, v)) {}

  [[nodiscard]] Vector3<Wide> at(const Wide& c, const Wide& s) const {
    return constant + c * cosine + s * sine;
  }
};

/// A body at one instant: its center, its orientation, and how fast they change.
struct BodyState {
  Vector3<Wide> center, velocity;
  Matrix3<Wide> R;
  Vector3<double> spin;     // [rad per step]  Rounded.
  Vector3<double> axis;     // Unit, rounded.
  double rate = 0.0;        // [rad per step]  Upper bound.
  Matrix3<double> R_plain;  // Rounded.
  Wide t;
  double t_plain = 0.0;
};

class Body {
 public:
  Body(const MovingSoup& soup)
      : triangles(soup.triangles), vertices(soup.vertices), center(middle(soup.vertices)) {
    for (const Vector3<double>& v : vertices) {
      offsets.push_back(v - center);
      exact_offsets.push_back(exact(v) - exact(center));
      radius = std::max(radius, length(offsets.back()) * (1.0 + 8.0 * kRoundoff));
    }
    pieces = soup.to.empty() ? motion_pieces(soup.motion, center) : follow(soup.to);
    for (const MotionPiece& piece : pieces) {
      turning_levers.emplace_back(piece.lever, piece.axis);
      std::vector<Turning> columns;
      for (const Vector3<Wide>& column : piece.R.column) {
        columns.emplace_back(column, piece.axis);
      }
      turning_columns.push_back(std::move(columns));
      levers.push_back(axis_distances(piece));
    }
  }

  [[nodiscard]] BodyState state(std::size_t k, const Wide& t) const {
    const MotionPiece& piece = pieces[k];
    const Wide duration = Wide(piece.t_end) - Wide(piece.t_begin);
    const Wide s = (t - Wide(piece.t_begin)) / duration;
    const bool turns = !piece.angle.is_zero();
    const Wide angle = s * piece.angle;
    const Wide cosine = turns ? cos(angle) : Wide(1.0);
    const Wide sine = turns ? sin(angle) : Wide(0.0);
    const Wide rate = piece.angle / duration;
    BodyState state;
    const Vector3<Wide> lever = turns ? turning_levers[k].at(cosine, sine) : piece.lever;
    state.center = piece.pivot + s * piece.travel + lever;
    state.velocity = (Wide(1.0) / duration) * piece.travel;
    state.R = piece.R;
    if (turns) {
      state.velocity = state.velocity + rate * cross(piece.axis, lever);
      for (std::size_t j = 0; j < 3; ++j) {
        state.R.column[j] = turning_columns[k][j].at(cosine, sine);
      }
    }
    for (std::size_t j = 0; j < 3; ++j) {
      state.R_plain.column[j] = nearest(state.R.column[j]);
    }
    state.axis = nearest(piece.axis);
    state.spin = nearest(rate * piece.axis);
    state.rate = rate.upper();
    state.t = t;
    state.t_plain = t.nearest();
    return state;
  }

  /// From the center, in the frame of the body.
  [[nodiscard]] Vector3<Wide> exact_offset(const BodyState& at, std::size_t vertex) const {
    return drifts.empty() ? exact_offsets[vertex] : exact_offsets[vertex] + at.t * drifts[vertex];
  }
  [[nodiscard]] Vector3<double> offset(const BodyState& at, std::size_t vertex) const {
    return drifts.empty() ? offsets[vertex] : offsets[vertex] + at.t_plain * plain_drifts[vertex];
  }

  /// Returns the drift of a deforming soup's vertex relative to the center; such a body does not
  /// turn.
  [[nodiscard]] Vector3<Wide> exact_drift(std::size_t vertex) const {
    return drifts.empty() ? Vector3<Wide>{} : drifts[vertex];
  }
  [[nodiscard]] Vector3<double> drift(std::size_t vertex) const {
    return drifts.empty() ? Vector3<double>{} : plain_drifts[vertex];
  }

  const std::vector<std::array<std::size_t, 3>> triangles;
  const std::vector<Vector3<double>> vertices;
  const Vector3<double> center;
  double radius = 0.0;
  std::vector<Vector3<double>> offsets;  // From the center, rounded.
  std::vector<Vector3<Wide>> exact_offsets;
  std::vector<MotionPiece> pieces;
  std::vector<std::vector<double>> levers;  // Upper bounds of the distance from the axis, by piece
                                            // and vertex.

 private:
  /// The center goes from the middle of the vertices to that of their places at t = 1.
  std::vector<MotionPiece> follow(const std::vector<Vector3<double>>& to) {
    MotionPiece piece = motion_pieces({}, center).front();
    piece.travel = exact(middle(to)) - exact(center);
    for (std::size_t v = 0; v < to.size(); ++v) {
      drifts.push_back(exact(to[v]) - exact(vertices[v]) - piece.travel);
      plain_drifts.push_back(nearest(drifts.back()));
      const double far = norm(exact_offsets[v] + drifts.back()).upper();
      radius = std::max(radius, far * (1.0 + 8.0 * kRoundoff));
    }
    return {piece};
  }

  static Vector3<double> middle(const std::vector<Vector3<double>>& vertices) {
    Vector3<double> low = vertices.front();
    Vector3<double> high = low;
    for (const Vector3<double>& v : vertices) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    return low + 0.5 * (high - low);
  }

  std::vector<double> axis_distances(const MotionPiece& piece) const {
    std::vector<double> distances;
    for (const Vector3<Wide>& offset : exact_offsets) {
      distances.push_back(norm(cross(piece.axis, piece.lever + piece.R * offset)).upper());
    }
    return distances;
  }

  std::vector<Vector3<Wide>> drifts;  // [m per step]
  std::vector<Vector3<double>> plain_drifts;
  std::vector<Turning> turning_levers;
  std::vector<std::vector<Turning>> turning_columns;
};

struct Pair {
  std::size_t a, b;  // Triangles.
};

/// Both bodies at one instant, in coordinates relative to A's center.
struct Instant {
  std::size_t piece_A, piece_B;
  BodyState A, B;
  Vector3<Wide> offset, approach;  // Position of B's center relative to A's, and its rate.
  Vector3<double> offset_plain, approach_plain;
};

}  // namespace

class FirstContactOracle::Search {
 public:
  Search(const MovingSoup& A, const MovingSoup& B, double margin)
      : A_(A),
        B_(B),
        radii_(Wide(A.radius) + Wide(B.radius)),
        limit_(radii_ + Wide(margin)),
        limit_upper_(limit_.upper()),
        size_(std::max({A_.radius, B_.radius, limit_upper_})),
        contact_limit_(limit_ + Wide(kContactSlack) * Wide(size_)) {
    for (std::size_t a = 0; a < A_.triangles.size(); ++a) {
      for (std::size_t b = 0; b < B_.triangles.size(); ++b) {
        all_.push_back({a, b});
      }
    }
  }

  Truth first_contact(std::size_t budget) {
    budget_ = budget;
    windows_ = 0;
    stopped_ = false;
    gave_up_ = false;
    contact_.reset();
    std::vector<double> breaks{0.0, 1.0};
    for (const Body* body : {&A_, &B_}) {
      for (const MotionPiece& piece : body->pieces) {
        breaks.push_back(piece.t_begin);
      }
    }
    std::sort(breaks.begin(), breaks.end());
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    free_until_ = 0;
    for (const double t : breaks) {
      if (!contact_ && touches(instant(t), all_)) {
        contact_ = ticks(t);
      }
    }
    for (std::size_t i = 0; i + 1 < breaks.size() && !stopped_; ++i) {
      look(ticks(breaks[i]), ticks(breaks[i + 1]), breaks[i], all_);
    }
    Truth truth;
    truth.windows = windows_;
    truth.lo = wide(free_until_).lower();
    if (contact_) {
      truth.kind = TruthKind::contact;
      truth.hi = wide(*contact_).upper();
    } else if (!gave_up_) {
      truth.kind = TruthKind::free;
    }
    return truth;
  }

  DistanceBounds distance(double t) {
    const Instant at = instant(t);
    DistanceBounds bounds{std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::infinity()};
    for (const Pair pair : nearest_pairs(at)) {
      const auto [A, B] = exact_triangles(at, pair);
      const ClosestPoints<Quad> points = closest_points(quads(A), quads(B));
      bounds.upper = std::min(bounds.upper, (witness_distance(A, B, points) - radii_).upper());
      bounds.lower = std::min(bounds.lower, (separation(A, B, points) - radii_).lower());
    }
    return {std::max(bounds.lower, 0.0), std::max(bounds.upper, 0.0)};
  }

  bool within(double t, double tolerance) {
    const Instant at = instant(t);
    for (const Pair pair : nearest_pairs(at)) {
      if (meets(at, pair, limit_ + Wide(tolerance))) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] double size() const { return size_; }

 private:
  using WideTriangle = Triangle<Wide>;

  enum class Outcome { apart, touching, open };

  static std::size_t piece_at(const Body& body, double t_begin) {
    std::size_t k = 0;
    while (k + 1 < body.pieces.size() && body.pieces[k + 1].t_begin <= t_begin) {
      ++k;
    }
    return k;
  }

  /// @param t_begin  start of the smooth piece that t belongs to
  Instant instant(const Wide& t, double t_begin) const {
    Instant at;
    at.piece_A = piece_at(A_, t_begin);
    at.piece_B = piece_at(B_, t_begin);
    at.A = A_.state(at.piece_A, t);
    at.B = B_.state(at.piece_B, t);
    at.offset = at.B.center - at.A.center;
    at.approach = at.B.velocity - at.A.velocity;
    at.offset_plain = nearest(at.offset);
    at.approach_plain = nearest(at.approach);
    return at;
  }

  Instant instant(double t) const { return instant(Wide(t), t); }

  // ---- Arithmetic in doubles, with an error bound ----

  Triangle<double> plain_A(const Instant& at, std::size_t triangle) const {
    Triangle<double> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = at.A.R_plain * A_.offset(at.A, A_.triangles[triangle][k]);
    }
    return corners;
  }

  /// Without the offset of the centers.
  Triangle<double> plain_B(const Instant& at, std::size_t triangle) const {
    Triangle<double> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = at.B.R_plain * B_.offset(at.B, B_.triangles[triangle][k]);
    }
    return corners;
  }

  [[nodiscard]] double plain_error(const Instant& at) const {
    return kPlainError * (length(at.offset_plain) + A_.radius + B_.radius);
  }

  [[nodiscard]] double speed(const Instant& at) const {
    // No vertex is more than twice the radius from where it was.
    return length(at.approach_plain) + (at.A.rate + 2.0) * A_.radius +
           (at.B.rate + 2.0) * B_.radius;
  }

  /// Along a direction n over times within h of the instant: how far B's triangle stays above A's.
  struct Gap {
    double now;    // Estimate.
    double bound;  // Proven, but for the distance of |n| from 1.
  };

  /// Of each vertex, n . p(t + s) >= n . p + s n . p' - s^2 / 2 max |n . p''|, and the acceleration
  /// of a point on a lever l about a unit axis u is at most rate^2 |n x u| |l| along n. Linear
  /// parts attain their least value at s = h or -h.
  Gap plain_gap(const Instant& at, Pair pair, const Triangle<double>& A, const Triangle<double>& B,
                const Vector3<double>& n, double h) const {
    const double bend_A = 0.5 * h * h * at.A.rate * at.A.rate * across(n, at.A.axis);
    const double bend_B = 0.5 * h * h * at.B.rate * at.B.rate * across(n, at.B.axis);
    const double base = dot(n, at.offset_plain);
    const double base_rate = dot(n, at.approach_plain);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double top = -kInfinity, top_before = -kInfinity, top_after = -kInfinity;
    double low = kInfinity, low_before = kInfinity, low_after = kInfinity;
    for (std::size_t k = 0; k < 3; ++k) {
      const double p = dot(n, A[k]);
      const double dp = h * dot(n, cross(at.A.spin, A[k]) + A_.drift(A_.triangles[pair.a][k]));
      const double bend = bend_A * A_.levers[at.piece_A][A_.triangles[pair.a][k]];
      top = std::max(top, p);
      top_before = std::max(top_before, p - dp + bend);
      top_after = std::max(top_after, p + dp + bend);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double q = base + dot(n, B[k]);
      const double dq =
          h * (base_rate + dot(n, cross(at.B.spin, B[k]) + B_.drift(B_.triangles[pair.b][k])));
      const double bend = bend_B * B_.levers[at.piece_B][B_.triangles[pair.b][k]];
      low = std::min(low, q);
      low_before = std::min(low_before, q - dq - bend);
      low_after = std::min(low_after, q + dq - bend);
    }
    const double error = plain_error(at) + kPlainError * h * speed(at);
    return {low - top, std::min(low_before - top_before, low_after - top_after) - error};
  }

  /// Upper bound of |n x u|, relative to a rounded axis.
  static double across(const Vector3<double>& n, const Vector3<double>& axis) {
    return length(cross(n, axis)) * (1.0 + 0x1p-40) + 0x1p-48;
  }

  [[nodiscard]] bool beyond_limit(double bound) const {
    return bound > limit_upper_ * (1.0 + 0x1p-45);
  }

  static bool normalize(Vector3<double>& n) {
    const double l = length(n);
    if (!(l > 1e-150)) {
      return false;
    }
    n = (1.0 / l) * n;
    return true;
  }

  // ---- Arithmetic in 256 bits ----

  std::array<WideTriangle, 2> exact_triangles(const Instant& at, Pair pair) const {
    std::array<WideTriangle, 2> result;
    for (std::size_t k = 0; k < 3; ++k) {
      result[0][k] = at.A.R * A_.exact_offset(at.A, A_.triangles[pair.a][k]);
      result[1][k] = at.offset + at.B.R * B_.exact_offset(at.B, B_.triangles[pair.b][k]);
    }
    return result;
  }

  static Triangle<Quad> quads(const WideTriangle& t) {
    return {quad(t[0]), quad(t[1]), quad(t[2])};
  }

  /// The point of these weights; nudged so that it certainly lies in the triangle.
  static Vector3<Wide> point(const WideTriangle& t, const std::array<Quad, 3>& weights) {
    Wide v = exact(weights[1]);
    Wide w = exact(weights[2]);
    if ((Wide(1.0) - v - w).is_negative()) {
      const Wide shrink = Wide(1.0) - Wide(1.0).scaled(-100);
      v = shrink * v;
      w = shrink * w;
    }
    return t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]);
  }

  static Wide witness_distance(const WideTriangle& A, const WideTriangle& B,
                               const ClosestPoints<Quad>& points) {
    return norm(point(B, points.weights_B) - point(A, points.weights_A));
  }

  /// Lower bound of the distance: the gap along the directions that the closest points suggest.
  static Wide separation(const WideTriangle& A, const WideTriangle& B,
                         const ClosestPoints<Quad>& points) {
    Wide best;
    for (const Vector3<Quad>& direction : directions(points)) {
      const Vector3<Wide> n = exact(direction);
      if (!(dot(n, n).lower() > 0.0)) {
        continue;
      }
      const Vector3<Wide> unit = (Wide(1.0) / norm(n)) * n;
      Wide gap;
      bool first = true;
      for (const Vector3<Wide>& a : A) {
        for (const Vector3<Wide>& b : B) {
          const Wide g = dot(unit, b - a);
          if (first || g.lower() < gap.lower()) {
            gap = g;
          }
          first = false;
        }
      }
      if (gap.lower() > best.lower()) {
        best = gap;
      }
    }
    return best;
  }

  static std::array<Vector3<Quad>, 3> directions(const ClosestPoints<Quad>& points) {
    return {points.difference, points.normal, Quad(-1) * points.normal};
  }

  bool meets(const Instant& at, Pair pair, const Wide& limit) const {
    const auto [A, B] = exact_triangles(at, pair);
    const ClosestPoints<Quad> points = closest_points(quads(A), quads(B));
    return (limit - witness_distance(A, B, points)).lower() >= 0.0;
  }

  /// As `look`, without rounding to doubles.
  Outcome exact_look(const Instant& at, Pair pair, const Wide& h) const {
    const auto [A, B] = exact_triangles(at, pair);
    const ClosestPoints<Quad> points = closest_points(quads(A), quads(B));
    if ((contact_limit_ - witness_distance(A, B, points)).lower() >= 0.0) {
      return Outcome::touching;
    }
    for (const Vector3<Quad>& direction : directions(points)) {
      const Vector3<Wide> n = exact(direction);
      if (dot(n, n).lower() > 0.0 && exact_apart(at, pair, A, B, n, h)) {
        return Outcome::apart;
      }
    }
    return Outcome::open;
  }

  /// As plain_gap, without its error.
  bool exact_apart(const Instant& at, Pair pair, const WideTriangle& A, const WideTriangle& B,
                   const Vector3<Wide>& n, const Wide& h) const {
    const MotionPiece& piece_A = A_.pieces[at.piece_A];
    const MotionPiece& piece_B = B_.pieces[at.piece_B];
    const Wide rate_A = piece_A.angle / (Wide(piece_A.t_end) - Wide(piece_A.t_begin));
    const Wide rate_B = piece_B.angle / (Wide(piece_B.t_end) - Wide(piece_B.t_begin));
    const Wide half_h2 = Wide(0.5) * h * h;
    const Wide bend_A = half_h2 * square(rate_A) * norm(cross(n, piece_A.axis));
    const Wide bend_B = half_h2 * square(rate_B) * norm(cross(n, piece_B.axis));
    const Wide needed = limit_ * norm(n);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3<Wide> spin_A =
          rate_A * cross(piece_A.axis, A[i]) + A_.exact_drift(A_.triangles[pair.a][i]);
      for (std::size_t j = 0; j < 3; ++j) {
        const Vector3<Wide> spin_B = rate_B * cross(piece_B.axis, B[j] - at.offset) +
                                     B_.exact_drift(B_.triangles[pair.b][j]);
        const Wide bend = bend_A * Wide(A_.levers[at.piece_A][A_.triangles[pair.a][i]]) +
                          bend_B * Wide(B_.levers[at.piece_B][B_.triangles[pair.b][j]]);
        const Wide surplus = dot(n, B[j] - A[i]) - bend - needed;
        const Wide slope = h * dot(n, at.approach + spin_B - spin_A);
        if (!(surplus + slope).is_positive() || !(surplus - slope).is_positive()) {
          return false;
        }
      }
    }
    return true;
  }

  // ---- Search ----

  /// The pairs that may attain the distance at this instant.
  std::vector<Pair> nearest_pairs(const Instant& at) const {
    std::vector<double> distances;
    double least = std::numeric_limits<double>::infinity();
    for (const Pair pair : all_) {
      distances.push_back(plain_distance(at, pair));
      least = std::min(least, distances.back());
    }
    // Closest points of bad triangles may have far larger errors than the plain error.
    const double slack = 1e-7 * size_ + 1e-3 * least;
    std::vector<Pair> near;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (distances[i] <= least + slack) {
        near.push_back(all_[i]);
      }
    }
    return near;
  }

  static Triangle<double> shifted(Triangle<double> t, const Vector3<double>& by) {
    for (Vector3<double>& corner : t) {
      corner = corner + by;
    }
    return t;
  }

  double plain_distance(const Instant& at, Pair pair) const {
    const Triangle<double> A = plain_A(at, pair.a);
    const Triangle<double> B = shifted(plain_B(at, pair.b), at.offset_plain);
    return std::sqrt(closest_points(A, B).distance2);
  }

  /// Whether contact is proven at this instant.
  bool touches(const Instant& at, const std::vector<Pair>& pairs) const {
    return std::any_of(pairs.begin(), pairs.end(), [&](Pair pair) {
      return look(at, pair, 0.0, Wide(0.0), true) == Outcome::touching;
    });
  }

  /// Whether the pair is proven apart over the times within h, or touches at the instant itself.
  ///
  /// @param exact  whether to resort to exact arithmetic for contact
  Outcome look(const Instant& at, Pair pair, double h, const Wide& exact_h, bool exact) const {
    const Triangle<double> A = plain_A(at, pair.a);
    const Triangle<double> B = plain_B(at, pair.b);
    const Vector3<double> sum = B[0] + B[1] + B[2] - A[0] - A[1] - A[2];
    Vector3<double> n = at.offset_plain + (1.0 / 3.0) * sum;
    if (normalize(n) && beyond_limit(plain_gap(at, pair, A, B, n, h).bound)) {
      return Outcome::apart;
    }
    const ClosestPoints<double> points = closest_points(A, shifted(B, at.offset_plain));
    double loss = std::numeric_limits<double>::infinity();
    for (Vector3<double> direction : {points.difference, points.normal, -1.0 * points.normal}) {
      if (normalize(direction)) {
        const Gap gap = plain_gap(at, pair, A, B, direction, h);
        if (beyond_limit(gap.bound)) {
          return Outcome::apart;
        }
        loss = std::min(loss, gap.now - gap.bound);
      }
    }
    const double room = std::sqrt(points.distance2) - limit_upper_;
    const double error = 8.0 * plain_error(at);
    // Exact arithmetic can do better only where the plain error, and not the change over the
    // window, is the cause.
    return exact && (room <= error || loss <= room + error) ? exact_look(at, pair, exact_h)
                                                            : Outcome::open;
  }

  /// Proves [begin, end] free of contact, or finds the first contact in it.
  void look(Ticks begin, Ticks end, double t_begin, const std::vector<Pair>& pairs) {
    if (contact_ && *contact_ - begin <= kResolution) {
      free_until_ = std::min(free_until_, *contact_);
      stopped_ = true;
      return;
    }
    if (++windows_ > budget_ || end - begin < kSmallestWindow) {
      stopped_ = true;
      gave_up_ = true;
      return;
    }
    const Ticks middle = begin + (end - begin) / 2;
    const Instant at = instant(wide(middle), t_begin);
    const Ticks half = end - middle;
    const double h = width_upper(half);
    const Wide exact_h = wide(half);
    std::vector<Pair> rest;
    bool met = false;
    for (const Pair pair : pairs) {
      const Outcome outcome = look(at, pair, h, exact_h, !met);
      met = met || outcome == Outcome::touching;
      if (outcome != Outcome::apart) {
        rest.push_back(pair);
      }
    }
    if (rest.empty()) {
      free_until_ = end;
      return;
    }
    if (met) {
      contact_ = middle;  // Earlier than the one before, as windows beyond that are not looked at.
    }
    look(begin, middle, t_begin, rest);
    if (!stopped_) {
      look(middle, end, t_begin, rest);
    }
  }

  static constexpr Ticks kResolution = Ticks(1) << (kTickBits - 56);
  static constexpr Ticks kSmallestWindow = Ticks(1) << (kTickBits - 96);

  Body A_;
  Body B_;
  Wide radii_;
  Wide limit_;
  double limit_upper_;
  double size_;
  Wide contact_limit_;
  std::vector<Pair> all_;

  std::size_t budget_ = 0;
  std::size_t windows_ = 0;
  bool stopped_ = false;
  bool gave_up_ = false;
  Ticks free_until_ = 0;
  std::optional<Ticks> contact_;
};

FirstContactOracle::FirstContactOracle(const MovingSoup& A, const MovingSoup& B, double margin)
    : search_(std::make_unique<Search>(A, B, margin)) {}

FirstContactOracle::~FirstContactOracle() = default;

Truth FirstContactOracle::first_contact(std::size_t window_budget) {
  return search_->first_contact(window_budget);
}

DistanceBounds FirstContactOracle::distance(double t) { return search_->distance(t); }

bool FirstContactOracle::within(double t, double tolerance) {
  return search_->within(t, tolerance);
}

double FirstContactOracle::size() const { return search_->size(); }

}  // namespace firstcontact::oracle
