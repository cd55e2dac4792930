#include <firstcontact/simulation_model/detail/sim_tie.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/joint_law.h>
#include <firstcontact/text/quantity.h>

namespace firstcontact::detail {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Pose product(const Pose& X_AB, const Pose& X_BC) {
  const Quaterniond R_AB = X_AB.rotation.normalized();
  return {X_AB.position + R_AB * X_BC.position, (R_AB * X_BC.rotation.normalized()).normalized()};
}

Pose inverse_of(const Pose& X_AB) {
  const Quaterniond R_BA = X_AB.rotation.normalized().conjugate();
  return {-(R_BA * X_AB.position), R_BA};
}

/// The name of a tie: simulation.ties[2] (a pin of "a" and the world).
std::string tie_name(const SimTie& tie, std::size_t number,
                     const std::function<std::string(std::size_t)>& name_of) {
  const auto end = [&](const TieEnd& tied) {
    return tied.body ? '"' + name_of(*tied.body) + '"' : std::string("the world");
  };
  return "simulation.ties[" + std::to_string(number) + "], a " +
         kTieTypeWords[static_cast<std::size_t>(tie.type)] + " of " + end(tie.ends[0]) + " and " +
         end(tie.ends[1]);
}

/// The defect of a tie's place; empty if there is none.
std::string wrong_place(const SimTie& tie, const TiePlace& place, double slack) {
  const double apart = place.between().norm();
  if (tie.is_joint() && apart > slack) {
    return "its points are " + detail::quantity(apart, "m") +
           " apart; move the bodies or the points, or give null in place of one of the points";
  }
  if (tie.is_inextensible() && apart > tie.length + slack) {
    return "its points are " + detail::quantity(apart, "m") +
           " apart, farther than its length of " + detail::quantity(tie.length, "m") +
           "; move the bodies, or give a greater \"length\"";
  }
  if (tie.type == TieType::cable && !(tie.length > 0.0)) {
    return "its points are the same at the start; give a \"length\"";
  }
  if (tie.type == TieType::spring && tie.length > 0.0 && !(apart > 0.0)) {
    return "its points are the same, and a spring of a length has no direction there; move one of "
           "them, or give \"length\": 0";
  }
  return {};
}

/// The frame of a hinge's or another tie's end in the first body, from its point and axis.
Pose first_frame(const Tie& tie, const Vector3d& point) {
  return {point, Quaterniond::FromTwoVectors(Vector3d::UnitZ(), tie.axis.stableNormalized())};
}

class TieMaker {
 public:
  TieMaker(const LoadedScene& linked, const std::vector<SimBody>& bodies, double slack)
      : linked_(linked), bodies_(bodies), slack_(slack) {}

  [[nodiscard]] std::vector<SimTie> make() const {
    std::vector<SimTie> ties;
    for (const Tie& tie : linked_.scene.simulation->ties) {
      ties.push_back(make(tie));
      require_free(ties.back(), ties.size() - 1);
    }
    const std::string wrong = wrong_ties(
        ties, [&](std::size_t b) { return pose(b); }, slack_,
        [&](std::size_t b) { return linked_.scene.bodies[b].name; });
    if (!wrong.empty()) {
      throw std::invalid_argument(wrong);
    }
    return ties;
  }

 private:
  [[nodiscard]] Pose pose(const std::optional<std::size_t>& body) const {
    return body ? linked_.bodies.motion(*body).pose(0.0) : Pose();
  }

  [[nodiscard]] SimTie make(const Tie& given) const {
    SimTie tie{.type = given.type};
    std::array<Vector3d, 2> points;
    for (std::size_t s = 0; s < 2; ++s) {
      tie.ends[s].body = given.bodies[s];
      points[s] = point_of(given, s);
    }
    const std::array<Pose, 2> X_WB{pose(given.bodies[0]), pose(given.bodies[1])};
    tie.ends[0].X_BT = first_frame(given, points[0]);
    // The frame of the second body is that of the first one at the start, at its own point.
    tie.ends[1].X_BT = product(inverse_of(X_WB[1]), product(X_WB[0], tie.ends[0].X_BT));
    tie.ends[1].X_BT.position = points[1];
    const double apart =
        (product(X_WB[1], tie.ends[1].X_BT).position - product(X_WB[0], tie.ends[0].X_BT).position)
            .norm();
    tie.length = given.length.value_or(apart);
    tie.stiffness = given.stiffness.value_or(0.0);
    tie.damping = given.damping;
    return tie;
  }

  /// A tied point in the frame of the body.
  [[nodiscard]] Vector3d point_of(const Tie& tie, std::size_t side) const {
    if (tie.points[side]) {
      return *tie.points[side];
    }
    const std::size_t other = 1 - side;
    if (!tie.points[other] && side == 1) {
      return Vector3d::Zero();  // The origin of the second body.
    }
    const Pose X_OP{tie.points[other].value_or(Vector3d::Zero()), Quaterniond::Identity()};
    return product(inverse_of(pose(tie.bodies[side])), product(pose(tie.bodies[other]), X_OP))
        .position;
  }

