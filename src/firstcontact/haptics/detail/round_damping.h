/// @file
/// The damping of rounds: where plans turn back again and again, only a fraction of each is made.

#pragma once

#include <algorithm>
#include <optional>

#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/god_object_plan.h>

namespace firstcontact::detail {

/// Chooses the fraction of a plan that a round makes.
///
/// A plan is a step of Newton's method that leaves out how contacts and the arm of the spring bend
/// its energy. With a long arm it may go many times too far, so that the next plan turns back. Then
/// the tool would swing, and creep by its friction. The fraction is halved while plans turn back
/// (after M. Riedmiller, H. Braun, "A direct adaptive method for faster backpropagation learning:
/// the RPROP algorithm", IEEE International Conference on Neural Networks 1993).
class RoundDamping {
 public:
  /// Forgets the plans before: the next one is made in full.
  void reset() { *this = {}; }

  /// [-]  Computes the fraction of a plan that is made, in (0, 1].
  ///
  /// @param is_next  whether it has the same targets as the plan before
  [[nodiscard]] double part_of(const ToolDisplacements& way, const ToolFrames& frames,
                               std::size_t tools, bool is_next) {
    if (is_next && last_) {
      const bool turns_back = product_of(way, *last_, frames, tools) < 0.0;
      part_ = turns_back ? std::max(kLeastPartOfPlan, 0.5 * part_)
                         : std::min(1.0, kGrowthOfPart * part_);
    }
    last_ = way;
    return part_;
  }

 private:
  std::optional<ToolDisplacements> last_;
  double part_ = 1.0;  // [-]
};

}  // namespace firstcontact::detail
