/// @file
/// A run as an animation that other programs play: binary glTF 2.0.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/record/run.h>
#include <firstcontact/run_page/detail/glb_scene.h>

namespace firstcontact {

struct LoadedScene;

/// Collects a run, step after step, for a .glb file.
///
/// Each body is a node at its centre of mass, with its mesh below it. Between two keys a player
/// moves the node on a line and turns it at a constant rate. That is the in-between motion of the
/// run. A player turns the short way, so pieces that turn by more than a quarter have keys in
/// between. Numbers are in single precision, as glTF has them: the file shows a run and proves
/// nothing. The root turns the scene so that gravity pulls along -y. Without gravity z becomes y.
class FIRSTCONTACT_API RunAnimation {
 public:
  explicit RunAnimation(const RunHeader& header);

  /// Adds the next step, from the first one on.
  void add(const RunStep& step);

  /// [s]  The end of the last step. An animation can be written when this is > 0.
  [[nodiscard]] double time() const { return time_; }

  /// Returns the contents of the file.
  ///
  /// @param loaded  the scene of the run, for the meshes
  /// @throws std::invalid_argument if no time has gone by, or the file would be larger than 4 GiB
  [[nodiscard]] std::string write(const LoadedScene& loaded) const;

 private:
  /// A body's keys, and its place at the end of the last of them.
  struct Course {
    std::vector<detail::GlbKey> keys;
    double end = 0.0;  // [s]
    Pose X_WB;
  };

  void add_piece(std::size_t body, double from, const RunPiece& piece, double seconds);
  [[nodiscard]] Eigen::Vector3d centre(std::size_t body, const Pose& X_WB) const;

  RunHeader header_;
  double time_ = 0.0;            // [s]
  std::vector<Course> courses_;  // One for every body; empty for bodies at rest.
};

}  // namespace firstcontact
