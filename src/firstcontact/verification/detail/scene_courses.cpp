#include <firstcontact/verification/detail/scene_courses.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <variant>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/scene/member_shapes.h>
#include <firstcontact/verification/detail/piece_motion.h>
#include <firstcontact/verification/detail/rigid_motion.h>

namespace firstcontact::detail {
namespace {

/// [-]  Rounding of a body's place when it is taken up or put down, by the sizes at hand.
constexpr double kTakenUp = 0x1p-40;

/// [-]  Factor that covers the roundings of the sum of a few lengths.
constexpr double kLonger = 1.0 + 0x1p-40;

IntervalTransform at_point(const Eigen::Vector3d& p) { return exact_transform({p, {1, 0, 0, 0}}); }

IntervalTransform enclosure_at(const CoveredMotions& motions, double t,
                               const Eigen::Vector3d& origin) {
  for (const auto& motion : motions) {
    if (motion->from() <= t && t <= motion->to()) {
      return motion->enclosure(t, origin);
    }
  }
  throw std::logic_error("a motion has a gap");
}

CoveredMotions overlapping(const CoveredMotions& all, const TimeSpan& window) {
  CoveredMotions motions;
  for (const auto& motion : all) {
    if (motion->from() <= window.to && window.from <= motion->to()) {
      motions.push_back(motion);
    }
  }
  return motions;
}

CoveredMotions shared(std::vector<RigidMotion> pieces) {
  CoveredMotions motions;
  for (RigidMotion& piece : pieces) {
    motions.push_back(std::make_shared<const RigidMotion>(std::move(piece)));
  }
  return motions;
}

/// [m]  Bounds how far the triangles reach from a point. It is less than the reach of their box,
/// and tracking errors count by it.
double reach_of(const Mesh& mesh, const Eigen::Vector3d& p) {
  double reach = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      reach = std::max(reach, (mesh.vertices[vertex] - p).norm());
    }
  }
  return kLonger * reach;
}

/// The pose that loading froze when a body was taken up or put down at a time.
Pose frozen_at(const LoadedScene& loaded, std::size_t body, double t, bool in_link) {
  for (const FrozenPose& frozen : frozen_poses(loaded, body)) {
    if (frozen.t == t && frozen.in_link == in_link) {
      return frozen.pose;
    }
  }
  throw std::logic_error("a body is not carried when its scene says so");
}

}  // namespace

SceneCourses::SceneCourses(const LoadedScene& loaded,
                           const std::map<std::size_t, Turnings>& turnings,
                           std::optional<std::size_t> mover)
    : loaded_(loaded) {
  const Scene& scene = loaded.scene;
  for (const Body& body : scene.bodies) {
    if (std::holds_alternative<VertexMotion>(body.motion)) {
      throw std::invalid_argument("expected rigid bodies: the vertices of \"" + body.name +
                                  "\" move");
    }
  }
  breaks_ = {0.0, 1.0};
  add_bodies();
  std::vector<bool> rests;
  for (const std::vector<Stretch>& stretches : stretches_) {
    const CoveredMotions& motions = stretches.front().motions;
    const auto* only = dynamic_cast<const RigidMotion*>(motions.front().get());
    rests.push_back(motions.size() == 1 && only != nullptr && only->rests());
  }
  if (mover) {
    rests[*mover] = false;
  }
  pairs_ = std::make_unique<const TestedPairs>(scene, rests);
  add_robots(turnings);
  first_geometry_.push_back(geometries_.size());
  attach_bodies();
  std::sort(breaks_.begin(), breaks_.end());
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

void SceneCourses::add_bodies() {
  const Scene& scene = loaded_.scene;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    first_geometry_.push_back(geometries_.size());
    add_geometry(b, shapes_of_member(loaded_, b).front().shape, {});
    Stretch stretch;
    stretch.motions =
        shared(rigid_motions(scene.bodies[b].motion, scene.duration, geometries_.back().p_GP));
    stretches_.push_back({std::move(stretch)});
  }
}

void SceneCourses::add_robots(const std::map<std::size_t, Turnings>& turnings) {
  const Scene& scene = loaded_.scene;
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    const SceneRobot& robot = scene.robots[r];
    robots_.push_back(std::make_unique<const RobotCourse>(
        robot, scene.duration, turnings.contains(r) ? turnings.at(r) : Turnings()));
    const std::vector<double>& breaks = robots_.back()->breaks();
    breaks_.insert(breaks_.end(), breaks.begin(), breaks.end());
    for (std::size_t link = 0; link < robot.model.links().size(); ++link) {
      const std::size_t member = scene.bodies.size() + links_.size();
      links_.push_back({r, link});
      first_geometry_.push_back(geometries_.size());
      for (const MemberShape& geometry : shapes_of_member(loaded_, member)) {
        add_geometry(member, geometry.shape, geometry.X_MG);
      }
    }
  }
}

