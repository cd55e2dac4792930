/// @file
/// True first contact of two small meshes on joints, slow and independent of the library. It uses
/// positions in 256 bits, proofs of separation over windows of time, and brute force over all pairs
/// of triangles.

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

  /// Finds the first contact, as Truth defines it, with a wider band in which it gives up.
  ///
  /// It gives up where the least gap is within 1e-13 of the margin, relative to the size, because
  /// triangles are compared in double precision.
  [[nodiscard]] Truth first_contact(std::size_t window_budget = 20'000) const;

  /// Bounds the distance of the thickened meshes at one time.
  [[nodiscard]] DistanceBounds distance(double t) const;

 private:
  class Search;

  RobotCase case_;
};

}  // namespace firstcontact::oracle
