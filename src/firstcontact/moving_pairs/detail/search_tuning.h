/// @file
/// How a search of boxes proceeds: numbers that steer its speed, not what it proves.

#pragma once

namespace firstcontact::detail {

/// What suits a kind of motion.
struct SearchTuning {
  /// [-]  Boxes are not placed anew for less motion than this part of the shapes' size: a bound
  /// from a little earlier loses only a quantity of second order in time. Larger where a state is
  /// costly.
  double boxes_window;
  /// [-]  Boxes farther apart than this part of their sizes are bounded once more when they are
  /// due, nearer ones opened. Smaller where bodies stay beside each other for longer.
  double far_boxes;
  /// [-]  A box that is larger than the other one by this factor is opened alone, else both are.
  /// Larger where two bodies that come near are seldom of one size.
  double larger_boxes;
};

inline constexpr SearchTuning kTuningOfBodies{
    .boxes_window = 0x1p-9, .far_boxes = 0.15, .larger_boxes = 1.5};
inline constexpr SearchTuning kTuningOfLinks{
    .boxes_window = 0x1p-6, .far_boxes = 0.03, .larger_boxes = 2.5};

/// @param follows_joints  as PairMotion::follows_joints()
[[nodiscard]] constexpr const SearchTuning& search_tuning(bool follows_joints) {
  return follows_joints ? kTuningOfLinks : kTuningOfBodies;
}

}  // namespace firstcontact::detail
