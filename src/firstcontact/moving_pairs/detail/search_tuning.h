/// @file
/// How a search of boxes proceeds: numbers that steer its speed, not what it proves.

#pragma once

namespace firstcontact::detail {

/// The numbers for a kind of motion.
struct SearchTuning {
  /// [-]  Least motion for which boxes are placed anew, as a fraction of the shapes' size. A bound
  /// from a little earlier loses only a quantity of second order in time. Larger where a state is
  /// costly.
  double boxes_window;
  /// [-]  Fraction of their sizes: boxes farther apart are bounded once more when they are due,
  /// nearer ones are opened. Smaller where bodies stay beside each other for longer.
  double far_boxes;
  /// [-]  Ratio of sizes from which only the larger box is opened, not both. Larger where two
  /// bodies that come near are rarely of one size.
  double larger_boxes;
};

inline constexpr SearchTuning kTuningOfBodies{
    .boxes_window = 0x1p-9, .far_boxes = 0.15, .larger_boxes = 1.5};
inline constexpr SearchTuning kTuningOfLinks{
    .boxes_window = 0x1p-6, .far_boxes = 0.03, .larger_boxes = 2.5};

/// The numbers for pairs of bodies or of links.
///
/// @param follows_joints  as PairMotion::follows_joints()
[[nodiscard]] constexpr const SearchTuning& search_tuning(bool follows_joints) {
  return follows_joints ? kTuningOfLinks : kTuningOfBodies;
}

}  // namespace firstcontact::detail
