#include <firstcontact/haptics_files/haptic_run.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include <firstcontact/haptics/detail/tool_links.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/version.h>

namespace firstcontact {
namespace {

RunBody run_body(const HapticMemberMotion& motion, std::size_t body) {
  RunBody made{.body = body, .X_WB = motion.X_WB};
  for (const HapticPiece& piece : motion.pieces) {
    made.pieces.push_back({.to = piece.to,
                           .X_WB = piece.X_WB,
                           .translation = piece.translation,
                           .rotation_vector = piece.rotation_vector});
  }
  return made;
}

/// Makes a contact of a run; it names the body with the smaller number first.
RunContact run_contact(const HapticTouch& touch, std::size_t other, std::size_t tool) {
  const HapticContact& contact = touch.contact;
  RunContact made{.bodies = {other, tool},
                  .feature_A = touch.feature_of_other,
                  .feature_B = touch.feature_of_tool,
                  .point = contact.point,
                  .normal = contact.normal,
                  .distance = contact.gap};
  if (tool < other) {
    made.bodies = {tool, other};
    std::swap(made.feature_A, made.feature_B);
    made.normal = -made.normal;
  }
  return made;
}

}  // namespace

HapticRun::HapticRun(const LoadedScene& loaded, const HapticSetup& setup, double contact_distance)
    : header_{.scene = loaded.scene, .version = version(), .input_digest = loaded.input_digest},
      bodies_(setup.bodies),
      links_(std::make_shared<const detail::ToolLinks>(setup.scene.tools)) {
  header_.kind = RunKind::haptics;
  header_.scene.simulation->contact_distance = contact_distance;
  header_.masses.assign(loaded.scene.bodies.size(), 0.0);
  header_.centres_of_mass.assign(loaded.scene.bodies.size(), Eigen::Vector3d::Zero());
  tools_ = setup.scene.tools.size();
  std::size_t member = tools_ + setup.scene.bodies.size();
  for (const HapticTool& tool : setup.scene.tools) {
    for (const HapticLink& link : tool.links) {
      link_bodies_.push_back(link.shape ? std::optional(bodies_[member++]) : std::nullopt);
      if (link.shape) {
        header_.masses[*link_bodies_.back()] = 1.0;  // Links turn about their origins.
      }
    }
  }
  for (std::size_t k = 0; k < tools_; ++k) {
    header_.masses[bodies_[k]] = 1.0;
    header_.centres_of_mass[bodies_[k]] = setup.scene.tools[k].p_BC;
  }
}

std::vector<RunDevice> HapticRun::devices(const ForceTick& tick) const {
  std::array<Pose, kMostTools> targets;
  std::array<Pose, kMostHapticLinks> X_WL;
  std::array<HapticAxis, kMostHapticLinks> axes;
  for (std::size_t k = 0; k < tools_; ++k) {
    targets[k] = tick.tools[k].target;
  }
  links_->place(targets, std::span(tick.joint_targets).first(tick.joints), X_WL, axes);
  std::vector<RunDevice> made;
  for (std::size_t k = 0; k < tools_; ++k) {
    const ToolTick& tool = tick.tools[k];
    made.push_back({.body = bodies_[k],
                    .X_WB = tool.target,
                    .force = tool.device_force_W(),
                    .torque = tool.torque_W});
    for (std::size_t link = 0; link < link_bodies_.size(); ++link) {
      if (link_bodies_[link] && links_->nodes()[link].tool == k) {
        made.back().links.push_back({.body = *link_bodies_[link], .X_WB = X_WL[link]});
      }
    }
    std::ranges::sort(made.back().links, {}, &RunDeviceLink::body);
  }
  std::ranges::sort(made, {}, &RunDevice::body);
  return made;
}

RunStep HapticRun::step(const HapticCycle& cycle, std::vector<RunDevice> devices) {
  time_ += cycle.asked;
  behind_ += cycle.asked - cycle.lasted;
  RunStep step{.index = ++count_,
               .time = time_,
               .lasted = cycle.asked,
               .clearance = cycle.clearance,
               .events = cycle.rounds,
               .devices = std::move(devices)};
  for (const HapticMemberMotion& motion : cycle.members) {
    RunBody& body = step.bodies.emplace_back(run_body(motion, bodies_[motion.member]));
    const bool has_course = !(header_.masses[body.body] > 0.0);
    body.behind = has_course ? behind_ : 0.0;
  }
  std::ranges::sort(step.bodies, {}, &RunBody::body);
  for (const HapticTouch& touch : cycle.touches) {
    const auto [other, tool] = touch.members;
    step.contacts.push_back(run_contact(touch, bodies_[other], bodies_[tool]));
  }
  std::ranges::sort(step.contacts, {}, [](const RunContact& c) {
    return std::tuple(c.bodies, c.feature_A.type, c.feature_A.index, c.feature_B.type,
                      c.feature_B.index);
  });
  return step;
}

}  // namespace firstcontact
