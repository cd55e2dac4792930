/// @file
/// The page that plays a run.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/page/page_numbers.h>
#include <firstcontact/record/run.h>

namespace firstcontact {

struct LoadedScene;

/// Collects a run, step after step, for the viewer's page (docs/viewer.md).
///
/// The page holds the header word for word, the totals of each step, and the motion of each body
/// by all of its pieces. A contact has its bodies, point, impulse and distance. A device has the
/// pose of its tool, its force and its torque. Times, positions and points are in double precision;
/// rotations, forces and torques in single precision.
class FIRSTCONTACT_API RunPage {
 public:
  explicit RunPage(const RunHeader& header);

  /// Adds the next step, from the first one on.
  void add(const RunStep& step);

  /// [s]  The end of the last step. A page can be written when this is > 0.
  [[nodiscard]] double time() const { return time_; }

  /// Fills the viewer's page (share/firstcontact/viewer.html).
  ///
  /// @param loaded  the scene of the run, for the meshes
  /// @throws std::invalid_argument if no time has gone by, or the template has no place for a run
  [[nodiscard]] std::string write(std::string_view page_template, const LoadedScene& loaded) const;

 private:
  /// The polyline of a body: where each piece begins, and after the last one where it ends.
  ///
  /// The centre of mass moves on a line from one place to the next, while the body turns about it.
  struct Polyline {
    PageNumbers times;      // [s]
    PageNumbers places;     // [m]  Places of the centre of mass.
    PageNumbers rotations;  // w, x, y, z of R_WB
    PageNumbers turns;      // [rad]  Rotation vector until the next place.
    double end = 0.0;       // [s]
    Pose X_WB;              // Pose at the end.
  };

  /// A link of a tool where its device leads it, for each step of the device.
  struct DeviceLinkRows {
    std::size_t body = 0;
    PageNumbers positions;  // [m]
    PageNumbers rotations;  // w, x, y, z of R_WB
  };

  /// The device of a tool, step after step.
  struct DeviceRows {
    std::size_t body = 0;
    PageNumbers steps;      // Number of the step that begins, from 0.
    PageNumbers positions;  // [m]  Positions of the tool's frame.
    PageNumbers rotations;  // w, x, y, z of R_WB
    PageNumbers forces;     // [N]
    PageNumbers torques;    // [N m]
    std::vector<DeviceLinkRows> links;
  };

  void begin_piece(std::size_t body, double time, const Pose& X_WB, const Eigen::Vector3d& turn);
  void add_place(Polyline& polyline, std::size_t body, double time, const Pose& X_WB) const;
  void add(const RunBody& moved);
  void add(const RunContact& contact);
  void add(const RunDevice& device);
  [[nodiscard]] std::string header_json(const Scene& linked) const;
  [[nodiscard]] std::string polylines_json() const;
  [[nodiscard]] std::string contacts_json() const;
  [[nodiscard]] std::string devices_json() const;

  RunHeader header_;
  std::vector<Eigen::Vector3d> centres_of_mass_;
  double time_ = 0.0;  // [s]
  std::string steps_;
  std::vector<Polyline> polylines_;  // One for every body; empty for bodies at rest.
  std::vector<DeviceRows> devices_;  // Of haptic tools.
  std::uint64_t step_count_ = 0;
  std::uint64_t contact_count_ = 0;
  PageNumbers contacts_until_;  // For each step the number of contacts up to its end.
  PageNumbers contact_bodies_;
  PageNumbers points_;     // [m]
  PageNumbers impulses_;   // [N s]
  PageNumbers distances_;  // [m]
};

}  // namespace firstcontact
