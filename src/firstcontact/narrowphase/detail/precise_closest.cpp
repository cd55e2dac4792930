#include <firstcontact/narrowphase/detail/precise_closest.h>

#include <limits>

namespace firstcontact::detail {
namespace {

using Type = TriangleFeature::Type;
using Vector = DoubleDoubleVector3;

bool is_positive(const DoubleDouble& x) { return x.hi > 0.0; }

DoubleDouble clamped(const DoubleDouble& x) {
  if (!(x.hi > 0.0)) {  // NaN becomes 0.
    return 0.0;
  }
  return x.hi > 1.0 || (x.hi == 1.0 && x.lo >= 0.0) ? DoubleDouble(1.0) : x;
}

Vector across(const Vector& d, const Vector& along) {
  const DoubleDouble square = dot(along, along);
  return is_positive(square) ? d - (dot(d, along) / square) * along : d;
}

/// The foot of a corner on a face: p[0] + u (p[1] - p[0]) + v (p[2] - p[0]).
struct Foot {
  DoubleDouble height;  ///< Height over the plane, in any unit.
  Vector point;
  bool is_inside = false;
};

/// A face with the vectors that its feet need.
class Face {
 public:
  explicit Face(const PreciseCorners& c)
      : corners_(c),
        u_(c.p[1] - c.p[0]),
        v_(c.p[2] - c.p[0]),
        normal_(cross(u_, v_)),
        square_(dot(normal_, normal_)) {}

  [[nodiscard]] bool has_area() const { return is_positive(square_); }

  [[nodiscard]] Foot foot(const Vector& p) const {
    const Vector r = p - corners_.p[0];
    const DoubleDouble u = dot(normal_, cross(r, v_)) / square_;
    const DoubleDouble v = dot(normal_, cross(u_, r)) / square_;
    const DoubleDouble rest = DoubleDouble(1.0) - (u + v);
    Foot foot;
    foot.height = dot(normal_, r);
    foot.is_inside = is_positive(u) && is_positive(v) && is_positive(rest);
    foot.point = corners_.p[0] + (u * u_ + v * v_);
    return foot;
  }

 private:
  const PreciseCorners& corners_;
  Vector u_;
  Vector v_;
  Vector normal_;
  DoubleDouble square_;
};

class Search {
 public:
  Search(const PreciseCorners& A, const PreciseCorners& B) : A_(A), B_(B) {
    best_.square = std::numeric_limits<double>::infinity();
  }

  PreciseClosest run() {
    for (int i = 0; i < edges(A_); ++i) {
      for (int j = 0; j < edges(B_); ++j) {
        try_edges(i, j);
      }
    }
    try_face(A_, B_, true);
    try_face(B_, A_, false);
    return best_;
  }

 private:
  static int edges(const PreciseCorners& c) { return c.count == 3 ? 3 : 1; }

  static bool is_end(const DoubleDouble& s) { return s.hi == 0.0 || (s.hi == 1.0 && s.lo == 0.0); }

  static TriangleFeature feature(const PreciseCorners& c, int edge, const DoubleDouble& s) {
    if (s.hi == 0.0) {
      return {Type::vertex, edge};
    }
    return s.hi == 1.0 && s.lo == 0.0
               ? TriangleFeature{Type::vertex, (edge + 1) % static_cast<int>(c.count)}
               : TriangleFeature{Type::edge, edge};
  }

  void offer(const Vector& d, const TriangleFeature& a, const TriangleFeature& b) {
    const DoubleDouble square = dot(d, d);
    if (square.hi < best_.square.hi) {
      best_ = {d, square, a, b};
    }
  }

