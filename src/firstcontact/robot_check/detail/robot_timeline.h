/// @file
/// A robot scene laid out in time: its geometries, the tested pairs, and their paths in a shared
/// frame.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/shape_pair.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/hull_approach.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// One geometry of a member, with its bounds; where it deforms, at all times of the step.
struct BoundedGeometry {
  std::size_t member = 0;
  std::size_t index = 0;  ///< Index among the geometries of the member.
  const Shape* shape = nullptr;
  RoundedBox ball;     ///< Ball around the shape, thickening included, in its frame S.
  RoundedBox core;     ///< Ball around the shape without its thickening, which moves as its core.
  RoundedBox box;      ///< Box around the shape, thickening included.
  double reach = 0.0;  ///< [m]  Reach of the thickened shape from the centre of the box.
  bool rests = false;  ///< Whether its frame S, and so its bounds, rest over the whole step.
  const ShapeBounds* bounds = nullptr;  ///< Those of the shape.
  HullCorners corners = {};             ///< Corners as hull_corners() has them.
};

/// Two members that are tested, except at the times of `pauses`.
struct TestedPair {
  BodyPair members = {};
  double margin = 0.0;  ///< [m]  Margin with both paddings.
  std::vector<TimeWindow> pauses = {};
};

/// Each geometry of one member with each of another, in order, as a range for `for`.
class GeometryPairs {
 public:
  class Iterator {
   public:
    Iterator(const GeometryPairs& pairs, std::size_t a) : pairs_(&pairs), at_{a, pairs.b_} {}
    [[nodiscard]] const std::array<std::size_t, 2>& operator*() const { return at_; }
    Iterator& operator++() {
      if (++at_[1] == pairs_->b_end_) {
        at_ = {at_[0] + 1, pairs_->b_};
      }
      return *this;
    }
    [[nodiscard]] bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const GeometryPairs* pairs_;
    std::array<std::size_t, 2> at_;
  };

  /// @param a, b  the first geometry of each member; each member has at least one
  GeometryPairs(std::size_t a, std::size_t a_end, std::size_t b, std::size_t b_end)
      : a_(a), a_end_(a_end), b_(b), b_end_(b_end) {}
  [[nodiscard]] Iterator begin() const { return {*this, a_}; }
  [[nodiscard]] Iterator end() const { return {*this, a_end_}; }

 private:
  std::size_t a_;
  std::size_t a_end_;
  std::size_t b_;
  std::size_t b_end_;
};

/// The path X_FS(t) of a geometry over a piece of time, and its tracking errors.
struct GeometryPath {
  LinkPath X_FS;
  std::vector<TrackingError> errors;  ///< One for each joint of the path; empty if all are zero.
  double rest_error = 0.0;            ///< [m]  Error of a body that was put down.

  /// [m]  Bound of the distance of any point of a ball from its place in the window.
  [[nodiscard]] double tracking_bound(const RoundedBox& ball, const TimeWindow& window,
                                      LinkScratch& scratch) const;
};

/// The carrier of a geometry over a piece of time: a link, or its own path in the world.
struct GeometryCarrier {
  std::optional<RobotLink> link;    ///< The root of the links that are fixed to each other.
  const JointPath* path = nullptr;  ///< X_LS, which rests; or X_WS.
};

/// Both geometries of a pair in one frame F: the world, or a link that carries both.
struct PairPaths {
  GeometryPath A;
  GeometryPath B;
  std::optional<RobotLink> frame;  ///< None: the world.

  /// [m]  Bound of how much closer tracking errors may bring the two geometries, in a window.
  ///
  /// At an instant it depends on the configuration alone. Over a window it is at least as large as
  /// at each of its instants.
  [[nodiscard]] double tracking_bound(const BoundedGeometry& a, const BoundedGeometry& b,
                                      const TimeWindow& window, LinkScratch& scratch) const;
};

/// A robot scene laid out in time. Refers to the scene, which must not change meanwhile.
class RobotTimeline {
 public:
  explicit RobotTimeline(const RobotScene& scene);

  /// Renews all data that depend on the motions of robots.
  void follow_motions();

