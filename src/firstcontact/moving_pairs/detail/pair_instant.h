/// @file
/// Two bodies at one instant of a search, with the boxes that are placed there.

#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <firstcontact/motion/relative_state.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/moving_pairs/detail/search_tuning.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

namespace firstcontact::detail {

/// The instant at which a search places the bodies. Boxes are placed anew only where that gains
/// something. Pairs of triangles do without boxes.
class PairInstant {
 public:
  PairInstant(const MovingPair& pair, double tie_window)
      : pair_(pair),
        tie_window_(tie_window),
        window_(search_tuning(pair.motion().follows_joints()).boxes_window * pair.unit() /
                std::max(pair.speed_bound(), 1e-300)),
        frame_(pair.box_frame()) {}

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const RelativeState& state() const { return state_; }
  [[nodiscard]] double error() const { return error_; }  ///< [m]  Error of a gap of the two bodies.
  [[nodiscard]] const BoxFrame& frame() const { return frame_; }

  /// The latest time at which a group loses little by the boxes that were placed here.
  [[nodiscard]] double latest_of_second() const { return t_ + kWindowsOfSecond * window_; }

  /// Places both bodies.
  void move_to(double t) {
    if (t == t_) {
      return;
    }
    t_ = t;
    state_ = pair_.motion().state(t);
    error_ = pair_.gap_error(state_);
  }

  /// Places boxes at t, or a little before.
  ///
  /// @param threshold  [m]  closer is contact
  void place_boxes(double t, double threshold, double horizon) {
    if (!serves(t)) {
      move_to(t);
    }
    if (frame_t_ != t_) {
      frame_t_ = t_;
      served_ = 0;
      pair_.place(state_, threshold + error_, frame_);
    }
    frame_.horizon = round_up(horizon - t_);
  }

  /// Counts another group that was bounded in these boxes.
  void count_served() { ++served_; }

  /// Requests a new placement of boxes, as another threshold holds.
  void forget_boxes() { frame_t_ = std::numeric_limits<double>::quiet_NaN(); }

 private:
  /// [-]  Factor of the window for a group that is bounded along with another one: it may be due
  /// that much later. The old placement costs little and saves more.
  static constexpr double kWindowsOfSecond = 8.0;

  /// Number of groups after which boxes of links are placed anew. Placements of links serve longer
  /// than others. Where many pairs come near at once, the loss by an old placement would open all
  /// of them.
  static constexpr std::uint64_t kManyAtOnce = 16;

  /// Whether the present placement serves a group that is proven until t.
  [[nodiscard]] bool serves(double t) const {
    const bool is_old = served_ >= kManyAtOnce && pair_.motion().follows_joints();
    const double window = is_old ? std::min(tie_window_, window_) : window_;
    return t_ <= t && t < t_ + window;
  }

  const MovingPair& pair_;
  double tie_window_;
  double window_;
  double t_ = std::numeric_limits<double>::quiet_NaN();  // Time of the next two.
  RelativeState state_;
  double error_ = 0.0;
  double frame_t_ = std::numeric_limits<double>::quiet_NaN();
  BoxFrame frame_;
  std::uint64_t served_ = 0;  // Number of groups that were bounded in the frame.
};

}  // namespace firstcontact::detail
