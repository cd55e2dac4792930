/// @file
/// Paths as in files, made without a planner.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_scene.h>

#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact::test {

/// Fixture with consistent paths of a body and of one or two arms.
class PlannedPathFile : public testing::Test {
 protected:
  /// Makes the common parts of a path of any mover, with its scene.
  static PlannedPath over(Scene scene, std::size_t numbers) {
    PlannedPath path;
    path.scene = std::move(scene);
    path.is_proven = true;
    path.waypoints = {std::vector<double>(numbers, 0.0), std::vector<double>(numbers, 0.5),
                      std::vector<double>(numbers, 1.0)};
    path.clearances = {0.25, std::nullopt};
    path.margin = 0.01;
    path.clearance = 0.25;
    path.goals = {std::vector<double>(numbers, 2.0), path.waypoints.back()};
    path.goal = 1;
    path.cost = 3.0;
    path.statistics.blocked = {{{"wall", "peg"}, 4}};
    path.version = "1.2.3";
    path.input_digest = std::string(64, 'a');
    return path;
  }

  static PlannedPath of_body() {
    PlannedPath path =
        over(parse_scene(scene(test::body("wall") + "," + test::body("peg")), "scene.json"), 7);
    path.body = "peg";
    return path;
  }

  [[nodiscard]] PlannedPath of_robots(std::vector<std::string> robots) const {
    const std::string arm = R"(", "urdf": "arm.urdf"})";
    PlannedPath path = over(parse_scene(R"({"firstcontact": 1, "robots": [{"name": "left)" + arm +
                                            R"(, {"name": "right)" + arm + "]}",
                                        folder_.path() / "scene.json"),
                            robots.size());
    for (const std::string& robot : robots) {
      path.joints.push_back(robots.size() == 1 ? "elbow" : robot + "/elbow");
      path.turnings.push_back(Turning::shortest);
    }
    path.robots = std::move(robots);
    return path;
  }

  static PlannedPath in_time() {
    PlannedPath path = of_body();
    path.times = {0.0, 0.25, path.scene.duration};
    return path;
  }

  ArmFolder folder_;
};

}  // namespace firstcontact::test