  [[nodiscard]] const RobotScene& scene() const { return scene_; }

  [[nodiscard]] std::span<const BoundedGeometry> geometries() const { return geometries_; }
  /// The pairs of a geometry of the first member and one of the second that are to be tested.
  [[nodiscard]] GeometryPairs geometry_pairs(const TestedPair& pair) const {
    const auto [first, second] = pair.members;
    return {first_geometry_[first], first_geometry_[first + 1], first_geometry_[second],
            first_geometry_[second + 1]};
  }
  /// The tested pairs, in order.
  [[nodiscard]] std::span<const TestedPair> pairs() const { return pairs_; }
  /// [m]  The least margin of all pairs that are tested in some piece; infinite where there are
  /// none.
  [[nodiscard]] double least_margin() const { return least_margin_; }

  /// Whether any threshold depends on time.
  [[nodiscard]] bool has_tracking_errors() const;

  /// Pieces of time in which all paths are smooth and nothing is picked up or put down.
  [[nodiscard]] std::size_t piece_count() const { return breaks_.size() - 1; }
  [[nodiscard]] TimeWindow piece(std::size_t k) const { return {breaks_[k], breaks_[k + 1]}; }

  [[nodiscard]] bool is_tested(const TestedPair& pair, std::size_t piece) const;
  /// Whether the pair is tested in some piece.
  [[nodiscard]] bool is_tested(const TestedPair& pair) const;

  /// The path of a geometry in the world, over the piece around t.
  [[nodiscard]] GeometryPath path(std::size_t geometry, double t) const;

  /// The path of a geometry in a link that carries it, or in the world.
  [[nodiscard]] GeometryPath path(std::size_t geometry, double t,
                                  const std::optional<RobotLink>& frame) const;

  /// The carrier of a geometry over the piece around t; valid as long as this object and the
  /// motions.
  [[nodiscard]] GeometryCarrier seat_of(std::size_t geometry, double t) const;

  /// The paths of two geometries in one frame.
  ///
  /// @param a, b  geometries
  [[nodiscard]] PairPaths paths(std::size_t a, std::size_t b, double t) const;

 private:
  /// The seat of a geometry until t_end.
  ///
  /// It is a link, as the root of those that are fixed to each other. Or it is the world, in which
  /// the geometry follows pieces of its own.
  struct Seat {
    double t_end = 1.0;
    std::optional<RobotLink> link;
    std::shared_ptr<const JointPath> X_LS;  // Only for a link.
    std::vector<double> ends;               // Ends of a body's pieces.
    std::vector<std::shared_ptr<const JointPath>> pieces;
    double rest_error = 0.0;

    /// The piece that holds t, the earlier one at a break.
    [[nodiscard]] std::size_t piece(double t) const;
  };

  void add_geometries(std::size_t member);
  void add_pairs();
  void find_breaks();
  [[nodiscard]] std::vector<Seat> seats_of_body(std::size_t member) const;
  [[nodiscard]] Seat seat_on_link(const RobotLink& link, std::shared_ptr<const JointPath> X_RS,
                                  double t_end) const;
  [[nodiscard]] Seat carried_seat(const BodyStretch::Carried& carried, double t_end) const;
  [[nodiscard]] const Seat& seat(std::size_t geometry, double t) const;
  [[nodiscard]] GeometryPath path(const Seat& seat, double t,
                                  std::optional<std::size_t> frame) const;
  [[nodiscard]] std::vector<TrackingError> errors_along(const RobotLink& link,
                                                        std::size_t frame) const;

  const RobotScene& scene_;
  std::vector<BoundedGeometry> geometries_;
  std::vector<std::vector<Seat>> seats_;  // For each geometry, in order of time.
  /// The geometries of a member are first_geometry_[member], ... below first_geometry_[member + 1].
  std::vector<std::size_t> first_geometry_;
  std::vector<TestedPair> pairs_;
  double least_margin_ = std::numeric_limits<double>::infinity();
  std::vector<double> breaks_;
  std::vector<std::vector<TrackingError>> joint_errors_;  // For each robot; empty if all are zero.
};

}  // namespace firstcontact::detail