  void require_free(const SimTie& tie, std::size_t number) const {
    const bool any_is_free = std::ranges::any_of(tie.ends, [&](const TieEnd& end) {
      return end.body && bodies_[*end.body].kind == BodyKind::free;
    });
    if (!any_is_free) {
      throw std::invalid_argument(
          tie_name(tie, number, [&](std::size_t b) { return linked_.scene.bodies[b].name; }) +
          ": neither is free, so nothing can move them; give one \"dynamics\", or leave the tie "
          "out");
    }
  }

  const LoadedScene& linked_;
  const std::vector<SimBody>& bodies_;
  double slack_;
};

}  // namespace

TiePlace place_of(const SimTie& tie, const std::function<Pose(std::size_t)>& pose_of) {
  TiePlace place;
  for (std::size_t s = 0; s < 2; ++s) {
    const TieEnd& end = tie.ends[s];
    place.X_WT[s] = end.body ? product(pose_of(*end.body), end.X_BT) : end.X_BT;
  }
  return place;
}

std::vector<TieDirection> directions_of(const SimTie& tie, const TiePlace& place) {
  std::vector<TieDirection> directions;
  for (int k = 0; k < 3; ++k) {
    directions.push_back({.linear = Vector3d::Unit(k)});
  }
  if (tie.type == TieType::hinge) {
    const Eigen::Matrix3d R = place.X_WT[0].rotation.normalized().toRotationMatrix();
    directions.push_back({.angular = R.col(0)});
    directions.push_back({.angular = R.col(1)});
  }
  for (int k = 0; k < 3 && tie.type == TieType::weld; ++k) {
    directions.push_back({.angular = Vector3d::Unit(k)});
  }
  return directions;
}

std::vector<double> displacements_of(const SimTie& tie, const TiePlace& place) {
  const Vector3d d = place.between();
  std::vector<double> displacements{d.x(), d.y(), d.z()};
  if (tie.type == TieType::hinge) {
    const Eigen::Matrix3d R_A = place.X_WT[0].rotation.normalized().toRotationMatrix();
    const Vector3d axis_B = place.X_WT[1].rotation.normalized() * Vector3d::UnitZ();
    const Vector3d turned = R_A.col(2).cross(axis_B);
    displacements.push_back(R_A.col(0).dot(turned));
    displacements.push_back(R_A.col(1).dot(turned));
  }
  if (tie.type == TieType::weld) {
    const Vector3d turned = nearest_turn(
        place.X_WT[1].rotation.normalized() * place.X_WT[0].rotation.normalized().conjugate(),
        Vector3d::Zero());
    displacements.insert(displacements.end(), {turned.x(), turned.y(), turned.z()});
  }
  return displacements;
}

double elastic_energy(const SimTie& tie, const TiePlace& place) {
  if (!(tie.stiffness > 0.0)) {
    return 0.0;
  }
  const double extension = place.between().norm() - tie.length;
  return tie.type == TieType::cable && extension < 0.0
             ? 0.0
             : 0.5 * tie.stiffness * extension * extension;
}

SpringRow spring_row(const SimTie& tie, const SpringWay& way, double span) {
  const double k = tie.stiffness;
  const double c = tie.damping;
  const double phase = span * std::sqrt(k * way.inverse_mass);
  const double weight =
      fitted_weight(span * c * way.inverse_mass + std::max(0.0, phase - kGreatestPhase));
  const double lead = span * (way.is_led_by_end ? 1.0 : weight);
  // r = -span (k extension + c speed), with
  //   extension = begin + weight (flight + lead (u - speed_of_flight) - begin)
  //   speed = (1 - weight) speed_at_begin + weight u
  const double answer = span * weight * (lead * k + c);
  const double rest =
      k * (way.begin + weight * (way.flight - way.begin - lead * way.speed_of_flight)) +
      c * (1.0 - weight) * way.speed_at_begin;
  return {-span * rest / answer, 1.0 / answer, weight};
}

std::string wrong_ties(const std::vector<SimTie>& ties,
                       const std::function<Pose(std::size_t)>& pose_of, double slack,
                       const std::function<std::string(std::size_t)>& name_of) {
  for (std::size_t k = 0; k < ties.size(); ++k) {
    const std::string wrong = wrong_place(ties[k], place_of(ties[k], pose_of), slack);
    if (!wrong.empty()) {
      return tie_name(ties[k], k, name_of) + ": " + wrong;
    }
  }
  return {};
}

std::vector<SimTie> make_sim_ties(const LoadedScene& linked, const std::vector<SimBody>& bodies,
                                  double slack) {
  return TieMaker(linked, bodies, slack).make();
}

}  // namespace firstcontact::detail
