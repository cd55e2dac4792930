/// @file
/// The truth about the first contact of two small meshes that hang on joints, slow and independent
/// of the library: places in 256 bits, proofs of separation over windows of time, brute force over
/// all pairs of triangles.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "support/exact_link_path.h"
#include "support/first_contact_oracle.h"
#include "support/robot_input.h"

namespace firstcontact::oracle {

class RobotContactOracle {
 public:
  explicit RobotContactOracle(const RobotCase& c);

  /// With the meaning of Truth, but that it gives up where the least gap is within 1e-13 of the
  /// margin, relative to the size: triangles are compared in double precision.
  [[nodiscard]] Truth first_contact(std::size_t window_budget = 20'000) const;

  /// The distance of the thickened meshes at one time, from both sides.
  [[nodiscard]] DistanceBounds distance(double t) const;

 private:
  class Search;

  RobotCase case_;
};

}  // namespace firstcontact::oracle
