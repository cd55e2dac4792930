/// @file
/// Inputs on which searches for first contact are known to break down: ties, grazing, sliding,
/// many turns, needles. What the benchmark times, a test checks.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <firstcontact/query/first_contact.h>

namespace firstcontact::benchmarks {

/// A question and what is known about its answer.
struct HardCase {
  std::string name;
  Shape A;
  Shape B;
  Motion motion_A;
  Motion motion_B;
  Verdict verdict;
  std::optional<double> t = {};  ///< [-]  First contact in closed form.
  /// Flat on flat, the list of all contacts is much longer than the search for the first.
  FirstContactOptions options = {.contacts = ContactState::first};

  [[nodiscard]] MovingShape moving_A() const { return {A, motion_A}; }
  [[nodiscard]] MovingShape moving_B() const { return {B, motion_B}; }
};

/// All of them; the names are unique.
[[nodiscard]] std::vector<HardCase> hard_cases();

}  // namespace firstcontact::benchmarks