  /// Finds one parameter from the parts of v and r across u; the other is the best for it.
  ///
  /// The parts across u keep their digits for nearly parallel edges.
  void try_edges(int i, int j) {
    const Vector u = edge_of(A_, i);
    const Vector v = edge_of(B_, j);
    const Vector r = B_.p[static_cast<std::size_t>(j)] - A_.p[static_cast<std::size_t>(i)];
    const DoubleDouble uu = dot(u, u);
    const DoubleDouble vv = dot(v, v);
    const DoubleDouble uv = dot(u, v);
    const DoubleDouble ur = dot(u, r);
    const DoubleDouble vr = dot(v, r);
    const Vector w = across(v, u);
    const DoubleDouble ww = dot(w, w);
    DoubleDouble t = is_positive(ww) ? clamped(-dot(across(r, u), w) / ww) : DoubleDouble(0.0);
    const DoubleDouble s = is_positive(uu) ? clamped((t * uv + ur) / uu) : DoubleDouble(0.0);
    // In other cases rounding would move t from an end of its edge.
    if (is_positive(vv) && (is_end(s) || !is_positive(ww))) {
      t = clamped((s * uv - vr) / vv);
    }
    offer((r + t * v) - s * u, feature(A_, i, s), feature(B_, j, t));
  }

  /// Corners over a face, and edges through it.
  void try_face(const PreciseCorners& S, const PreciseCorners& T, bool T_is_B) {
    if (T.count < 3) {
      return;
    }
    const Face face(T);
    if (!face.has_area()) {
      return;
    }
    const auto offer_foot = [&](const Vector& from, const Vector& foot, const TriangleFeature& of) {
      const TriangleFeature of_face{Type::face, 0};
      if (T_is_B) {
        offer(foot - from, of, of_face);
      } else {
        offer(from - foot, of_face, of);
      }
    };
    std::array<Foot, 3> feet;
    for (std::size_t k = 0; k < S.count; ++k) {
      feet[k] = face.foot(S.p[k]);
      if (feet[k].is_inside) {
        offer_foot(S.p[k], feet[k].point, {Type::vertex, static_cast<int>(k)});
      }
    }
    for (int k = 0; S.count > 1 && k < edges(S); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const DoubleDouble begin = feet[i].height;
      const DoubleDouble end = feet[(i + 1) % S.count].height;
      if ((begin.hi > 0.0) == (end.hi > 0.0)) {
        continue;
      }
      const DoubleDouble part = clamped(begin / (begin - end));
      const Vector on_edge = S.p[i] + part * edge_of(S, k);
      const Foot through = face.foot(on_edge);
      if (through.is_inside) {
        offer_foot(on_edge, through.point, feature(S, k, part));
      }
    }
  }

  const PreciseCorners& A_;
  const PreciseCorners& B_;
  PreciseClosest best_;
};

/// The product of two edges.
///
/// For nearly parallel edges it is short. Its rounding, of the size of the edges' own product, then
/// turns it. So its parts along the edges are removed again.
Vector across_both(const Vector& u, const Vector& v) {
  return across(across(cross(u, v), u), across(v, u));
}

}  // namespace

PreciseClosest precise_closest(const PreciseCorners& A, const PreciseCorners& B) {
  return Search(A, B).run();
}

DoubleDoubleVector3 precise_direction(const PreciseCorners& A, const PreciseCorners& B,
                                      const PreciseClosest& closest) {
  const Type a = closest.feature_A.type;
  const Type b = closest.feature_B.type;
  if (a == Type::face) {
    return across_both(edge_of(A, 0), edge_of(A, 1));
  }
  if (b == Type::face) {
    return across_both(edge_of(B, 0), edge_of(B, 1));
  }
  if (a == Type::edge && b == Type::edge) {
    return across_both(edge_of(A, closest.feature_A.index), edge_of(B, closest.feature_B.index));
  }
  if (a == Type::edge) {
    return across(closest.d, edge_of(A, closest.feature_A.index));
  }
  return b == Type::edge ? across(closest.d, edge_of(B, closest.feature_B.index)) : closest.d;
}

}  // namespace firstcontact::detail
