#include <firstcontact/separation/detail/pair_cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/separation/detail/closest_on_triangles.h>
#include <firstcontact/separation/detail/convex_parts.h>
#include <firstcontact/separation/detail/triangles_meet.h>
#include <firstcontact/separation/detail/window_body.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [-]  Relative error of the promised distance.
constexpr double kPromiseError = 0x1p-20;

/// [-]  Relative precision of the least distance.
constexpr double kPrecision = 0.05;

/// Number of halvings of a step to find the least distance; and to prove the promise.
constexpr int kFineDepth = 24;
constexpr int kDeepest = 50;

/// [-]  Greatest fall of a gap in half of a window, by its fall in all of it.
constexpr double kLossOfHalf = 0.5;

/// Number of tests of boxes or triangles between two looks at the stop token.
constexpr std::size_t kStopInterval = 4096;

/// [-]  Factor that covers the roundings of a velocity and its consequences.
constexpr double kUp = 1.0 + 0x1p-40;

class Cover {
 public:
  Cover(const CoverBody& A, const CoverBody& B, const CoverOptions& options)
      : A_(A), B_(B), options_(options), work_left_(options.work) {
    result_.least = std::numeric_limits<double>::infinity();
    result_.seen = options.known;
  }

  CoverResult run() {
    result_.outcome = CoverOutcome::proven;
    const bool is_instant = options_.from == options_.to;
    std::size_t a = 0;
    std::size_t b = 0;
    while (result_.outcome == CoverOutcome::proven && a < A_.pieces.size() &&
           b < B_.pieces.size()) {
      const CoveredMotion& A = *A_.pieces[a];
      const CoveredMotion& B = *B_.pieces[b];
      const double end = std::min(A.to(), B.to());
      const double from = std::max({options_.from, A.from(), B.from()});
      const double to = std::min(options_.to, end);
      // Pieces that only touch the time of the proof are of no interest.
      const bool touches = !is_instant && from == to && (end == options_.from || to < end);
      if (from <= to && !touches) {
        cover(A, B, from, to);
        covered_ = true;
      }
      if (end > options_.to || (is_instant && covered_)) {
        break;
      }
      a += A.to() <= end ? 1 : 0;
      b += B.to() <= end ? 1 : 0;
    }
    if (!covered_) {
      fail(CoverOutcome::not_proven, std::max(options_.from, 0.0));
    }
    return result_;
  }

