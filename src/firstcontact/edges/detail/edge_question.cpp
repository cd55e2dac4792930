#include <firstcontact/edges/detail/edge_question.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace firstcontact::detail {
namespace {

/// Whether a coordinate of the space moves a joint, or the one that it mimics.
bool is_planned(const ConfigurationSpace& space, std::size_t mover, std::size_t joint) {
  const RobotModel& model = space.model(mover);
  while (model.joints()[joint].mimic) {
    joint = model.find_joint(model.joints()[joint].mimic->joint).value();
  }
  const auto is_of_joint = [&](const auto& one) {
    return one.mover == mover && one.joint == joint;
  };
  return std::ranges::any_of(space.coordinates(), is_of_joint) ||
         std::ranges::any_of(space.poses(), is_of_joint);
}

bool is_moved(const PlanScene& plan, std::size_t mover, std::size_t link) {
  const RobotModel& model = plan.space.model(mover);
  bool moves = plan.space.is_body(mover) || plan.times.has_value();
  for (auto joint = model.parent_joint(link); joint && !moves;
       joint = model.parent_joint(model.parent_link(*joint))) {
    moves = is_planned(plan.space, mover, *joint);
  }
  return moves;
}

}  // namespace

std::vector<bool> moved_members(const PlanScene& plan) {
  std::vector<bool> moved(plan.scene.size(), false);
  for (std::size_t member = 0; member < moved.size(); ++member) {
    const std::optional<RobotLink> link = plan.scene.robot_link(member);
    const std::optional<std::size_t> mover = link ? plan.mover(link->robot) : std::nullopt;
    moved[member] = mover && is_moved(plan, *mover, link->link);
  }
  for (const Attachment& attachment : plan.scene.attachments()) {
    if (moved[attachment.link]) {
      moved[attachment.body] = true;
    }
  }
  return moved;
}

RobotScene scene_of_edges(const PlanScene& plan, double extra) {
  RobotScene scene = plan.scene;
  const std::vector<bool> moved = moved_members(plan);
  std::vector<std::size_t> others;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    scene.set_padding(member, scene.padding(member) + 0.5 * extra);
    if (!moved[member]) {
      others.push_back(member);
    }
  }
  const std::size_t group = scene.rules().add_group(std::move(others));
  scene.rules().ignore_groups(group, group);
  return scene;
}

RobotScene scene_of_edges(const PlanScene& plan, double extra, std::span<const HeldPair> held) {
  RobotScene scene = scene_of_edges(plan, extra);
  for (const HeldPair& pair : held) {
    scene.rules().ignore(pair.members);
  }
  return scene;
}

RobotScene scene_of_held(const PlanScene& plan, double extra, std::span<const HeldPair> held) {
  RobotScene scene = plan.scene;
  std::set<std::size_t> members;
  std::set<BodyPair> pairs;
  for (const HeldPair& pair : held) {
    members.insert(pair.members.begin(), pair.members.end());
    pairs.insert(pair.members);
    scene.rules().set_margin(pair.members, pair.distance + std::min(extra, pair.tolerance));
  }
  std::vector<std::size_t> others;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    scene.set_padding(member, 0.0);
    if (!members.contains(member)) {
      others.push_back(member);
    }
  }
  const std::size_t rest = scene.rules().add_group(std::move(others));
  const std::size_t named = scene.rules().add_group({members.begin(), members.end()});
  scene.rules().ignore_groups(rest, rest);
  scene.rules().ignore_groups(rest, named);
  for (auto a = members.begin(); a != members.end(); ++a) {
    for (auto b = std::next(a); b != members.end(); ++b) {
      if (!pairs.contains({*a, *b})) {
        scene.rules().ignore({*a, *b});
      }
    }
  }
  return scene;
}

RobotCheckOptions question_of_edges(const EdgeCheckOptions& options) {
  RobotCheckOptions asked;
  asked.tolerance = options.tolerance;
  asked.contacts = ContactState::none;
  asked.budget.steps = options.effort;
  asked.budget.deadline = options.deadline;
  asked.budget.stop = options.stop;
  asked.threads = 1;
  return asked;
}

RobotCheckOptions question_of_held(const EdgeCheckOptions& options) {
  RobotCheckOptions asked = question_of_edges(options);
  for (const HeldPair& pair : options.held) {
    asked.tolerance = std::min(asked.tolerance, pair.tolerance);
  }
  return asked;
}

}  // namespace firstcontact::detail
