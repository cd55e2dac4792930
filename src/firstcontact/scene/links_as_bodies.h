/// @file
/// The links of a scene's robots as bodies of their own, for a simulation.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

/// A geometry of a link, in its own frame G.
struct LinkGeometryPose {
  std::size_t robot = 0;  ///< Index of the robot in the scene.
  std::size_t link = 0;   ///< Index of the link in its model.
  Pose X_LG = {};
};

/// A scene without robots, with the geometries of their links as bodies behind its own.
///
/// These link bodies are in the order of robots, links and geometries. The first geometry of a link
/// is called "robot/link", the others "robot/link#2" and so on. On a robot with dynamics it is a
/// free body, with its share of the link's mass. On another robot it rests, or has waypoints at
/// every step of the simulation. Pairs that a robot leaves out are ignored. Rules for links hold
/// for all of their geometries, and margins contain the padding. Pairs are counted by links, as a
/// simulation tests them (count_simulated_pairs).
struct LinksAsBodies {
  LoadedScene loaded;
  std::vector<LinkGeometryPose> geometries = {};  ///< Geometries of the link bodies.
  std::vector<RobotModel> models =
      {};  ///< One for each robot; links have the mass that a density gives.
};

/// Makes the geometries of links bodies of the scene.
///
/// @param loaded  with a simulation
/// @throws std::invalid_argument  names the robot: it carries a body or has a tracking error, or
///         links to which a density is given are not closed
[[nodiscard]] FIRSTCONTACT_API LinksAsBodies links_as_bodies(const LoadedScene& loaded);

/// The names of a scene's bodies, with the geometries of links that are bodies then.
[[nodiscard]] FIRSTCONTACT_API std::vector<std::string> names_with_links(const Scene& scene);

}  // namespace firstcontact
