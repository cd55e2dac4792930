// The links of tools in a contact loop: their places by joints, and their motions to these.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_loop_implementation.h>

namespace firstcontact {

int ContactLoop::Implementation::tool_of(std::size_t member) const {
  const int link = link_of(member);
  if (link >= 0) {
    return static_cast<int>(links_.nodes()[static_cast<std::size_t>(link)].tool);
  }
  return member < tools() ? static_cast<int>(member) : -1;
}

std::string ContactLoop::Implementation::name_of(std::size_t member) const {
  if (is_body(member)) {
    return body_of(member).name;
  }
  std::size_t link = member < tools() ? 0 : links_with_shape_[member - first_link()];
  for (const HapticTool& tool : scene_.tools) {
    if (member >= tools() && link < tool.links.size()) {
      return tool.links[link].name;
    }
    link -= member < tools() ? 0 : tool.links.size();
  }
  return scene_.tools[member].name;
}

/// Adds the links that have a shape to the members.
void ContactLoop::Implementation::begin_links() {
  links_ = detail::ToolLinks(scene_.tools);
  for (const HapticJoint& joint : links_.joints()) {
    joints_.push_back(joint.start);
  }
  detail::weigh_joints(links_, scene_.tools.front().coupling.stiffness, frames_);
  X_WL_.resize(links_.nodes().size());
  links_.place(std::span(poses_).first(tools()), joints_, X_WL_, frames_.axes);
  std::size_t number = 0;
  for (const HapticTool& tool : scene_.tools) {
    for (const HapticLink& link : tool.links) {
      if (link.shape) {
        const Shape shape = link.shape->as_triangles();
        members_.push_back({.shape = shape,
                            .reach = shape.bounds().reach + shape.radius(),
                            .friction = link.friction});
        poses_.push_back(X_WL_[number]);
        placed_.emplace_back();
        motions_.push_back(Motion::fixed(X_WL_[number]));
        links_with_shape_.push_back(number);
      }
      ++number;
    }
  }
  measure_joints();
}

namespace {

/// [m]  Finds the greatest distance of a joint from 0; its start where it has no limits.
double farthest(const HapticJoint& joint) {
  double far = std::abs(joint.start);
  for (const double limit : {joint.lower, joint.upper}) {
    far = std::isfinite(limit) ? std::max(far, std::abs(limit)) : far;
  }
  return far;
}

}  // namespace

/// Bounds the distance of points of tools from the axes that turn them, in any posture. It sums the
/// lengths of the links between, with slides as long as their limits permit.
void ContactLoop::Implementation::measure_joints() {
  reaches_.assign(joints_.size(), 0.0);
  levers_.assign(links_.nodes().size(), 0.0);
  for (std::size_t m = first_link(); m < members_.size(); ++m) {
    double lever = members_[m].shape.bounds().centre.norm() + members_[m].reach;
    for (int link = link_of(m); link >= 0;) {
      const auto number = static_cast<std::size_t>(link);
      const detail::ToolLinks::Node& node = links_.nodes()[number];
      if (node.joint >= 0) {
        const auto joint = static_cast<std::size_t>(node.joint);
        lever += std::abs(node.slide) * farthest(links_.joints()[joint]);
        reaches_[joint] =
            std::max(reaches_[joint], std::abs(node.turn) * lever + std::abs(node.slide));
        levers_[number] = std::max(levers_[number], lever);
      }
      lever += node.X_PJ.position.norm();
      link = node.parent;
    }
    const auto tool = static_cast<std::size_t>(tool_of(m));
    link_reach_ = std::max(link_reach_, lever + scene_.tools[tool].p_BC.norm());
  }
  for (std::size_t link = 0; link < levers_.size(); ++link) {
    const int parent = links_.nodes()[link].parent;
    const double before = parent < 0 ? 0.0 : levers_[static_cast<std::size_t>(parent)];
    levers_[link] = std::max(levers_[link], before);
  }
}

/// Takes over axes and joints, and the distances of links from the places that joints give them.
/// They are less than the bend of a piece of a plan, as a contact may end the piece anywhere.
void ContactLoop::Implementation::set_link_frames() {
  if (links_.nodes().empty()) {
    return;
  }
  links_.place(std::span(poses_).first(tools()), joints_, X_WL_, frames_.axes);
  std::ranges::copy(joints_, frames_.joints.begin());
  for (std::size_t m = first_link(); m < members_.size(); ++m) {
    const Pose& to = X_WL_[links_with_shape_[m - first_link()]];
    courses_[m] = {to.position - poses_[m].position,
                   detail::turn_between(poses_[m].rotation, to.rotation)};
  }
}

/// Counts the pieces into which links divide a plan.
///
/// A link's origin moves on a line and the link turns about it, each at a constant rate. So a joint
/// alone bends nothing. Joints and a tool that turn together bend, by an eighth of the product of
/// their angles times a lever. A slide that turns bends by a quarter of the product of both. In no
/// piece does a link turn by half a turn: the shortest turn to its end would be another one.
std::size_t ContactLoop::Implementation::pieces_of(const detail::ToolDisplacements& ways) const {
  const std::vector<double> turns = links_.turns(ways.joints);
  const std::vector<double> slides = links_.slides(ways.joints);
  double bend = 0.0;
  double most = 0.0;  // [rad]
  for (std::size_t link = 0; link < turns.size(); ++link) {
    const double of_tool = ways[links_.nodes()[link].tool].rotation_vector.norm();
    const double own = links_.own_turn(link, ways.joints);
    const double before = turns[link] - own;
    const double by_turns =
        0.125 *
        (link_reach_ * of_tool * of_tool +
         levers_[link] * ((2.0 * of_tool + before) * before + 2.0 * (of_tool + before) * own));
    bend = std::max(bend, by_turns + 0.25 * (of_tool + turns[link]) * slides[link]);
    most = std::max(most, of_tool + turns[link]);
  }
  const double pieces = std::ceil(std::max(std::sqrt(bend / (detail::kBendOfLinks * distance_)),
                                           most / detail::kMostTurnOfPiece));
  return static_cast<std::size_t>(std::clamp(pieces, 1.0, 1e6));
}

/// [-]  Finds the fraction of a plan in which turns of links keep the linear constraints of
/// contacts. Points sink by half of the lever times the square of the angle.
double ContactLoop::Implementation::part_within_turn(const detail::ToolDisplacements& ways) const {
  double part = 1.0;
  const auto keep = [&](double turn, double lever) {
    const double most = std::sqrt(2.0 * detail::kSinkOfTurn * distance_ / lever);
    part = turn > most ? std::min(part, most / turn) : part;
  };
  const std::vector<double> turns = links_.turns(ways.joints);
  for (std::size_t link = 0; link < turns.size(); ++link) {
    keep(ways[links_.nodes()[link].tool].rotation_vector.norm(), link_reach_);
    keep(turns[link], levers_[link]);
  }
  return part;
}

/// Sets the motions of links over a piece: from their present places to those that joints give them
/// at its end. The motions of their tools are set already.
void ContactLoop::Implementation::set_link_motions(const detail::ToolDisplacements& ways) {
  if (links_.nodes().empty()) {
    return;
  }
  std::vector<Pose> X_WB;
  for (std::size_t k = 0; k < tools(); ++k) {
    X_WB.push_back(motions_[k].pose(1.0));
  }
  std::vector<double> joints = joints_;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    joints[k] += ways.joints[k];
  }
  std::array<HapticAxis, kMostHapticLinks> axes;
  links_.place(X_WB, joints, X_WL_, axes);
  for (std::size_t m = first_link(); m < members_.size(); ++m) {
    const Pose& to = X_WL_[links_with_shape_[m - first_link()]];
    ways_[m] = {to.position - poses_[m].position,
                detail::turn_between(poses_[m].rotation, to.rotation)};
  }
}

}  // namespace firstcontact
