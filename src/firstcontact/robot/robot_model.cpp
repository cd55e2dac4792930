#include <firstcontact/robot/robot_model.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/robot/detail/joint_frame.h>

namespace firstcontact {
namespace {

using Index = std::map<std::string, std::size_t, std::less<>>;

std::optional<std::size_t> find(const Index& index, std::string_view name) {
  const auto found = index.find(name);
  return found == index.end() ? std::optional<std::size_t>() : found->second;
}

}  // namespace

struct RobotModel::Data {
  RobotDescription description;
  Index links;
  Index joints;
  std::vector<std::size_t> parent_link;                  // For each joint.
  std::vector<std::size_t> child_link;                   // For each joint.
  std::vector<std::optional<std::size_t>> parent_joint;  // For each link.
  std::vector<std::size_t> depth;  // For each link the number of joints above it.
  std::size_t root = 0;
  std::vector<std::size_t> rigid_root;                  // For each link.
  std::vector<PreciseTransform> from_rigid_root;        // For each link.
  std::vector<std::shared_ptr<const JointPath>> tails;  // For each link.
  std::vector<detail::JointFrame> frames;               // For each joint.

  void lay_out();
};

/// Joins links that are rigid to each other, in the frame of the first of them.
void RobotModel::Data::lay_out() {
  const std::size_t count = description.links.size();
  rigid_root.resize(count);
  from_rigid_root.resize(count);
  tails.resize(count);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  for (const std::size_t link : order) {
    const std::optional<std::size_t> joint = parent_joint[link];
    rigid_root[link] = link;
    if (joint && description.joints[*joint].type == JointType::fixed) {
      const std::size_t parent = parent_link[*joint];
      rigid_root[link] = rigid_root[parent];
      from_rigid_root[link] = from_rigid_root[parent] * precise(description.joints[*joint].X_PJ);
      tails[link] = std::make_shared<const JointPath>(JointPath::rigid(from_rigid_root[link]));
    }
  }
  for (std::size_t j = 0; j < description.joints.size(); ++j) {
    const Joint& joint = description.joints[j];
    frames.push_back(
        detail::joint_frame(joint, from_rigid_root[parent_link[j]] * precise(joint.X_PJ)));
  }
}

RobotModel::RobotModel(RobotDescription description) {
  if (const std::optional<RobotDefect> defect = find_defect(description)) {
    throw std::invalid_argument("RobotModel: " + defect->message);
  }
  auto data = std::make_shared<Data>();
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    data->links.emplace(description.links[i].name, i);
  }
  data->parent_joint.resize(description.links.size());
  for (std::size_t j = 0; j < description.joints.size(); ++j) {
    const Joint& joint = description.joints[j];
    data->joints.emplace(joint.name, j);
    data->parent_link.push_back(data->links.find(joint.parent)->second);
    data->child_link.push_back(data->links.find(joint.child)->second);
    data->parent_joint[data->child_link.back()] = j;
  }
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    std::size_t link = i;
    std::size_t depth = 0;
    for (; data->parent_joint[link]; ++depth) {
      link = data->parent_link[*data->parent_joint[link]];
    }
    data->depth.push_back(depth);
    data->root = link;
  }
  data->description = std::move(description);
  const FloatEnvironmentGuard guard;
  data->lay_out();
  data_ = std::move(data);
}

const std::string& RobotModel::name() const { return data_->description.name; }
std::span<const Link> RobotModel::links() const { return data_->description.links; }
std::span<const Joint> RobotModel::joints() const { return data_->description.joints; }
std::size_t RobotModel::root() const { return data_->root; }

std::optional<std::size_t> RobotModel::find_link(std::string_view name) const {
  return find(data_->links, name);
}

std::optional<std::size_t> RobotModel::find_joint(std::string_view name) const {
  return find(data_->joints, name);
}

std::size_t RobotModel::parent_link(std::size_t joint) const { return data_->parent_link[joint]; }
std::size_t RobotModel::child_link(std::size_t joint) const { return data_->child_link[joint]; }

std::optional<std::size_t> RobotModel::parent_joint(std::size_t link) const {
  return data_->parent_joint[link];
}

bool RobotModel::are_adjacent(std::size_t link, std::size_t other) const {
  const auto hangs_on = [&](std::size_t child, std::size_t parent) {
    const std::optional<std::size_t> joint = parent_joint(child);
    return joint && parent_link(*joint) == parent;
  };
  return hangs_on(link, other) || hangs_on(other, link);
}

std::size_t RobotModel::rigid_root(std::size_t link) const { return data_->rigid_root[link]; }

const PreciseTransform& RobotModel::from_rigid_root(std::size_t link) const {
  return data_->from_rigid_root[link];
}

const detail::JointFrame& RobotModel::frame(std::size_t joint) const {
  return data_->frames[joint];
}

const std::shared_ptr<const JointPath>& RobotModel::tail(std::size_t link) const {
  return data_->tails[link];
}

std::vector<std::size_t> RobotModel::chain(std::size_t ancestor, std::size_t link) const {
  std::vector<std::size_t> joints;
  while (link != ancestor) {
    assert(parent_joint(link).has_value());
    joints.push_back(*parent_joint(link));
    link = parent_link(joints.back());
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

std::size_t RobotModel::last_common_ancestor(std::size_t link, std::size_t other) const {
  while (link != other) {
    std::size_t& deeper = data_->depth[link] > data_->depth[other] ? link : other;
    deeper = parent_link(*parent_joint(deeper));
  }
  return link;
}

}  // namespace firstcontact