 private:
  struct NodePair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
  };
  struct Window {
    double from = 0.0;
    double to = 0.0;
    int depth = 0;
    std::vector<NodePair> pairs;  // Pairs that are not proven in it yet.
  };
  /// Numbers that hold for a whole window.
  struct Setting {
    WindowBody A;
    WindowBody B;
    double time = 0.0;   // [s]  Middle of the window.
    double half = 0.0;   // [s]
    double error = 0.0;  // [m]  Error of every gap along a direction, thickness and jumps included.
    double unit_error = 0.0;  // [m]  The same for unit vectors that are only rounded.
    double drift = 0.0;       // [m]  Sum of the errors of rounded velocities.
    double promised = 0.0;    // [m]
    double enough = 0.0;      // [m]  The promised distance, without errors.
    bool can_split = false;
    bool refines = false;  // Whether the least distance is searched for.
  };

  void cover(const CoveredMotion& A, const CoveredMotion& B, double from, double to) {
    std::vector<Window> windows{{from, to, 0, {{0, 0}}}};
    while (!windows.empty() && result_.outcome == CoverOutcome::proven) {
      const Window window = std::move(windows.back());
      windows.pop_back();
      const Setting setting = set(A, B, window);
      std::vector<NodePair> left;
      for (const NodePair& pair : window.pairs) {
        visit(pair, setting, left);
        if (result_.outcome != CoverOutcome::proven) {
          return;
        }
      }
      if (left.empty()) {
        continue;
      }
      if (!setting.can_split) {
        fail(CoverOutcome::not_proven, setting.time, setting.half);
        return;
      }
      // The earlier half is proven first.
      windows.push_back({setting.time, window.to, window.depth + 1, left});
      windows.push_back({window.from, setting.time, window.depth + 1, std::move(left)});
    }
  }

  [[nodiscard]] Setting set(const CoveredMotion& A, const CoveredMotion& B,
                            const Window& window) const {
    const double time = std::clamp(0.5 * (window.from + window.to), window.from, window.to);
    const double half = kUp * std::max(time - window.from, window.to - time);
    const Vector3d& origin = A.position();
    Setting s{WindowBody(A.around(time, half, origin), A_.tree.nodes[0].reach),
              WindowBody(B.around(time, half, origin), B_.tree.nodes[0].reach)};
    s.time = time;
    s.half = half;
    const double size = s.A.now.pivot.norm() + s.A.reach + s.B.now.pivot.norm() + s.B.reach;
    const double turn_errors = s.A.now.turn_error + s.B.now.turn_error;
    const double tracking = s.A.tracking() + s.B.tracking();
    const double rounding = s.A.error() + s.B.error() + kPositionRounding * size;
    s.unit_error = rounding + A_.jump + B_.jump + (options_.tracked > 0.0 ? 0.0 : kUp * tracking);
    // Axes of bodies are unit vectors up to the errors of their turns.
    s.error = s.unit_error + 2.0 * turn_errors * size;
    s.drift = s.A.drift(half) + s.B.drift(half);
    s.promised = options_.promised + options_.tracked * tracking;
    s.enough = enough(s);
    s.can_split = window.depth < kDeepest && window.from < time && time < window.to;
    s.refines = options_.finds_least && s.can_split && window.depth < kFineDepth;
    return s;
  }

  /// [m]  A bound that proves the promise.
  [[nodiscard]] double enough(const Setting& s) const {
    const auto beyond = [](double distance) {
      return std::nextafter(distance, std::numeric_limits<double>::infinity());
    };
    if (options_.promise == Promise::exceeded) {
      return beyond(s.promised);
    }
    const double kept = s.promised * (1.0 - kPromiseError) - 2.0 * s.error;
    return std::max(kept, beyond(std::max(0.0, options_.exceeded.value_or(0.0))));
  }

  /// [m]  The distance of the bodies is the gap of their triangles less this.
  [[nodiscard]] double thickness() const { return A_.thickness + B_.thickness; }

  /// [m]  The distance from which a bound is of no interest, once it proves the promise.
  [[nodiscard]] double fine() const {
    return options_.finds_least ? (1.0 - kPrecision) * result_.seen : 0.0;
  }

  void fail(CoverOutcome outcome, double time, double half = 0.0) {
    result_.outcome = outcome;
    result_.time = time;
    result_.half = half;
    if (outcome == CoverOutcome::not_proven) {
      result_.least = 0.0;
    }
  }

  void accept(double bound) { result_.least = std::min(result_.least, bound); }

  /// Proves the pair for the window, or leaves pairs below it to shorter windows.
  void visit(const NodePair& pair, const Setting& s, std::vector<NodePair>& left) {
    stack_.assign(1, pair);
    while (!stack_.empty() && result_.outcome == CoverOutcome::proven) {
      const NodePair next = stack_.back();
      stack_.pop_back();
      if (work_left_ == 0 || (work_left_ % kStopInterval == 0 && options_.stop.stop_requested())) {
        fail(CoverOutcome::not_proven, s.time, s.half);
        result_.ended = true;
        return;
      }
      --work_left_;
      const BoxNode& a = A_.tree.nodes[next.a];
      const BoxNode& b = B_.tree.nodes[next.b];
      if (a.is_leaf && b.is_leaf) {
        if (!(has_round() ? prove_round(a, b, s) : prove_triangles(a, b, s))) {
          left.push_back(next);
        }
      } else {
        visit_boxes(next, a, b, s, left);
      }
    }
  }

  void visit_boxes(const NodePair& pair, const BoxNode& a, const BoxNode& b, const Setting& s,
                   std::vector<NodePair>& left) {
    const double wanted = std::max(s.enough, fine());
    const GapBound gap = has_round() ? round_gap(part(A_, s.A, a), part(B_, s.B, b), s, wanted)
                                     : box_gap({s.A, a}, {s.B, b}, s, wanted);
    if (gap.least() >= wanted ||
        (gap.least() >= s.enough && !s.refines && !(gap.loss < size(a, b)))) {
      accept(gap.least());
    } else if (gap.loss < size(a, b) || !s.can_split) {
      descend(pair, a, b, s);
    } else {
      left.push_back(pair);  // It moves farther than its size.
    }
  }

  static double size(const BoxNode& a, const BoxNode& b) {
    return a.extent.norm() + b.extent.norm();
  }

  /// Puts the pairs of the larger box's children on the stack, the nearer one on top.
  void descend(const NodePair& pair, const BoxNode& a, const BoxNode& b, const Setting& s) {
    const bool splits_a = b.is_leaf || (!a.is_leaf && a.extent.norm() >= b.extent.norm());
    std::array<NodePair, 2> children{pair, pair};
    std::array<double, 2> distances{};
    for (std::uint32_t k = 0; k < 2; ++k) {
      (splits_a ? children[k].a : children[k].b) = (splits_a ? a : b).first + k;
      distances[k] = (s.A.position(A_.tree.nodes[children[k].a].centre) -
                      s.B.position(B_.tree.nodes[children[k].b].centre))
                         .squaredNorm();
    }
    const std::size_t nearer = distances[0] <= distances[1] ? 0 : 1;
    stack_.push_back(children[1 - nearer]);
    stack_.push_back(children[nearer]);
  }

  /// The best gap along the line of the centres, then along the axes of both boxes, until it is as
  /// wanted.
  [[nodiscard]] GapBound box_gap(const WindowBox& a, const WindowBox& b, const Setting& s,
                                 double wanted) const {
    const Vector3d between = b.centre - a.centre;
    GapBound best = box_gap_along(between.normalized(), a, b, s);
    for (const Matrix3d* axes : {&s.A.now.R, &s.B.now.R}) {
      for (int k = 0; k < 3 && !(best.least() >= wanted); ++k) {
        const Vector3d axis = axes->col(k);
        const GapBound gap =
            box_gap_along(axis.dot(between) < 0.0 ? Vector3d(-axis) : axis, a, b, s);
        best = gap.least() > best.least() ? gap : best;
      }
    }
    return best;
  }

  [[nodiscard]] GapBound box_gap_along(const Vector3d& n, const WindowBox& a, const WindowBox& b,
                                       const Setting& s) const {
    const double rate = std::abs(n.dot(b.velocity - a.velocity)) + a.spread(n) + b.spread(n);
    const double bend = s.A.bend(n, a.node.reach) + s.B.bend(n, b.node.reach);
    return {n.dot(b.centre - a.centre) - a.support(n) - b.support(n) - thickness() - s.error,
            fall(rate, bend, s)};
  }

  /// [m]  Bound of the fall of a gap within a window, with its `rate` in the middle.
  [[nodiscard]] static double fall(double rate, double bend, const Setting& s) {
    return kUp * (s.half * rate + 0.5 * s.half * s.half * bend) + s.drift;
  }

  [[nodiscard]] bool has_round() const { return A_.round != nullptr || B_.round != nullptr; }

  /// The part of a body below a node: its curved core, a triangle or a box.
  static ConvexPart part(const CoverBody& of, const WindowBody& body, const BoxNode& node) {
    if (of.round != nullptr) {
      return {body, of.round, node.reach};
    }
    if (node.is_leaf) {
      return {body, &of.tree.triangles[node.first], node.reach};
    }
    return {body, &node, node.reach};
  }

  /// The gap of two parts along n, less thickness and errors.
  [[nodiscard]] GapBound round_gap_along(const Vector3d& n, const ConvexPart& a,
                                         const ConvexPart& b, const Setting& s) const {
    const GapBound gap = convex_gap_along(n, a, b, s.half);
    return {gap.middle - thickness() - s.error, kUp * gap.loss + s.drift};
  }

  /// The gap along the line of the middles, then along that of the closest points.
  [[nodiscard]] GapBound round_gap(const ConvexPart& a, const ConvexPart& b, const Setting& s,
                                   double wanted) const {
    const GapBound rough = round_gap_along(unit_or_zero(b.middle() - a.middle()), a, b, s);
    if (rough.least() >= wanted) {
      return rough;
    }
    const ConvexClosest closest = closest_estimate(a, b, thickness() + s.enough);
    const GapBound fine = round_gap_along(closest.n, a, b, s);
    return fine.least() > rough.least() ? fine : rough;
  }

  /// Two leaves of which one at least is a curved core.
  bool prove_round(const BoxNode& node_a, const BoxNode& node_b, const Setting& s) {
    const ConvexPart a = part(A_, s.A, node_a);
    const ConvexPart b = part(B_, s.B, node_b);
    const ConvexClosest closest = closest_estimate(a, b, thickness() + s.enough);
    const double seen = std::max(0.0, closest.points.distance + s.error - thickness());
    if (seen < result_.seen) {
      result_.seen = seen;
      result_.seen_time = s.time;
    }
    const bool is_close =
        options_.promise == Promise::kept ? seen < s.enough : kUp * seen <= s.promised;
    if (is_close ||
        (options_.promise == Promise::exceeded && closest.points.distance <= 4.0 * s.error &&
         surely_overlap(a, b, kUp * s.error, thickness()))) {
      fail(CoverOutcome::closer, s.time);
      return true;
    }
    GapBound best = round_gap_along(closest.n, a, b, s);
    if (!(best.middle >= s.enough)) {  // Otherwise shorter windows suffice.
      offer_normals(a, b, closest.n, [&](const Vector3d& n) {
        const GapBound gap = round_gap_along(n, a, b, s);
        best = gap.least() > best.least() ? gap : best;
        return best.middle >= s.enough;
      });
    }
    if (!(best.least() >= s.enough)) {
      return false;
    }
    accept(best.least());
    return true;
  }

  bool prove_triangles(const BoxNode& a, const BoxNode& b, const Setting& s) {
    const PlacedTriangle A(s.A, A_.tree.triangles[a.first], a.reach);
    const PlacedTriangle B(s.B, B_.tree.triangles[b.first], b.reach);
    if (!options_.finds_least) {
      // Most triangles that slide along each other stay beside the plane of one of them.
      const GapBound gap = beside_a_face(A, B, s);
      if (gap.least() >= s.enough) {
        accept(gap.least());
        return true;
      }
      if (gap.middle - kLossOfHalf * gap.loss >= s.enough && s.can_split) {
        return false;  // Half of the window suffices.
      }
    }
    const PointPair closest = closest_estimate(A.corners, B.corners);
    const double seen = std::max(0.0, closest.distance + s.error - thickness());
    if (seen < result_.seen) {
      result_.seen = seen;
      result_.seen_time = s.time;
    }
    if (is_closer(A, B, closest, seen, s) ||
        (options_.promise == Promise::exceeded && closest.distance <= 4.0 * s.error &&
         surely_meet(a, b, s))) {
      fail(CoverOutcome::closer, s.time);
      return true;
    }
    const double wanted = s.refines ? std::max(s.enough, fine()) : s.enough;
    const double bound = triangle_bound(A, B, closest, s, wanted);
    if (!(bound >= wanted)) {
      return false;
    }
    accept(bound);
    return true;
  }

  /// The gap along the normals of both faces, until one proves the promise.
  [[nodiscard]] GapBound beside_a_face(const PlacedTriangle& A, const PlacedTriangle& B,
                                       const Setting& s) const {
    const Vector3d between = B.middle() - A.middle();
    GapBound best;
    for (const PlacedTriangle* face : {&A, &B}) {
      const Vector3d n = face->normal();
      const GapBound gap = triangle_gap_along(n.dot(between) < 0.0 ? Vector3d(-n) : n, A, B, s);
      best = gap.least() > best.least() ? gap : best;
      if (best.least() >= s.enough) {
        break;
      }
    }
    return best;
  }

  [[nodiscard]] bool is_closer(const PlacedTriangle& A, const PlacedTriangle& B,
                               const PointPair& closest, double seen, const Setting& s) const {
    if (options_.promise == Promise::kept) {
      return seen < s.enough;
    }
    // For two points that surely belong to the triangles. The sum of the errors is rounded, too.
    const auto surely = [&] {
      const Vector3d between =
          point_on_triangle(A.corners, closest.on_A) - point_on_triangle(B.corners, closest.on_B);
      return kUp * std::max(0.0, between.norm() + s.error - thickness()) <= s.promised;
    };
    return seen <= s.promised && surely();
  }

  /// Whether the two triangles are proven to have a point in common in the middle of the window.
  [[nodiscard]] bool surely_meet(const BoxNode& a, const BoxNode& b, const Setting& s) const {
    return triangles_meet(enclosed(s.A, A_.tree.triangles[a.first], a.reach),
                          enclosed(s.B, B_.tree.triangles[b.first], b.reach));
  }

  static IntervalTriangle enclosed(const WindowBody& body, const TrianglePoints& triangle,
                                   double from_pivot) {
    const double error = kUp * (body.now.pivot_error + body.now.turn_error * from_pivot +
                                kPositionRounding * (body.now.pivot.norm() + from_pivot));
    IntervalTriangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = inflated(enclose(body.position(triangle[k])), error);
    }
    return corners;
  }

  /// The bound of two triangles along the line of the closest points, then along the normals of the
  /// faces.
  ///
  /// Triangles may move in the planes of faces for long. Rounding may blur that line too much. Then
  /// the products of the edges two by two are tried, too, which stay precise at any small distance.
  [[nodiscard]] double triangle_bound(const PlacedTriangle& A, const PlacedTriangle& B,
                                      const PointPair& closest, const Setting& s,
                                      double wanted) const {
    const Vector3d between = closest.on_B - closest.on_A;
    const GapBound straight = triangle_gap_along(unit_or_zero(between), A, B, s);
    double best = std::max(-std::numeric_limits<double>::infinity(), straight.least());
    const auto offer = [&](const Vector3d& axis) {
      if (!(best >= wanted)) {
        best = std::max(best, triangle_gap_along(axis, A, B, s).least());
      }
    };
    const std::array<Vector3d, 2> normals{A.normal(), B.normal()};
    for (const Vector3d& n : normals) {
      offer(n.dot(between) < 0.0 ? Vector3d(-n) : n);
    }
    if (best >= wanted || straight.middle >= wanted) {
      return best;  // Shorter windows suffice.
    }
    for (const Vector3d& n : normals) {
      offer(n.dot(between) < 0.0 ? n : Vector3d(-n));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const Vector3d n = unit_or_zero(A.edge(i).cross(B.edge(j)));
        offer(n);
        offer(-n);
      }
    }
    return best;
  }

  /// The least gap of each two corners, each with its own motion.
  ///
  /// @param n  [-]  from unit_or_zero(), whatever the errors of the corners that it came from
  [[nodiscard]] GapBound triangle_gap_along(const Vector3d& n, const PlacedTriangle& A,
                                            const PlacedTriangle& B, const Setting& s) const {
    const double bend = s.A.bend(n, A.reach) + s.B.bend(n, B.reach);
    double middle = std::numeric_limits<double>::infinity();
    double least = middle;
    for (std::size_t i = 0; i < 3; ++i) {
      const double at_A = n.dot(A.corners[i]);
      const double speed_A = n.dot(A.velocities[i]);
      for (std::size_t j = 0; j < 3; ++j) {
        const double rate = std::abs(n.dot(B.velocities[j]) - speed_A);
        const double gap = n.dot(B.corners[j]) - at_A;
        const double bound = gap - fall(rate, bend, s);
        if (std::isnan(bound)) {
          return {};
        }
        middle = std::min(middle, gap);
        least = std::min(least, bound);
      }
    }
    return {middle - thickness() - s.unit_error, kUp * (middle - least)};
  }

  const CoverBody& A_;
  const CoverBody& B_;
  const CoverOptions& options_;
  std::size_t work_left_;
  bool covered_ = false;  // Whether any time was covered.
  CoverResult result_;
  std::vector<NodePair> stack_;
};

}  // namespace

CoverResult cover_pair(const CoverBody& A, const CoverBody& B, const CoverOptions& options) {
  return Cover(A, B, options).run();
}

}  // namespace firstcontact::detail
