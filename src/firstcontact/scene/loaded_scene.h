/// @file
/// A scene made ready for queries: meshes loaded, motions normalised, rules for pairs set.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot/limit_report.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

class RobotScene;

/// The limits that a robot of the scene leaves.
struct SceneLimits {
  std::size_t robot = 0;
  std::vector<LimitViolation> violations;
};

/// Describes a violation: "arm: joint "elbow" leaves its upper limit of 2 rad by 0.1 rad at 1.5 s".
///
/// @param duration  [s]  of the scene
[[nodiscard]] FIRSTCONTACT_API std::string describe(const SceneRobot& robot,
                                                    const LimitViolation& violation,
                                                    double duration);

/// A scene and all that its queries need.
struct LoadedScene {
  Scene scene;
  BodySet bodies;  ///< The bodies in the scene's order; t = time / duration. Empty where there are
                   ///< robots.
  std::string input_digest;  ///< SHA-256 over the digests of the scene's text and its files.
  /// The bodies and robots of a scene with robots; members are numbered as those of the scene.
  std::shared_ptr<const RobotScene> robots = {};
  std::vector<SceneLimits> limits = {};    ///< The robots that leave a limit.
  std::vector<std::string> warnings = {};  ///< Notes for the user, those about limits included.
  std::vector<FileReport> files = {};      ///< The reports on all files, in the order of their use.
  PairCounts pair_counts = {};             ///< The counts of a check; see also LinksAsBodies.
};

/// The shape of a body of the scene, by its number.
[[nodiscard]] FIRSTCONTACT_API const Shape& shape_of_body(const LoadedScene& loaded,
                                                          std::size_t body);

/// [m]  The margin of a pair of members, with paddings; none where the pair is never tested.
[[nodiscard]] FIRSTCONTACT_API std::optional<double> margin_of_pair(const LoadedScene& loaded,
                                                                    const BodyPair& members);

/// Refuses a scene in which a robot leaves a limit, as `--strict` does.
///
/// @throws std::invalid_argument  names the first limit that a robot leaves, where one does
FIRSTCONTACT_API void require_within_limits(const LoadedScene& loaded);

/// Loads the meshes of a scene that the cache does not hold yet.
///
/// Free bodies rest at their pose.
///
/// @throws ParseError if a mesh file cannot be used
/// @throws std::invalid_argument if the scene, made by hand, holds what read_scene would refuse
[[nodiscard]] FIRSTCONTACT_API LoadedScene load_scene(Scene scene, ShapeCache& cache);

}  // namespace firstcontact
