/// @file
/// Robots as bodies: a hand becomes a tool, an arm at rest an obstacle.

#pragma once

namespace firstcontact {
class ShapeCache;
struct Scene;
}  // namespace firstcontact

namespace firstcontact::detail {

/// Replaces each robot at rest by one body, behind the bodies of the scene: a mesh of the triangles
/// of all its links.
///
/// The body has the name of the robot, and the frame of its root link. Its vertices are rounded to
/// doubles, which define it from then on. Curved geometries become the triangles that enclose them:
/// those of cylinders and cones, and for spheres those of make_ellipsoid. It is solid where all of
/// its geometries are. Tools that are robots become tools that are bodies.
///
/// A tool with grips has a body for each link with geometry. The body of the tool has the robot's
/// name, and one link (find_moving_links()). The others are named "robot/link", and stand behind
/// all robots.
///
/// @param scene  with haptics
/// @throws std::invalid_argument  names the robot: it moves, has dynamics or tracking errors, is
///         padded or holds a body; a rule for pairs names only some of its links; or it meets a
///         tool at the start
/// @throws as load_scene
void make_robots_bodies(Scene& scene, ShapeCache& cache);

}  // namespace firstcontact::detail
