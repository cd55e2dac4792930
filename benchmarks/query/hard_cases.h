/// @file
/// Inputs on which searches for first contact are known to fail: ties, grazing, sliding, many
/// turns, needles. The benchmark times the same cases that a test checks.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <firstcontact/query/first_contact.h>

namespace firstcontact::benchmarks {

/// Question with the facts that are known about its answer.
struct HardCase {
  std::string name;
  Shape A;
  Shape B;
  Motion motion_A;
  Motion motion_B;
  Verdict verdict;
  std::optional<double> t = {};  ///< [-]  First contact in closed form.
  /// Ends with the first contact: for flat on flat, the list of all contacts takes far longer.
  FirstContactOptions options = {.contacts = ContactState::first};

  [[nodiscard]] MovingShape moving_A() const { return {A, motion_A}; }
  [[nodiscard]] MovingShape moving_B() const { return {B, motion_B}; }
};

/// Makes all hard cases; the names are unique.
[[nodiscard]] std::vector<HardCase> hard_cases();

}  // namespace firstcontact::benchmarks
