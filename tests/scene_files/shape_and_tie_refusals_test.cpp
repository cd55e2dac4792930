// Refused shapes, motions, poses, forces and ties, beyond those of malformed_scene_test.cpp: each
// with its whole message. Values just inside a range are accepted.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

/// The message about a scene, behind the place that all of its cases have.
std::string refusal_in(const std::string& scene, const std::string& place) {
  const std::string text = test::message_of<ParseError>([&] { (void)parse_scene(scene, "s"); });
  const std::string whole = "s:1: " + place;
  return text.starts_with(whole) ? text.substr(whole.size()) : text;
}

using Refusals = std::vector<std::pair<std::string, std::string>>;

void expect_shape_refusals(const Refusals& cases) {
  for (const auto& [shape, message] : cases) {
    EXPECT_EQ(
        refusal_in(test::scene(R"({"name": "a", "shape": )" + shape + "}"), "bodies[0].shape"),
        message)
        << shape;
  }
}

TEST(ShapeRefusals, HaveTheRangeOfSizes) {
  const std::string range = "expected a length in 1e-60 ... 1e60, got ";
  expect_shape_refusals(
      {{R"({"sphere": {"radius": 9e-61}})", ".sphere.radius: " + range + "9e-61"},
       {R"({"sphere": {"radius": 1e-60}})", "accepted"},
       {R"({"sphere": {"radius": 1.1e60}})", ".sphere.radius: " + range + "1.1e+60"},
       {R"({"capsule": {"radius": 1, "length": 0}})", "accepted"},
       {R"({"capsule": {"radius": 1, "length": -0.0}})", "accepted"},
       {R"({"capsule": {"radius": 1, "length": 1e-61}})", ".capsule.length: " + range + "1e-61"},
       {R"({"capsule": {"radius": 1, "length": -1}})",
        ".capsule.length: expected a number >= 0, got -1"},
       {R"({"box": {"size": [1, 1, 0]}})", ".box.size[2]: expected a number > 0, got 0"},
       {R"({"box": {"size": [1e-61, 1, 1]}})", ".box.size[0]: " + range + "1e-61"},
       {R"({"box": {"size": [1, 1, 1, 1]}})",
        ".box.size: expected three numbers, got an array of 4"},
       {R"({"cylinder": {"radius": 1}})", ".cylinder: expected a key \"length\", got none"},
       {R"({"cylinder": {"radius": 1, "length": 1e61}})", ".cylinder.length: " + range + "1e+61"},
       {R"({"heightmap": {"cell": [1e-61, 1], "heights": [[0, 0], [0, 0]]}})",
        ".heightmap.cell[0]: " + range + "1e-61"}});
}

TEST(ShapeRefusals, HaveTheRangeOfEnclosures) {
  expect_shape_refusals(
      {{R"({"cylinder": {"radius": 2, "length": 1, "enclosure_error": 1.9e-8}})",
        ".cylinder.enclosure_error: expected at least 1e-8 of the radius, got 1.9e-08"},
       {R"({"cylinder": {"radius": 2, "length": 1, "enclosure_error": 2e-8}})", "accepted"},
       {R"({"cone": {"radius": 1, "length": 1, "enclosure_error": 0}})",
        ".cone.enclosure_error: expected a number > 0, got 0"},
       {R"({"ellipsoid": {"radii": [1, 2, 10], "enclosure_error": 0.0019}})",
        ".ellipsoid.enclosure_error: expected at least 2e-4 of the greatest radius, got 0.0019"},
       {R"({"ellipsoid": {"radii": [1, 2, 10], "enclosure_error": 0.002}})", "accepted"},
       {R"({"ellipsoid": {"radii": [1, 1e-31, 1]}})",
        ".ellipsoid.radii: expected a least radius of at least 1e-30 of the greatest, got an array "
        "of 3"},
       {R"({"ellipsoid": {"radii": [1, -1, 1]}})",
        ".ellipsoid.radii[1]: expected a number > 0, got -1"},
       {R"({"ellipsoid": {"radii": 1}})", ".ellipsoid.radii: expected three numbers, got 1"},
       {R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0]], "enclosure_error": -1})",
        ".enclosure_error: expected a number >= 0, got -1"},
       {R"({"points": [[0, 0, 0]], "enclosure_error": 1})",
        ".enclosure_error: expected no \"enclosure_error\" beside \"points\""},
       {R"({"convex_hull": {"vertices": [[0, 0, 0]]}, "solid": true})",
        ".solid: expected no \"solid\" beside \"convex_hull\""}});
}

