/// @file
/// What one pair of a scene answered, of bodies and of links of robots alike.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/robot_check/check_robots.h>

#include "scene.h"

namespace firstcontact::python {

/// A contact as scenes tell it: members by name, velocities in seconds.
struct SceneContact : Contact {
  std::array<std::string, 2> bodies;
  std::array<std::size_t, 2> geometries = {};  ///< Of each, by index.
};

/// The closest approach of a pair.
struct ClosestView {
  double distance = 0.0;
  double lower_bound = 0.0;
  double t = 0.0;
  UndecidedReason reason = UndecidedReason::none;
  std::optional<Contact> closest = {};
};

/// The numbers are those of PairAnswer and RobotPairAnswer.
struct PairView {
  std::array<std::string, 2> names;
  double margin = 0.0;
  Verdict verdict = Verdict::undecided;
  UndecidedReason reason = UndecidedReason::none;
  double t = 0.0;
  std::optional<double> t_upper = {};
  ContactCount contact_count = {};
  double clearance = 0.0;
  double tolerance_used = 0.0;
  std::optional<ClosestView> closest = {};
  std::vector<ContactInterval> intervals = {};
};

[[nodiscard]] std::size_t pair_count(const HeldResult& result);

[[nodiscard]] PairView view_pair(const HeldResult& result, std::size_t index);

/// The pair that decides t, and the one that comes closest.
[[nodiscard]] std::optional<std::size_t> first_pair(const SceneResult& answer);
[[nodiscard]] std::optional<std::size_t> closest_pair(const SceneResult& answer);

[[nodiscard]] std::vector<SceneContact> contacts_of_pair(const HeldResult& result,
                                                         std::size_t index);

}  // namespace firstcontact::python
