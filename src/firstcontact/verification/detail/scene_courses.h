/// @file
/// The geometries of a scene, and the verifier's own courses of them over time.

#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/separation/detail/box_tree.h>
#include <firstcontact/separation/detail/convex_parts.h>
#include <firstcontact/separation/detail/covered_motion.h>
#include <firstcontact/verification/detail/robot_course.h>
#include <firstcontact/verification/detail/tested_pairs.h>

namespace firstcontact::detail {

/// A shape of a member of the scene. Its pivot is the middle of its box.
struct CourseGeometry {
  std::size_t member = 0;
  Shape shape;
  Eigen::Vector3d p_GP = Eigen::Vector3d::Zero();  ///< [m]  The pivot.
  std::shared_ptr<const BoxTree> tree;  ///< Of a curved body: one box, without triangles.
  IntervalTransform X_MP;               ///< Pivot in the frame of the member.
  std::optional<RoundSet> round = {};   ///< The exact core of a curved body.
};

/// The courses of all members. Refers to the scene, which must outlive it.
class SceneCourses {
 public:
  /// Makes the courses of a scene.
  ///
  /// @throws UncertainMotion; std::invalid_argument where the scene is not one of rigid bodies
  ///
  /// @param turnings  turnings of robots, by their number
  /// @param mover     a body that counts as moving, wherever it rests
  explicit SceneCourses(const LoadedScene& loaded,
                        const std::map<std::size_t, Turnings>& turnings = {},
                        std::optional<std::size_t> mover = {});

  [[nodiscard]] std::span<const CourseGeometry> geometries() const { return geometries_; }
  /// The geometries of a member.
  [[nodiscard]] std::span<const CourseGeometry> of_member(std::size_t member) const;
  [[nodiscard]] std::size_t member_count() const { return first_geometry_.size() - 1; }

  [[nodiscard]] const TestedPairs& pairs() const { return *pairs_; }
  [[nodiscard]] bool has_tracking_errors() const;

  /// The times at which windows of the scene may be cut, with 0 and 1.
  ///
  /// They are the ends of robots' pieces, and always the times at which bodies are taken up or put
  /// down.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }

  /// The motions of both geometries of a pair, one after another, over a window.
  ///
  /// The window does not reach over a time at which one of them is taken up or put down. Where both
  /// hang on one robot they are seen from a link.
  struct PairMotions {
    CoveredMotions A;
    CoveredMotions B;
  };
  [[nodiscard]] PairMotions motions(const CourseGeometry& A, const CourseGeometry& B,
                                    const TimeSpan& window) const;

  /// The motions of a geometry in the world.
  [[nodiscard]] CoveredMotions motions(const CourseGeometry& geometry,
                                       const TimeSpan& window) const;

  /// [m]  A box around all places of a geometry in a window, in the world.
  [[nodiscard]] Eigen::AlignedBox3d swept_box(const CourseGeometry& geometry,
                                              const TimeSpan& window) const;

 private:
  /// The motion of a body until a time.
  struct Stretch {
    double from = 0.0;
    double to = 1.0;
    std::optional<std::size_t> robot = {};  ///< Robot that carries it.
    std::size_t link = 0;                   ///< Link that carries it.
    IntervalTransform X_LB = {};
    std::vector<std::shared_ptr<const CoveredMotion>> motions = {};  ///< Its own motions, where no
                                                                     ///< robot carries it.
    double tracking = 0.0;  ///< [m]  Error with which it was put down.
  };
  struct LinkNumber {
    std::size_t robot = 0;
    std::size_t link = 0;
  };
  struct Seat {
    std::optional<std::size_t> robot;
    std::size_t link = 0;
    IntervalTransform X_LP;
  };

  void add_bodies();
  void add_robots(const std::map<std::size_t, Turnings>& turnings);
  void add_geometry(std::size_t member, const Shape& shape, const Pose& X_MG);
  void attach_bodies();
  [[nodiscard]] std::vector<Stretch> stretches_of(std::size_t body) const;
  [[nodiscard]] const Stretch& stretch_at(std::size_t body, double t) const;
  [[nodiscard]] Seat seat(const CourseGeometry& geometry, double t) const;
  [[nodiscard]] CoveredMotions seen_from(std::optional<std::size_t> frame, const Seat& seat,
                                         const CourseGeometry& geometry,
                                         const TimeSpan& window) const;

  const LoadedScene& loaded_;
  std::vector<std::unique_ptr<const RobotCourse>> robots_;
  std::vector<CourseGeometry> geometries_;
  std::vector<std::size_t> first_geometry_;
  std::vector<std::vector<Stretch>> stretches_;  // For each body.
  std::vector<LinkNumber> links_;                // For the members behind the bodies.
  std::unique_ptr<const TestedPairs> pairs_;
  std::vector<double> breaks_;
};

}  // namespace firstcontact::detail