TEST(ShapeRefusals, SayWhatBelongsTogether) {
  const std::string heights =
      "expected the path of a file of heights, or an array of two rows or more, got ";
  const std::string row = "expected a row of two heights or more, as many as in the first, got ";
  const auto map = [](const std::string& inside) {
    return R"({"heightmap": {"cell": [1, 1], "heights": )" + inside + "}}";
  };
  expect_shape_refusals(
      {{R"({"convex_hull": {}})",
        ".convex_hull: expected either \"mesh\" or \"vertices\", got neither"},
       {R"({"convex_hull": {"vertices": []}})",
        ".convex_hull.vertices: expected at least one vertex, got none"},
       {R"({"convex_hull": {"vertices": [[0, 0, 0]], "scale": 2}})",
        ".convex_hull.scale: expected no \"scale\" beside \"vertices\""},
       {R"({"points": [[0, 0, 0]], "scale": 2})",
        ".scale: expected \"scale\" beside the path of a point cloud only"},
       {R"({"points": {}})", ".points: expected an array of points [x, y, z], got an object"},
       {R"({"points": [[0, 0, 0], 7]})", ".points[1]: expected three numbers, got 7"},
       {R"({"vertices": "a.off", "triangles": []})",
        ".vertices: expected an array of vertices [x, y, z], got \"a.off\""},
       {R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 4294967296]]})",
        ".triangles[0][2]: expected a vertex index, an integer from 0 to 0, got 4294967296"},
       {R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, -1]]})",
        ".triangles[0][2]: expected a vertex index, an integer from 0 to 0, got -1"},
       {R"({"heightmap": {"cell": 1, "heights": []}})",
        ".heightmap.cell: expected two lengths [x, y], got 1"},
       {R"({"heightmap": {"cell": [1, 1, 1], "heights": []}})",
        ".heightmap.cell: expected two lengths [x, y], got an array of 3"},
       {map("[]"), ".heightmap.heights: " + heights + "an array of 0"},
       {map("[[0, 0]]"), ".heightmap.heights: " + heights + "an array of 1"},
       {map("7"), ".heightmap.heights: " + heights + "7"},
       {map("[[0], [0]]"), ".heightmap.heights[0]: " + row + "an array of 1"},
       {map("[[], []]"), ".heightmap.heights[0]: " + row + "an array of 0"},
       {map("[[0, 0], [0, 0, 0]]"), ".heightmap.heights[1]: " + row + "an array of 3"},
       {map("[[0, 1e61], [0, 0]]"),
        ".heightmap.heights[0][1]: expected a number of at most 1e60 in size, got 1e+61"},
       {map("\"none.png\""),
        ".heightmap.heights: expected a file of heights, found none at \"none.png\""},
       {R"({"mesh": ""})", ".mesh: expected the path of a mesh file, got \"\""},
       {"null",
        ": expected an object with \"mesh\", \"scale\", \"radius\", \"solid\", \"vertices\", "
        "\"triangles\", \"enclosure_error\", \"sphere\", \"capsule\", \"box\", \"cylinder\", "
        "\"cone\", \"ellipsoid\", \"convex_hull\", \"points\", \"heightmap\", got null"}});
}

