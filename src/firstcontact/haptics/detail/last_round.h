/// @file
/// The contacts of the round before, for a round that turns back.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>
#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// The memory of a round: the poses of its members, its touches and its displacement.
///
/// A plan knows only the contacts where it begins. In a groove it slides along one flank and on to
/// the other. There the next plan knows only the other flank, and slides back: the two rounds
/// repeat for ever. A plan that turns back is hence made once more, with the contacts of both
/// rounds. It ends in the groove.
class LastRound {
 public:
  void forget() { poses_.clear(); }
  void keep(const std::vector<Pose>& poses, const std::vector<HapticTouch>& touches,
            const ToolDisplacements& way);

  /// Whether a displacement turns back, in the metric of the springs. False where nothing is
  /// remembered.
  [[nodiscard]] bool is_left_by(const ToolDisplacements& way, const ToolFrames& frames,
                                std::size_t tools) const;

  /// Finds the contacts of that round that touch no more, as planes, with the points that the
  /// members carried along.
  ///
  /// @param poses     of all members, now
  /// @param touching  the touches now
  [[nodiscard]] std::vector<HapticTouch> touches_left(
      const std::vector<Pose>& poses, const std::vector<HapticTouch>& touching) const;

 private:
  std::vector<Pose> poses_;  // Empty where nothing is remembered.
  std::vector<HapticTouch> touches_;
  ToolDisplacements way_ = {};
};

}  // namespace firstcontact::detail
