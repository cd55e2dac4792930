/// @file
/// A robot scene laid out in time: its geometries, the pairs that are tested, and the paths of both
/// in a frame that they share.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/shape_pair.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {

/// One geometry of a member, with its bounds: at all times of the step, where it deforms.
struct BoundedGeometry {
  std::size_t member = 0;
  std::size_t index = 0;  ///< Among the geometries of the member.
  const Shape* shape = nullptr;
  RoundedBox ball;     ///< Around the shape, thickening included, in its frame S.
  RoundedBox box;      ///< So too.
  double reach = 0.0;  ///< [m]  Of the thickened shape, from the centre of the box.
  bool rests = false;  ///< Its frame S, and so its bounds, over the whole step.
  std::vector<Eigen::Vector3d> corners = {};  ///< As hull_corners().
};

/// Two members that are tested, but for the times of `pauses`.
struct TestedPair {
  BodyPair members = {};
  double margin = 0.0;  ///< [m]  With both paddings.
  std::vector<TimeWindow> pauses = {};
};

/// Each geometry of one member with each of another, in order: what `for` runs over.
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

  /// @param a, b  the first geometry of each member; no member is without one
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

/// X_FS(t) of a geometry over a piece of time, and how well it is followed.
struct GeometryPath {
  LinkPath X_FS;
  std::vector<TrackingError> errors;  ///< One for each joint of the path; empty if all are zero.
  double rest_error = 0.0;            ///< [m]  Of a body that was put down.

  /// [m]  How far any point may be from its place in the window.
  [[nodiscard]] double tracking_bound(const RoundedBox& ball, const TimeWindow& window) const;
};

/// The seat of a geometry over a piece of time: a link, or its own path in the world.
struct GeometryCarrier {
  std::optional<RobotLink> link;    ///< As the root of those that are fixed to each other.
  const JointPath* path = nullptr;  ///< X_LS, which rests; or X_WS.
};

/// Both geometries of a pair in one frame F: the world, or a link that carries both.
struct PairPaths {
  GeometryPath A;
  GeometryPath B;
  std::optional<RobotLink> frame;  ///< None: the world.
};

/// Refers to the scene, which must not change meanwhile.
class RobotTimeline {
 public:
  explicit RobotTimeline(const RobotScene& scene);

  /// Lays out anew what depends on the motions of robots.
  void follow_motions();

  [[nodiscard]] const RobotScene& scene() const { return scene_; }

  [[nodiscard]] std::span<const BoundedGeometry> geometries() const { return geometries_; }
  /// The geometries of the first member of a pair, and those of the second one, to test together.
  [[nodiscard]] GeometryPairs geometry_pairs(const TestedPair& pair) const {
    const auto [first, second] = pair.members;
    return {first_geometry_[first], first_geometry_[first + 1], first_geometry_[second],
            first_geometry_[second + 1]};
  }
  [[nodiscard]] std::span<const TestedPair> pairs() const { return pairs_; }  ///< In order.
  /// [m]  Of all pairs that are tested in some piece; infinite where there are none.
  [[nodiscard]] double least_margin() const { return least_margin_; }

  /// Whether any threshold depends on time.
  [[nodiscard]] bool has_tracking_errors() const;

  /// Pieces of time in which all paths are smooth and nothing is picked up or put down.
  [[nodiscard]] std::size_t piece_count() const { return breaks_.size() - 1; }
  [[nodiscard]] TimeWindow piece(std::size_t k) const { return {breaks_[k], breaks_[k + 1]}; }

  [[nodiscard]] bool is_tested(const TestedPair& pair, std::size_t piece) const;
  /// Whether the pair is tested in some piece.
  [[nodiscard]] bool is_tested(const TestedPair& pair) const;

  /// In the world, over the piece around t.
  [[nodiscard]] GeometryPath path(std::size_t geometry, double t) const;

  /// In a link that carries the geometry, or in the world where there is none.
  [[nodiscard]] GeometryPath path(std::size_t geometry, double t,
                                  const std::optional<RobotLink>& frame) const;

  /// Over the piece around t; valid as long as this, and the motions.
  [[nodiscard]] GeometryCarrier seat_of(std::size_t geometry, double t) const;

  /// @param a, b  geometries
  [[nodiscard]] PairPaths paths(std::size_t a, std::size_t b, double t) const;

 private:
  /// The seat of a geometry until t_end: a link, as the root of those that are fixed to each other.
  ///
  /// Or it is the world, in which the geometry follows pieces of its own.
  struct Seat {
    double t_end = 1.0;
    std::optional<RobotLink> link;
    std::shared_ptr<const JointPath> X_LS;  // Of a link.
    std::vector<double> ends;               // Of a body's pieces.
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
  std::vector<std::vector<Seat>> seats_;  // Of each geometry, in order of time.
  /// The geometries of a member are first_geometry_[member], ... below first_geometry_[member + 1].
  std::vector<std::size_t> first_geometry_;
  std::vector<TestedPair> pairs_;
  double least_margin_ = std::numeric_limits<double>::infinity();
  std::vector<double> breaks_;
  std::vector<std::vector<TrackingError>> joint_errors_;  // Of each robot; empty if all are zero.
};

}  // namespace firstcontact::detail