TEST(MotionRefusals, SayWhatIsWrong) {
  const Refusals cases = {
      {R"({"type": "fixed", "from": {}})", ".from: unknown key; known are \"type\", \"pose\""},
      {R"({"type": ["fixed"]})",
       ".type: expected one of \"fixed\", \"constant_velocity\", \"screw\", \"waypoints\", "
       "\"vertices\", got an array of 1"},
      {R"({"type": "screw", "to": {}, "angle": 1})",
       ".angle: expected either \"to\" or \"angle\", got both; they are two forms of this motion"},
      {R"({"type": "screw", "to": {}, "axis_point": [0, 0, 0]})",
       ".axis_point: expected either \"to\" or \"axis_point\", got both; they are two forms of "
       "this motion"},
      {R"({"type": "constant_velocity", "to": {}, "rotation_vector": [0, 0, 1]})",
       ".rotation_vector: expected either \"to\" or \"rotation_vector\", got both; they are two "
       "forms of this motion"},
      {R"({"type": "waypoints", "times": [], "poses": []})",
       ".poses: expected as many poses as times, and at least one, got 0 poses and 0 times"},
      {R"({"type": "waypoints", "times": [0, "1"], "poses": []})",
       ".times[1]: expected a number, got \"1\""},
      {R"({"type": "waypoints", "times": [0, 1], "poses": [{}, {}], "between": "spline"})",
       ".between: unknown word \"spline\"; known are \"constant_velocity\", \"screw\""},
      {R"({"type": "vertices", "pose": {}, "to": []})",
       ".pose: expected no \"pose\" here: the vertices of the shape say where they begin"},
      {R"({"type": "vertices", "to": "away"})",
       ".to: expected an array of places, one for each vertex, got \"away\""},
      {R"({"type": "vertices", "to": [], "between": "screw"})",
       ".between: unknown key; known are \"type\", \"to\""}};
  for (const auto& [motion, message] : cases) {
    EXPECT_EQ(refusal_in(test::scene(test::body("a", "\"motion\": " + motion)), "bodies[0].motion"),
              message)
        << motion;
  }
}

TEST(PoseRefusals, HaveTheRangeOfQuaternions) {
  const std::string wrong =
      ".quaternion_wxyz: expected a quaternion [w, x, y, z], not zero, its length in 1e-60 ... "
      "1e60";
  const Refusals cases = {{"[9e-61, 0, 0, 0]", wrong},
                          {"[0, 0, 0, -1e-60]", "accepted"},
                          {"[0, 1e60, 0, 0]", "accepted"},
                          {"[1, 2e60, 0, 0]", wrong}};
  for (const auto& [quaternion, message] : cases) {
    EXPECT_EQ(refusal_in(test::scene(
                             test::body("a", R"("pose": {"quaternion_wxyz": )" + quaternion + "}")),
                         "bodies[0].pose"),
              message)
        << quaternion;
  }
  EXPECT_EQ(refusal_in(test::scene(test::body("a", R"("pose": {"matrix": [[1, 0, 0, 0], [0, 1, 0],
              [0, 0, 1, 0], [0, 0, 0, 1]]})")),
                       "bodies[0].pose"),
            ".matrix[1]: expected a row of four numbers, got an array of 3");
}

// Moments whose sums or squares would overflow are those of some body all the same, or are not.
TEST(InertiaRefusals, HoldForNumbersOfAllSizes) {
  const auto said = [](const std::string& inertia) {
    return refusal_in(test::scene(test::body("a", R"("dynamics": {"inertia": )" + inertia + "}")),
                      "bodies[0].dynamics.inertia: expected ");
  };
  EXPECT_EQ(said("[[1e60, 0, 0], [0, 1e60, 0], [0, 0, 1e60]]"), "accepted");
  EXPECT_EQ(said("[[1e-320, 0, 0], [0, 1e-320, 0], [0, 0, 1e-320]]"), "accepted");
  EXPECT_EQ(said("[[1, 0, 0], [0, 1e-300, 0], [0, 0, 1]]"), "accepted");
  EXPECT_EQ(said("[[1, 0, 0], [0, -1, 0], [0, 0, 1]]"), "principal moments > 0");
  EXPECT_EQ(said("7"), "a matrix of three rows of three numbers, got 7");
  EXPECT_EQ(said("[[1, 0, 0], [0, 1, 0], [0, 0]]").substr(0, 5), "s:1: ");
}

