#include "support/exact_chain.h"

#include <array>
#include <cstddef>
#include <stdexcept>

namespace firstcontact::oracle {
namespace {

/// 2 pi
Wide turn() { return Wide(4.0) * asin(Wide(1.0)); }

/// The polynomial through the ends' values by Newton's divided differences with repeated nodes, in
/// the variable t itself.
Wide hermite(const ExactCoordinate& q, const Wide& t) {
  const std::size_t orders = q.begin.size();
  const std::size_t n = 2 * orders;
  const Wide b(q.t_begin);
  const Wide e(q.t_end);
  const std::array<double, 3> factorial = {1.0, 1.0, 2.0};
  // table[i][k]: divided difference over nodes i ... i + k; the first `orders` nodes are b.
  std::vector<std::vector<Wide>> table(n, std::vector<Wide>(n));
  const auto node = [&](std::size_t i) { return i < orders ? b : e; };
  const Wide before = Wide(static_cast<double>(q.turns_before)) * turn();
  const Wide after = before + Wide(static_cast<double>(q.turns)) * turn();
  for (std::size_t i = 0; i < n; ++i) {
    table[i][0] = i < orders ? Wide(q.begin[0]) - before : Wide(q.end[0]) - after;
  }
  for (std::size_t k = 1; k < n; ++k) {
    for (std::size_t i = 0; i + k < n; ++i) {
      const bool same = (i < orders) == (i + k < orders);
      if (same) {
        const std::vector<double>& values = i < orders ? q.begin : q.end;
        table[i][k] = Wide(values[k]) / Wide(factorial[k]);
      } else {
        table[i][k] = (table[i + 1][k - 1] - table[i][k - 1]) / (node(i + k) - node(i));
      }
    }
  }
  Wide sum = table[0][n - 1];
  for (std::size_t k = n - 1; k-- > 0;) {
    sum = table[0][k] + (t - node(k)) * sum;
  }
  return sum;
}

Vector3<Wide> rotated(double w, const Vector3<double>& vector_part, const Vector3<Wide>& p) {
  const Vector3<Wide> v = exact(vector_part);
  const Wide scale = Wide(2.0) / (square(Wide(w)) + dot(v, v));
  const Vector3<Wide> once = cross(v, p);
  return p + scale * (Wide(w) * once + cross(v, once));
}

/// A piece of a motion whose levers lead to the body's origin.
Vector3<Wide> moved(const MotionPiece& piece, const Wide& t, const Vector3<Wide>& p) {
  const Wide s = (t - Wide(piece.t_begin)) / (Wide(piece.t_end) - Wide(piece.t_begin));
  Vector3<Wide> arm = piece.lever + piece.R * p;
  if (!piece.angle.is_zero()) {
    const Vector3<Wide> along = dot(piece.axis, arm) * piece.axis;
    const Wide angle = s * piece.angle;
    arm = along + cos(angle) * (arm - along) + sin(angle) * cross(piece.axis, arm);
  }
  return piece.pivot + s * piece.travel + arm;
}

}  // namespace

Wide ExactCoordinate::value(const Wide& t) const {
  Wide q = 0.0;
  if (coefficients.empty()) {
    q = end.empty() ? Wide(begin.at(0)) : hermite(*this, t);
  } else {
    const Wide x = t - Wide(t_begin);
    for (std::size_t j = coefficients.size(); j-- > 0;) {
      q = q * x + Wide(coefficients[j]);
    }
  }
  return Wide(multiplier) * q + Wide(offset);
}

Vector3<Wide> exact_place(const std::vector<ExactJoint>& chain, const Wide& t,
                          const Vector3<Wide>& p_LP) {
  Vector3<Wide> p = p_LP;
  for (std::size_t k = chain.size(); k-- > 0;) {
    const ExactJoint& joint = chain[k];
    const Vector3<Wide> axis = exact(joint.axis);
    const Vector3<Wide> u = (Wide(1.0) / norm(axis)) * axis;
    if (!joint.motion.empty()) {
      p = moved(joint.motion[0], t, p);
    }
    if (!joint.angle.empty()) {
      const Wide angle = joint.angle[0].value(t);
      const Vector3<Wide> along = dot(u, p) * u;
      p = along + cos(angle) * (p - along) + sin(angle) * cross(u, p);
      p = p + (Wide(joint.pitch) * angle) * u;
    }
    for (std::size_t i = 0; i < joint.slides.size(); ++i) {
      p = p + joint.slides[i].value(t) * joint.directions[i];
    }
    p = exact(joint.position) + rotated(joint.w, {joint.x, joint.y, joint.z}, p);
  }
  return p;
}

Vector3<Wide> nearly_exact_velocity(const std::vector<ExactJoint>& chain, double t,
                                    const Vector3<Wide>& p_LP) {
  const Wide dt = Wide(1.0).scaled(-70);
  const Vector3<Wide> difference =
      exact_place(chain, Wide(t) + dt, p_LP) - exact_place(chain, Wide(t), p_LP);
  return {difference.x.scaled(70), difference.y.scaled(70), difference.z.scaled(70)};
}

}  // namespace firstcontact::oracle
