/// @file
/// A page that plays a planned path, or a trajectory along it.

#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include <firstcontact/scene/scene.h>

namespace firstcontact {
struct PlannedPath;
struct RetimingPath;
struct RetimingScene;
struct TimedMotion;
}  // namespace firstcontact

namespace firstcontact::app {

/// The scene in which the mover runs along its path.
///
/// It runs at the times of the path. Without times it takes eight seconds, which the edges share by
/// their lengths.
[[nodiscard]] Scene scene_in_motion(const PlannedPath& path);

/// The scene in which the robots of a retiming follow their motion.
[[nodiscard]] Scene scene_in_motion(const RetimingPath& input, const RetimingScene& where,
                                    const TimedMotion& motion);

/// Checks a scene once more and writes the page of the answer, with the gap over time.
///
/// @param has_times  whether times are those of the motion; else no velocity is beyond its limit
/// @param viewer  the viewer's page
/// @param stop    ends the check early, without a page
/// @param doing   called with the name of the present work
void write_motion_page(const std::string& file, const std::string& viewer, Scene scene,
                       bool has_times, const std::stop_token& stop,
                       const std::function<void(std::string)>& doing);

}  // namespace firstcontact::app
