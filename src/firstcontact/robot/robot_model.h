/// @file
/// A robot: a tree of links, checked once and shared from then on.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/joint_path.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot/robot_description.h>

namespace firstcontact {

namespace detail {
struct JointFrame;
}

/// A tree of links, which are named by their index in the description, as joints are.
///
/// Immutable and cheap to copy: copies share their data, also between threads.
class FIRSTCONTACT_API RobotModel {
 public:
  /// Makes the model of a description.
  ///
  /// @throws std::invalid_argument  with the message of find_defect()
  explicit RobotModel(RobotDescription description);

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] std::span<const Link> links() const;
  [[nodiscard]] std::span<const Joint> joints() const;
  [[nodiscard]] std::size_t root() const;  ///< The link that no joint carries.

  [[nodiscard]] std::optional<std::size_t> find_link(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> find_joint(std::string_view name) const;

  [[nodiscard]] std::size_t parent_link(std::size_t joint) const;
  [[nodiscard]] std::size_t child_link(std::size_t joint) const;
  /// The joint that moves a link against its parent; none for the root.
  [[nodiscard]] std::optional<std::size_t> parent_joint(std::size_t link) const;

  /// Whether one joint connects the two links.
  [[nodiscard]] bool are_adjacent(std::size_t link, std::size_t other) const;

  /// The link nearest to the root, or itself, from which only fixed joints lead to this one.
  [[nodiscard]] std::size_t rigid_root(std::size_t link) const;

  /// The transform X_RL, with R the frame of rigid_root(link).
  [[nodiscard]] const PreciseTransform& from_rigid_root(std::size_t link) const;

  /// The frame of a joint, which all motions of the robot share.
  [[nodiscard]] const detail::JointFrame& frame(std::size_t joint) const;

  /// The transform X_RL as a joint that does not move; null where the two are one.
  [[nodiscard]] const std::shared_ptr<const JointPath>& tail(std::size_t link) const;

  /// The joints from a link down to one that hangs on it, in that order; empty if they are one.
  ///
  /// @param ancestor  the link itself, or one between it and the root
  [[nodiscard]] std::vector<std::size_t> chain(std::size_t ancestor, std::size_t link) const;

  /// The link farthest from the root on which both hang; one of them if the other hangs on it.
  [[nodiscard]] std::size_t last_common_ancestor(std::size_t link, std::size_t other) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace firstcontact