void SceneCourses::add_geometry(std::size_t member, const Shape& shape, const Pose& X_MG) {
  const Mesh& mesh = shape.mesh();
  for (const CourseGeometry& other : geometries_) {
    if (&other.shape.mesh() == &mesh) {
      geometries_.push_back({member, shape, other.p_GP, other.tree,
                             exact_transform(X_MG) * at_point(other.p_GP), other.round});
      return;
    }
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const Eigen::Vector3d p_GP = 0.5 * box.min() + 0.5 * box.max();
  BoxTree tree = build_box_tree(shape, p_GP);
  tree.nodes[0].reach = std::min(tree.nodes[0].reach, reach_of(mesh, p_GP));
  geometries_.push_back({member, shape, p_GP, std::make_shared<const BoxTree>(std::move(tree)),
                         exact_transform(X_MG) * at_point(p_GP), round_set_of(shape, p_GP)});
}

void SceneCourses::attach_bodies() {
  for (std::size_t body = 0; body < stretches_.size() && !robots_.empty(); ++body) {
    stretches_[body] = stretches_of(body);
    for (const Stretch& stretch : stretches_[body]) {
      breaks_.push_back(stretch.from);
    }
  }
}

std::vector<SceneCourses::Stretch> SceneCourses::stretches_of(std::size_t body) const {
  const Scene& scene = loaded_.scene;
  const CourseGeometry& geometry = geometries_[first_geometry_[body]];
  std::vector<Stretch> stretches = stretches_[body];
  std::map<double, std::pair<std::size_t, const SceneAttachment*>> attachments;
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    for (const SceneAttachment& attached : scene.robots[r].attached) {
      if (attached.body == body) {
        attachments[attached.from_time / scene.duration] = {r, &attached};
      }
    }
  }
  const auto pose_at = [&](const Stretch& stretch, double t, const Eigen::Vector3d& origin) {
    if (!stretch.robot) {
      return enclosure_at(stretch.motions, t, origin);
    }
    return enclosure_at(robots_[*stretch.robot]->motions(std::nullopt, stretch.link,
                                                         stretch.X_LB * geometry.X_MP, t, t),
                        t, origin);
  };
  const auto require_same = [&](const Stretch& before, const Stretch& after, double t) {
    const IntervalTransform X = pose_at(before, t, Eigen::Vector3d::Zero());
    const Eigen::Vector3d origin = instant_of(X).pivot;
    const double reach = geometry.tree->nodes[0].reach;
    const double off =
        deviation_bound(pose_at(before, t, origin), pose_at(after, t, origin), reach);
    // Links are placed from the origin of the world.
    if (!(off <= kTakenUp * (origin.norm() + geometry.p_GP.norm() + reach + 1.0))) {
      throw std::logic_error("a body jumps when it is taken up or put down");
    }
  };
  for (auto next = attachments.begin(); next != attachments.end();) {
    const double from = next->first;
    const auto [robot, attached] = next->second;
    ++next;
    Stretch carried{.from = from, .to = 1.0, .robot = robot, .link = attached->link};
    const double to = attached->to_time ? *attached->to_time / scene.duration : 1.0;
    carried.to = to;
    stretches.back().to = from;
    if (attached->pose) {
      carried.X_LB = exact_transform(*attached->pose);
    } else {
      carried.X_LB = exact_transform(frozen_at(loaded_, body, from, true));
      require_same(stretches.back(), carried, from);
    }
    if (stretches.back().from == from) {
      stretches.pop_back();
    }
    stretches.push_back(carried);
    const bool is_handed_over = next != attachments.end() && next->first == to;
    if (to < 1.0 && !is_handed_over) {
      Stretch rest{.from = to};
      RigidMotion motion(to, 1.0, frozen_at(loaded_, body, to, false), {}, {}, geometry.p_GP);
      const CoveredMotions held = robots_[robot]->motions(std::nullopt, attached->link,
                                                          carried.X_LB * geometry.X_MP, to, to);
      const BodyInstant off = held.front()->around(to, 0.0, motion.position());
      motion.set_tracking(kLonger *
                          (off.tracking + off.turn_tracking * geometry.tree->nodes[0].reach));
      rest.motions = {std::make_shared<const RigidMotion>(std::move(motion))};
      require_same(carried, rest, to);
      stretches.push_back(std::move(rest));
    }
  }
  return stretches;
}

