/// @file
/// Motions of every kind for the tests of the motion contract: generated ones and sudden cases.

#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "support/generated_case.h"

namespace firstcontact::oracle {

struct MotionCase {
  std::string name;
  MotionInput input;
};

inline MotionInput turning(const Vector3<double>& position,
                           const Vector3<double>& rotation_vector) {
  MotionInput m;
  m.kind = MotionKind::constant_velocity;
  m.poses[0].position = position;
  m.translation = {0.5, -0.25, 1.0};
  m.rotation_vector = rotation_vector;
  return m;
}

inline MotionInput between(MotionKind kind, const PoseInput& from, const PoseInput& to) {
  MotionInput m;
  m.kind = kind;
  m.poses = {from, to};
  return m;
}

inline MotionInput about_axis(const Vector3<double>& point, double angle, double along) {
  MotionInput m;
  m.kind = MotionKind::screw;
  m.poses[0].position = {1.0, 2.0, 3.0};
  m.axis_point = point;
  m.axis_direction = {1.0, -2.0, 0.5};
  m.angle = angle;
  m.along = along;
  return m;
}

/// Makes a motion through four poses, the second twice; at rest before 0.1 and after 0.9.
inline MotionInput tour(MotionKind kind, const Vector3<double>& origin) {
  MotionInput m;
  m.kind = kind;
  m.times = {0.1, 0.3, 0.5, 0.9};
  const PoseInput second{origin + Vector3<double>{0.0, 1.0, 0.0}, {0.3, 0.1, -0.9, 0.2}};
  m.poses = {{origin, {1.0, 0.0, 0.0, 0.0}},
             second,
             second,
             {origin + Vector3<double>{2.0, 1.0, 0.0}, {-0.3, 0.7, 0.1, 0.2}}};
  return m;
}

inline std::vector<MotionCase> sudden_motions() {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const Vector3<double> far{1e6, -2e6, 1e6};
  const PoseInput start{{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  const PoseInput half_turn{{0.0, 2.0, 0.5}, {0.0, 0.0, -1.0, 0.0}};
  const PoseInput other_half_turn{{0.0, 2.0, 0.5}, {0.0, -0.6, 0.8, 0.0}};
  const PoseInput nearly_half_turn{{0.0, 2.0, 0.5}, {1e-15, 0.0, 1.0, 0.0}};
  const PoseInput moved{{5.0, 6.0, 7.0}, {1.0, 0.0, 0.0, 0.0}};
  const PoseInput moved_negated{{5.0, 6.0, 7.0}, {-1.0, 0.0, 0.0, 0.0}};
  const PoseInput far_pose{far, {0.2, 0.4, -0.4, 0.8}};
  const MotionKind line = MotionKind::constant_velocity_between;
  const MotionKind screw = MotionKind::screw_between;
  std::vector<MotionCase> cases = {
      {"rest", {}},
      {"no rotation", turning({1.0, 2.0, 3.0}, {0.0, 0.0, 0.0})},
      {"a rotation by 1e-300", turning({1.0, 2.0, 3.0}, {0.0, 1e-300, 0.0})},
      {"a thousand turns", turning({1.0, 2.0, 3.0}, {0.0, 600.0 * kTurn, 800.0 * kTurn})},
      {"far away", turning(far, {1.0, 2.0, -1.0})},
      {"screw of a thousand turns", about_axis({0.0, 1.0, 0.0}, 1000.0 * kTurn, 2.0)},
      {"screw backwards", about_axis({0.0, 1.0, 0.0}, -1.0, -2.0)},
      {"screw without rotation", about_axis({0.0, 1.0, 0.0}, 0.0, 2.0)},
      {"screw about a far axis", about_axis(far, 1.0, 2.0)},
      {"tour", tour(MotionKind::waypoints, {0.0, 0.0, 0.0})},
      {"far tour", tour(MotionKind::waypoints, far)},
      {"screw tour", tour(MotionKind::screw_waypoints, {0.0, 0.0, 0.0})},
      {"far screw tour", tour(MotionKind::screw_waypoints, far)},
  };
  for (const MotionKind kind : {line, screw}) {
    const std::string name = kind == line ? "line" : "screw";
    cases.push_back({name + " of a half turn", between(kind, start, half_turn)});
    cases.push_back({name + " of another half turn", between(kind, start, other_half_turn)});
    cases.push_back({name + " of nearly a half turn", between(kind, start, nearly_half_turn)});
    cases.push_back({name + " without rotation", between(kind, start, moved)});
    cases.push_back({name + " to the negated quaternion", between(kind, start, moved_negated)});
    cases.push_back({name + " to itself", between(kind, start, start)});
    cases.push_back({name + " to far away", between(kind, start, far_pose)});
  }
  return cases;
}

/// Returns the motions of generated questions, `count` of each family, and the sudden ones.
inline std::vector<MotionCase> all_motions(std::uint64_t count) {
  std::vector<MotionCase> cases = sudden_motions();
  for (int f = 0; f < kFamilyCount; ++f) {
    const auto family = static_cast<Family>(f);
    for (std::uint64_t i = 0; i < count; ++i) {
      const GeneratedCase c = generate(family, i);
      const std::string label = name(family) + " " + std::to_string(i);
      cases.push_back({label + " A", c.A.motion});
      cases.push_back({label + " B", c.B.motion});
    }
  }
  return cases;
}

}  // namespace firstcontact::oracle