/// A scene of two bodies, an arm and this tie.
class TieFile : public testing::Test {
 protected:
  [[nodiscard]] Scene parse(const std::string& tie) const {
    return parse_scene(test::scene(test::body("a", R"("dynamics": {})") + "," + test::body("b"),
                                   R"("robots": [{"name": "r", "urdf": "arm.urdf"}],
                       "pairs": {"groups": {"g": ["a"]}}, "simulation": {"ties": [)" +
                                       tie + "]}"),
                       folder_.path() / "s.json");
  }

  [[nodiscard]] std::string said(const std::string& tie) const {
    const std::string text = test::message_of<ParseError>([&] { (void)parse(tie); });
    const std::string place = "simulation.ties[0]";
    const std::size_t at = text.find(place);
    return at == std::string::npos ? text : text.substr(at + place.size());
  }

  test::ArmFolder folder_;
};

TEST_F(TieFile, SaysWhatIsWrong) {
  const std::string name = "expected the name of a body, or robot/link, got ";
  const std::string line = R"({"type": "spring", "bodies": ["a", null], )";
  const std::string points = R"("points": [[0, 0, 0], [1, 0, 0]])";
  const Refusals cases = {
      {"7", ": expected an object with \"type\", got 7"},
      {R"({"bodies": ["a", "b"]})", ": expected a key \"type\", got none"},
      {R"({"type": "weld"})", ": expected a key \"bodies\", got none"},
      {R"({"type": "weld", "bodies": ["a"]})",
       ".bodies: expected a pair of names, such as [\"a\", \"robot/link\"]; null is the world, got "
       "an array of 1"},
      {R"({"type": "weld", "bodies": ["a", "r"]})",
       ".bodies[1]: " + name + "the robot or group \"r\""},
      {R"({"type": "weld", "bodies": ["g", null]})",
       ".bodies[0]: " + name + "the robot or group \"g\""},
      {R"({"type": "weld", "bodies": ["a", "r/tpi"]})",
       ".bodies[1]: " + name + "\"r/tpi\"; did you mean \"r/tip\"?"},
      {R"({"type": "weld", "bodies": ["a", 7]})",
       ".bodies[1]: expected the name of a body, or robot/link, got 7"},
      {R"({"type": "weld", "bodies": ["a", "b"], "axis": [0, 0, 1]})",
       ".axis: unknown key; known are \"type\", \"bodies\", \"points\""},
      {R"({"type": "hinge", "bodies": ["a", "b"], "stiffness": 1})",
       ".stiffness: unknown key; known are \"type\", \"bodies\", \"points\", \"axis\""},
      {line + R"("stiffness": 1})", ": expected \"points\": a point of each body of the spring"},
      {R"({"type": "cable", "bodies": ["a", null], "points": [[0, 0, 0], null]})",
       ": expected \"points\": a point of each body of the cable"},
      {R"({"type": "pin", "bodies": ["a", null], "points": [null, null]})",
       ": expected \"points\": a point of at least one of the bodies; null is where the other one "
       "is at the start"},
      {line + R"("points": [[0, 0, 0]]})",
       ".points: expected a pair of points, such as [[0, 0, 0.1], [0, 0, 0]], got an array of 1"},
      {line + R"("points": [[0, 0, 0], [0, 0]]})",
       ".points[1]: expected three numbers, got an array of 2"},
      {line + points + "}", ": expected \"stiffness\" or \"damping\" of the spring, got neither"},
      {line + points + R"(, "damping": 0})",
       ": expected \"stiffness\" or \"damping\" of the spring, got neither"},
      {line + points + R"(, "damping": 5e-324})", "accepted"},
      {line + points + R"(, "stiffness": 0})", ".stiffness: expected a number > 0, got 0"},
      {line + points + R"(, "stiffness": 1, "length": -1})",
       ".length: expected a number >= 0, got -1"},
      {line + points + R"(, "stiffness": 1, "length": 0})", "accepted"},
      {R"({"type": "cable", "bodies": ["a", null], "length": 0, )" + points + "}",
       ".length: expected a number > 0, got 0"},
      {R"({"type": "cable", "bodies": ["a", null], "damping": 1, )" + points + "}",
       ".damping: \"damping\" of a cable needs a \"stiffness\"; without one it does not stretch"},
      {R"({"type": "hinge", "bodies": ["a", null], "axis": [0, 0, 0], )" + points + "}",
       ".axis: expected an axis that is not zero"}};
  for (const auto& [tie, message] : cases) {
    EXPECT_EQ(said(tie), message) << tie;
  }
}

TEST_F(TieFile, NumbersLinksBehindBodies) {
  const Scene scene = parse(
      R"({"type": "weld", "bodies": ["r/tip", "b"]}, {"type": "weld", "bodies": [null, "a"]})");
  const std::vector<Tie>& ties = scene.simulation.value().ties;
  ASSERT_EQ(ties.size(), 2u);
  EXPECT_EQ(ties[0].bodies[0], 4u);
  EXPECT_EQ(ties[0].bodies[1], 1u);  // As they are given: a hinge has its axis in the first.
  EXPECT_EQ(ties[1].bodies[0], std::nullopt);
}

}  // namespace
}  // namespace firstcontact