std::span<const CourseGeometry> SceneCourses::of_member(std::size_t member) const {
  return std::span(geometries_)
      .subspan(first_geometry_[member], first_geometry_[member + 1] - first_geometry_[member]);
}

bool SceneCourses::has_tracking_errors() const {
  return std::any_of(robots_.begin(), robots_.end(),
                     [](const auto& robot) { return robot->has_tracking_errors(); });
}

const SceneCourses::Stretch& SceneCourses::stretch_at(std::size_t body, double t) const {
  for (const Stretch& stretch : stretches_[body]) {
    if (t <= stretch.to) {
      return stretch;
    }
  }
  return stretches_[body].back();
}

SceneCourses::Seat SceneCourses::seat(const CourseGeometry& geometry, double t) const {
  if (geometry.member >= stretches_.size()) {
    const LinkNumber& link = links_[geometry.member - stretches_.size()];
    return {link.robot, link.link, geometry.X_MP};
  }
  const Stretch& stretch = stretch_at(geometry.member, t);
  return {stretch.robot, stretch.link, stretch.X_LB * geometry.X_MP};
}

CoveredMotions SceneCourses::seen_from(std::optional<std::size_t> frame, const Seat& seat,
                                       const CourseGeometry& geometry,
                                       const TimeSpan& window) const {
  if (seat.robot) {
    return robots_[*seat.robot]->motions(frame, seat.link, seat.X_LP, window.from, window.to);
  }
  const double middle = 0.5 * (window.from + window.to);
  return overlapping(stretch_at(geometry.member, middle).motions, window);
}

SceneCourses::PairMotions SceneCourses::motions(const CourseGeometry& A, const CourseGeometry& B,
                                                const TimeSpan& window) const {
  const double middle = 0.5 * (window.from + window.to);
  const Seat seat_A = seat(A, middle);
  const Seat seat_B = seat(B, middle);
  std::optional<std::size_t> frame;
  if (seat_A.robot && seat_A.robot == seat_B.robot) {
    frame = robots_[*seat_A.robot]->common_ancestor(seat_A.link, seat_B.link);
  }
  return {seen_from(frame, seat_A, A, window), seen_from(frame, seat_B, B, window)};
}

CoveredMotions SceneCourses::motions(const CourseGeometry& geometry, const TimeSpan& window) const {
  return seen_from(std::nullopt, seat(geometry, 0.5 * (window.from + window.to)), geometry, window);
}

Eigen::AlignedBox3d SceneCourses::swept_box(const CourseGeometry& geometry,
                                            const TimeSpan& window) const {
  const BoxNode& root = geometry.tree->nodes[0];
  Eigen::AlignedBox3d box;
  for (const auto& motion : motions(geometry, window)) {
    const double from = std::max(window.from, motion->from());
    const double to = std::min(window.to, motion->to());
    const double middle = std::clamp(0.5 * (from + to), from, to);
    const double half = kLonger * std::max(middle - from, to - middle);
    const BodyInstant now = motion->around(middle, half, Eigen::Vector3d::Zero());
    const double spin = now.spin.norm() + now.spin_error;
    const double bend = now.constant_rates ? spin * spin * now.lever : now.acceleration;
    const double turn_bend = now.constant_rates ? 0.0 : now.turn_acceleration;
    const double turned = half * spin + 0.5 * half * half * turn_bend;  // [rad]
    const double slack = geometry.shape.radius() + now.pivot_error + now.turn_error * root.reach +
                         now.tracking + now.turn_tracking * root.reach +
                         kTakenUp * (now.pivot.norm() + root.reach) + half * now.velocity_error +
                         0.5 * half * half * bend;
    const Eigen::Vector3d still =
        now.R.cwiseAbs() * root.extent + Eigen::Vector3d::Constant(turned * root.reach);
    const Eigen::Vector3d centre = now.pivot + now.R * root.centre;
    // A box around the body at its pose, grown by its turn; or around all of its rotations.
    const bool turns_far = turned > 1.0;
    const Eigen::Vector3d around = turns_far ? now.pivot : centre;
    const Eigen::Vector3d extent = turns_far ? Eigen::Vector3d::Constant(root.reach) : still;
    const Eigen::Vector3d reach =
        kLonger * (extent + half * now.velocity.cwiseAbs() + Eigen::Vector3d::Constant(slack));
    box.extend(Eigen::Vector3d(around - reach));
    box.extend(Eigen::Vector3d(around + reach));
  }
  if (box.min().allFinite() && box.max().allFinite()) {
    return box;
  }
  // A body whose numbers overflow may be anywhere.
  const Eigen::Vector3d infinite =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return {Eigen::Vector3d(-infinite), infinite};
}

}  // namespace firstcontact::detail
