#include <firstcontact/separation/detail/triangles_meet.h>

#include <cstddef>

namespace firstcontact::detail {
namespace {

/// The sign: 1 or -1 where it is certain, else 0.
int certain_sign(const Interval& x) { return x.lower() > 0.0 ? 1 : (x.upper() < 0.0 ? -1 : 0); }

/// The side of the plane through a, b and c on which p lies.
int side(const IntervalVector3& a, const IntervalVector3& b, const IntervalVector3& c,
         const IntervalVector3& p) {
  return certain_sign(dot(cross(b - a, c - a), p - a));
}

/// Whether the segment passes through the triangle.
///
/// Its ends lie on both sides of the plane, and the line passes all three edges on one side.
bool passes_through(const IntervalVector3& from, const IntervalVector3& to,
                    const IntervalTriangle& t) {
  const int begins = side(t[0], t[1], t[2], from);
  if (begins == 0 || side(t[0], t[1], t[2], to) != -begins) {
    return false;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (side(from, to, t[k], t[(k + 1) % 3]) != -begins) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool triangles_meet(const IntervalTriangle& A, const IntervalTriangle& B) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (passes_through(A[k], A[(k + 1) % 3], B) || passes_through(B[k], B[(k + 1) % 3], A)) {
      return true;
    }
  }
  return false;
}

}  // namespace firstcontact::detail
