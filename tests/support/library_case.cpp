#include "support/library_case.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace firstcontact::oracle {
namespace {

Eigen::Vector3d vector(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

Pose pose(const PoseInput& p) {
  return {vector(p.position),
          Eigen::Quaterniond(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z)};
}

}  // namespace

Shape to_shape(const MovingSoup& soup) {
  Mesh mesh;
  for (const Vector3<double>& v : soup.vertices) {
    mesh.vertices.push_back(vector(v));
  }
  for (const auto& t : soup.triangles) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  }
  return Shape(std::move(mesh), soup.radius);
}

Motion to_motion(const MotionInput& m) {
  const Pose start = pose(m.poses.front());
  switch (m.kind) {
    case MotionKind::fixed:
      return Motion::fixed(start);
    case MotionKind::constant_velocity:
      return Motion::constant_velocity(start, vector(m.translation), vector(m.rotation_vector));
    case MotionKind::constant_velocity_between:
      return Motion::constant_velocity(start, pose(m.poses[1]));
    case MotionKind::screw:
      return Motion::screw(start, vector(m.axis_point), vector(m.axis_direction), m.angle, m.along);
    case MotionKind::screw_between:
      return Motion::screw(start, pose(m.poses[1]));
    case MotionKind::waypoints:
    case MotionKind::screw_waypoints:
      break;
  }
  std::vector<Pose> poses;
  for (const PoseInput& p : m.poses) {
    poses.push_back(pose(p));
  }
  return Motion::waypoints(
      m.times, poses,
      m.kind == MotionKind::waypoints ? Between::constant_velocity : Between::screw);
}

DeformingBody to_body(const MovingSoup& soup) {
  Shape shape = to_shape(soup);
  if (soup.to.empty()) {
    return {std::move(shape), to_motion(soup.motion)};
  }
  std::vector<Eigen::Vector3d> to;
  for (const Vector3<double>& v : soup.to) {
    to.push_back(vector(v));
  }
  return move_vertices(shape, to);
}

FirstContactResult ask_library(const GeneratedCase& c, Workspace& workspace) {
  const DeformingBody A = to_body(c.A);
  const DeformingBody B = to_body(c.B);
  FirstContactOptions options;
  options.margin = c.margin;
  options.tolerance = c.tolerance;
  options.contacts = ContactState::none;
  return first_contact({A.shape, A.X_WS}, {B.shape, B.X_WS}, workspace, options);
}

std::string describe(const char* what, const FirstContactResult& answer, const Truth& truth) {
  char text[200];
  std::snprintf(text, sizeof text, "%s: t = %.17g, tolerance used %g; truth %s [%.17g, %.17g]",
                what, answer.t, answer.tolerance_used,
                truth.kind == TruthKind::free      ? "free"
                : truth.kind == TruthKind::contact ? "contact in"
                                                   : "unknown",
                truth.lo, truth.hi);
  return text;
}

std::string verdict_complaint(const FirstContactResult& answer, const Truth& truth) {
  const bool touches = truth.kind == TruthKind::contact;
  if (touches && answer.verdict == Verdict::free) {
    return describe("missed contact", answer, truth);
  }
  if (touches && !(answer.t <= truth.hi)) {
    return describe("late", answer, truth);
  }
  if (answer.verdict == Verdict::undecided) {
    return describe("undecided", answer, truth);
  }
  if (answer.verdict == Verdict::contact_at_start && answer.t != 0.0) {
    return describe("start after t = 0", answer, truth);
  }
  return {};
}

std::string complaint(const GeneratedCase& c, const FirstContactResult& answer,
                      const Truth& truth) {
  if (std::string wrong = verdict_complaint(answer, truth); !wrong.empty()) {
    return wrong;
  }
  const bool touches = truth.kind == TruthKind::contact;
  if (answer.verdict != Verdict::free &&
      !FirstContactOracle(c.A, c.B, c.margin).within(answer.t, answer.tolerance_used)) {
    return describe("false contact", answer, truth);
  }
  // A larger tolerance is right only where no double before the contact is near enough to it.
  if (!(answer.tolerance_used <= c.tolerance) &&
      (!touches ||
       FirstContactOracle(c.A, c.B, c.margin).within(std::max(answer.t, truth.lo), c.tolerance))) {
    return describe("larger tolerance", answer, truth);
  }
  return {};
}

std::string complaint_either_way(const GeneratedCase& c, const FirstContactResult& answer,
                                 const Truth& truth, Workspace& workspace) {
  std::string wrong = complaint(c, answer, truth);
  GeneratedCase swapped = c;
  std::swap(swapped.A, swapped.B);
  const FirstContactResult other = ask_library(swapped, workspace);
  if (other.verdict != answer.verdict || other.t != answer.t) {
    wrong += " differs when swapped: t = " + std::to_string(other.t);
  }
  return wrong;
}

}  // namespace firstcontact::oracle
