#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::scene;

struct Malformed {
  std::string text;
  std::string message;
};

void expect_messages(const std::vector<Malformed>& cases) {
  for (const auto& [text, message] : cases) {
    try {
      (void)parse_scene(text, "s");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ParseError& error) {
      EXPECT_EQ(error.what(), message) << text;
    }
  }
}

/// A scene of one body at a pose.
std::string posed(const std::string& pose) { return scene(body("a", "\"pose\": " + pose)); }

/// A scene of one body with a motion.
std::string moved(const std::string& motion) { return scene(body("a", "\"motion\": " + motion)); }

/// A scene of one body with a shape.
std::string shaped(const std::string& shape) {
  return scene(R"({"name": "a", "shape": )" + shape + "}");
}

std::string with_options(const std::string& options) {
  return scene(body("a"), "\"options\": {" + options + "}");
}

TEST(MalformedJson, IsNamedByLine) {
  const std::string value = "(object, array, string, number, true, false or null)";
  expect_messages({
      {"", "s:1: expected a value " + value + ", got the end of the text"},
      {"\n\n{", "s:3: expected a key in double quotes, got the end of the text"},
      {"{\"a\": 1,\n}", "s:2: expected a key in double quotes, got \"}\""},
      {"{\"a\" 1}", "s:1: expected ':' after the key \"a\", got \"1\""},
      {"{\"a\": 1 \"b\": 2}", "s:1: expected ',' or '}' after a member of an object, got \"\\\"\""},
      {"[1 2]", "s:1: expected ',' or ']' after an element of an array, got \"2\""},
      {"{} x", "s:1: expected the end of the text after the JSON value, got \"x\""},
      {"// hello", "s:1: expected a value, got a comment; JSON has none"},
      {"[NaN]", "s:1: expected a finite number, got \"NaN\"; JSON has no NaN and no infinity"},
      {"[-Infinity]", "s:1: expected a finite number such as -1.5 or 2e-3, got \"-Infinity\""},
      {"[1e999]",
       "s:1: expected a number that fits a double (at most 1.8e308 in size), got \"1e999\""},
      {"[01]", "s:1: expected a finite number such as -1.5 or 2e-3, got \"01\""},
      {"[1.]", "s:1: expected a finite number such as -1.5 or 2e-3, got \"1.\""},
      {"[0x10]", "s:1: expected a finite number such as -1.5 or 2e-3, got \"0x10\""},
      {"[1,5 m]", "s:1: expected ',' or ']' after an element of an array, got \"m\""},
      {"\"a\nb\"",
       "s:1: expected '\"' at the end of a string, got a control character "
       "(a line break is written \\n)"},
      {"\"a", "s:1: expected '\"' at the end of a string, got the end of the text"},
      {"\"\\ud800\"",
       "s:1: expected both halves of a surrogate pair, such as \\ud83d\\ude00, got one"},
      {"[\n\"\xff\"]", "s:2: expected UTF-8, got other bytes"},
      {"{\"a\": 1,\n\"b\": 2,\n\"a\": 3}",
       "s:3: expected each key once, got \"a\" again (first on line 1)"},
      {std::string(65, '['), "s:1: expected at most 64 brackets inside each other, got more"},
  });
}

TEST(MalformedScene, IsNamedByLineAndField) {
  expect_messages({
      {"[]",
       "s:1: expected a scene, an object with \"firstcontact\": 1 and \"bodies\", "
       "got an array of 0"},
      {"{}", "s:1: expected \"firstcontact\": 1, the version of the scene format"},
      {R"({"rigid_body_problem": {}})",
       "s:1: this is a scene of Rigid IPC: such are for \"firstcontact simulate\" alone"},
      {R"({"firstcontact": 2})",
       "s:1: firstcontact: expected 1, the only version of the scene format that is known here, "
       "got 2"},
      {R"({"firstcontact": 1})", "s:1: expected a key \"bodies\", got none"},
      {scene(""), "s:1: bodies: expected at least one body, got none"},
      {scene(body("a") + ",\n" + body("a")),
       "s:2: bodies[1].name: expected a name that no other body has, got \"a\""},
      {scene(body("")), "s:1: bodies[0].name: expected a name, got \"\""},
      {scene("\n7"),
       "s:2: bodies[0]: expected an object with \"name\", \"shape\", \"pose\", \"motion\", "
       "\"dynamics\", \"surface\", got 7"},
      {scene(R"({"name": "a"})"), "s:1: bodies[0]: expected a key \"shape\", got none"},
      {scene(body("a", R"("pose": {}, "motion": {"type": "fixed"})")),
       "s:1: bodies[0].pose: expected either \"pose\" (at rest) or \"motion\", got both; "
       "a motion begins at its own \"from\""},
      {scene(body("a"), R"("robots": [{"name": "arm"}])"),
       "s:1: robots[0]: expected a key \"urdf\", got none"},
      {scene(body("a"), R"("robots": {})"),
       "s:1: robots: expected an array of robots, got an object"},
  });
}

TEST(UnknownKey, NamesTheNearestKnownOne) {
  expect_messages({
      {scene(body("a"), "\n\"option\": {}"), "s:2: option: unknown key; did you mean \"options\"?"},
      {scene(body("a", "\"mtion\": {}")),
       "s:1: bodies[0].mtion: unknown key; did you mean \"motion\"?"},
      {with_options(R"("tolerence": 1)"),
       "s:1: options.tolerence: unknown key; did you mean \"tolerance\"?"},
      {with_options(R"("elephants": 1)"),
       "s:1: options.elephants: unknown key; known are \"tolerance\", \"margin\", \"contacts\", "
       "\"start_contacts\", \"contact_band\", \"deadline\", \"duration\", \"lenient\""},
      {with_options(R"("a \"b\"": 1)"),
       "s:1: options[\"a \\\"b\\\"\"]: unknown key; known are \"tolerance\", \"margin\", "
       "\"contacts\", \"start_contacts\", \"contact_band\", \"deadline\", \"duration\", "
       "\"lenient\""},
      {posed(R"({"quaternion": [1, 0, 0, 0]})"),
       "s:1: bodies[0].pose.quaternion: unknown key; did you mean \"quaternion_wxyz\"?"},
      {moved(R"({"type": "scerw"})"),
       "s:1: bodies[0].motion.type: unknown word \"scerw\"; did you mean \"screw\"?"},
      {with_options(R"("contacts": "al")"),
       "s:1: options.contacts: unknown word \"al\"; did you mean \"all\"?"},
      {scene(body("bolt"), R"("pairs": {"ignore": [["bolt", "blot"]]})"),
       "s:1: pairs.ignore[0][1]: expected the name of a body, got \"blot\"; did you mean "
       "\"bolt\"?"},
  });
}

TEST(MalformedOption, SaysItsRange) {
  expect_messages({
      {with_options(R"("tolerance": -1e-6)"),
       "s:1: options.tolerance: expected a number > 0, got -1e-06"},
      {with_options(R"("tolerance": 0)"), "s:1: options.tolerance: expected a number > 0, got 0"},
      {with_options(R"("tolerance": "1 mm")"),
       "s:1: options.tolerance: expected a number, got \"1 mm\""},
      {with_options(R"("margin": -1)"), "s:1: options.margin: expected a number >= 0, got -1"},
      {with_options(R"("margin": null)"), "s:1: options.margin: expected a number, got null"},
      {with_options(R"("contact_band": -1)"),
       "s:1: options.contact_band: expected a number >= 0, got -1"},
      {with_options(R"("deadline": 0)"), "s:1: options.deadline: expected a number > 0, got 0"},
      {with_options(R"("duration": 0)"), "s:1: options.duration: expected a number > 0, got 0"},
      {scene(body("a"), R"("pairs": {"margin": [["a", "a", 1]]})"),
       "s:1: pairs.margin[0]: expected two bodies, got one twice"},
      {scene(body("a") + "," + body("b"), R"("pairs": {"margin": [["a", "b", -1]]})"),
       "s:1: pairs.margin[0][2]: expected a number >= 0, got -1"},
      {scene(body("a") + "," + body("b"), R"("pairs": {"margin": [["a", "b", 1], ["b", "a", 2]]})"),
       "s:1: pairs.margin[1]: expected one margin for each pair, got a second one"},
      {scene(body("a"), R"("pairs": {"groups": {"g": ["b"]}})"),
       "s:1: pairs.groups.g[0]: expected the name of a body, got \"b\""},
      {scene(body("a"), R"("pairs": {"groups": {"a": ["a"]}})"),
       "s:1: pairs.groups.a: expected for the group a name that no body has"},
      {scene(body("a"), R"("pairs": {"groups": ["a"]})"),
       "s:1: pairs.groups: expected an object of groups, such as {\"fixtures\": [\"a\", \"b\"]}, "
       "got an array of 1"},
      {scene(body("a"), R"("pairs": {"ignore": [["a"]]})"),
       "s:1: pairs.ignore[0]: expected a pair of names, such as [\"a\", \"b\"], got an array of 1"},
  });
}

TEST(MalformedPose, SaysWhatIsWrong) {
  expect_messages({
      {posed("[0, 0, 0]"),
       "s:1: bodies[0].pose: expected an object with \"position\", \"quaternion_wxyz\", \"rpy\", "
       "\"rotation_vector\", \"matrix\", got an array of 3"},
      {posed(R"({"position": [0, 0]})"),
       "s:1: bodies[0].pose.position: expected three numbers, got an array of 2"},
      {posed(R"({"position": [0, "0", 0]})"),
       "s:1: bodies[0].pose.position[1]: expected a number, got \"0\""},
      {posed(R"({"position": [0, 0, 1e61]})"),
       "s:1: bodies[0].pose.position[2]: expected a number of at most 1e60 in size, got 1e+61"},
      {posed(R"({"quaternion_wxyz": [0, 0, 0, 0]})"),
       "s:1: bodies[0].pose.quaternion_wxyz: expected a quaternion [w, x, y, z], not zero, "
       "its length in 1e-60 ... 1e60"},
      {posed(R"({"quaternion_wxyz": [1, 0, 0]})"),
       "s:1: bodies[0].pose.quaternion_wxyz: expected a quaternion [w, x, y, z], not zero, "
       "got an array of 3"},
      {posed(R"({"rpy": [0, 0, 0], "rotation_vector": [0, 0, 0]})"),
       "s:1: bodies[0].pose: expected one of \"quaternion_wxyz\", \"rpy\", \"rotation_vector\", "
       "got 2"},
      {posed(R"({"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]})"),
       "s:1: bodies[0].pose.matrix: expected a matrix of four rows of four numbers, "
       "got an array of 3"},
      {posed(R"({"matrix": [[1, 0, 0, 0], [0, 1.00001, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})"),
       "s:1: bodies[0].pose.matrix: expected a rotation in the upper left 3x3 to within 1e-9"},
      {posed(R"({"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]})"),
       "s:1: bodies[0].pose.matrix: expected a rotation in the upper left 3x3 to within 1e-9"},
      {posed(R"({"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]})"),
       "s:1: bodies[0].pose.matrix: expected [0, 0, 0, 1] as the last row"},
      {posed(R"({"position": [0, 0, 0],
                 "matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})"),
       "s:1: bodies[0].pose: expected \"matrix\" alone: it holds position and rotation"},
  });
}

TEST(MalformedMotion, SaysWhatIsWrong) {
  expect_messages({
      {moved("5"), "s:1: bodies[0].motion: expected an object with \"type\", got 5"},
      {moved("{}"), "s:1: bodies[0].motion: expected a key \"type\", got none"},
      {moved(R"({"type": "vertices"})"), "s:1: bodies[0].motion: expected a key \"to\", got none"},
      {moved(R"({"type": "vertices", "to": [[0, 0, 1], [1, 0, 1]]})"),
       "s:1: bodies[0].motion.to: expected a place for each of the 3 vertices of the shape, got 2"},
      {moved(R"({"type": "vertices", "to": [[0, 0, 1], [1, 0, 1], [0, 1]]})"),
       "s:1: bodies[0].motion.to[2]: expected three numbers, got an array of 2"},
      {moved(R"({"type": "vertices", "from": {}, "to": []})"),
       "s:1: bodies[0].motion.from: expected no \"from\" here: the vertices of the shape say where "
       "they begin"},
      {scene(R"({"name": "a", "shape": {"sphere": {"radius": 1}},
                 "motion": {"type": "vertices", "to": [[0, 0, 1]]}})"),
       "s:2: bodies[0].motion: expected another \"type\" than \"vertices\": only a \"mesh\", or "
       "\"vertices\" with \"triangles\", can deform"},
      {moved(R"({"type": "constant_velocity"})"),
       "s:1: bodies[0].motion: expected \"to\", or \"translation\" and \"rotation_vector\", "
       "got neither"},
      {moved(R"({"type": "constant_velocity", "to": {}, "translation": [0, 0, 0]})"),
       "s:1: bodies[0].motion.translation: expected either \"to\" or \"translation\", got both; "
       "they are two forms of this motion"},
      {moved(R"({"type": "screw", "angle": 1})"),
       "s:1: bodies[0].motion: expected a key \"axis_direction\", got none"},
      {moved(R"({"type": "screw", "axis_direction": [0, 0, 1]})"),
       "s:1: bodies[0].motion: expected \"to\", or an axis with \"angle\" and \"translation\", "
       "got neither"},
      {moved(R"({"type": "screw", "axis_direction": [0, 0, 0], "angle": 1})"),
       "s:1: bodies[0].motion.axis_direction: expected a direction of any length but zero"},
      {moved(R"({"type": "waypoints", "times": [0, 1, 1], "poses": [{}, {}, {}]})"),
       "s:1: bodies[0].motion.times[2]: expected a time later than the one before, 1, got 1"},
      {moved(R"({"type": "waypoints", "times": [-1], "poses": [{}]})"),
       "s:1: bodies[0].motion.times[0]: expected a number >= 0, got -1"},
      {moved(R"({"type": "waypoints", "times": [0, 1], "poses": [{}]})"),
       "s:1: bodies[0].motion.poses: expected as many poses as times, and at least one, "
       "got 1 poses and 2 times"},
      {scene(body("a", R"("motion": {"type": "waypoints", "times": [0, 2], "poses": [{}, {}]})"),
             R"("options": {"duration": 3})"),
       "s:1: options.duration: expected 2, the last time of the waypoints "
       "(or no \"duration\" at all), got 3"},
  });
}

TEST(MalformedShape, SaysWhatIsWrong) {
  expect_messages({
      {shaped("{}"),
       "s:1: bodies[0].shape: expected one of \"mesh\", \"vertices\", \"sphere\", \"capsule\", "
       "\"box\", \"cylinder\", \"cone\", \"ellipsoid\", \"convex_hull\", \"points\", "
       "\"heightmap\", got none"},
      {shaped(R"({"sphere": {"radius": 1}, "box": {"size": [1, 1, 1]}})"),
       "s:1: bodies[0].shape: expected one of \"mesh\", \"vertices\", \"sphere\", \"capsule\", "
       "\"box\", \"cylinder\", \"cone\", \"ellipsoid\", \"convex_hull\", \"points\", "
       "\"heightmap\", got "
       "\"sphere\", "
       "\"box\""},
      {shaped(R"({"shpere": {"radius": 1}})"),
       "s:1: bodies[0].shape.shpere: unknown key; did you mean \"sphere\"?"},
      {shaped(R"({"sphere": 1})"),
       "s:1: bodies[0].shape.sphere: expected an object with \"radius\", got 1"},
      {shaped(R"({"sphere": {"radius": 0}})"),
       "s:1: bodies[0].shape.sphere.radius: expected a number > 0, got 0"},
      {shaped(R"({"capsule": {"radius": 1}})"),
       "s:1: bodies[0].shape.capsule: expected a key \"length\", got none"},
      {shaped(R"({"box": {"size": [1, -1, 1]}})"),
       "s:1: bodies[0].shape.box.size[1]: expected a number > 0, got -1"},
      {shaped(R"({"cylinder": {"radius": 1, "height": 1}})"),
       "s:1: bodies[0].shape.cylinder.height: unknown key; did you mean \"length\"?"},
      {shaped(R"({"cone": {"radius": 1, "length": 1, "enclosure_error": 1e-9}})"),
       "s:1: bodies[0].shape.cone.enclosure_error: expected at least 1e-8 of the radius, got "
       "1e-09"},
      {shaped(R"({"convex_hull": {"vertices": [[0, 0, 0]], "mesh": "a.obj"}})"),
       "s:1: bodies[0].shape.convex_hull: expected either \"mesh\" or \"vertices\", got both"},
      {shaped(R"({"points": "none.pcd"})"),
       "s:1: bodies[0].shape.points: expected a point cloud, found none at \"none.pcd\""},
      {shaped(R"({"points": []})"),
       "s:1: bodies[0].shape.points: expected at least one point, got none"},
      {shaped(R"({"points": [[0, 0, 0]], "solid": true})"),
       "s:1: bodies[0].shape.solid: expected no \"solid\" beside \"points\""},
      {shaped(R"({"heightmap": {"cell": [1, 0], "heights": [[0, 0], [0, 0]]}})"),
       "s:1: bodies[0].shape.heightmap.cell[1]: expected a number > 0, got 0"},
      {shaped(R"({"heightmap": {"cell": [1, 1], "heights": [[0, 0], [0]]}})"),
       "s:1: bodies[0].shape.heightmap.heights[1]: expected a row of two heights or more, as many "
       "as in the first, got an array of 1"},
      {shaped(R"({"cylinder": {"radius": 1, "length": 1}, "radius": 0.1})"),
       "s:1: bodies[0].shape.radius: expected no \"radius\" beside \"cylinder\""},
      {shaped(R"({"box": {"size": [1, 1, 1]}, "radius": -0.1})"),
       "s:1: bodies[0].shape.radius: expected a number >= 0, got -0.1"},
      {shaped(R"({"mesh": "a.obj", "solid": 1})"),
       "s:1: bodies[0].shape.solid: expected true or false, got 1"},
      {shaped(R"({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
                  "solid": true})"),
       "s:1: bodies[0].shape: expected a closed mesh of a solid, got 3 open edges"},
      {shaped(R"({"vertices": [[0, 0, 0]]})"),
       "s:1: bodies[0].shape: expected a key \"triangles\", got none"},
      {shaped(R"({"vertices": [], "triangles": []})"),
       "s:1: bodies[0].shape.vertices: expected at least one vertex, got none"},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": []})"),
       "s:1: bodies[0].shape.triangles: expected at least one triangle, got none "
       "(a point is a triangle [i, i, i])"},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 1]]})"),
       "s:1: bodies[0].shape.triangles[0][2]: expected a vertex index, an integer from 0 to 0, "
       "got 1"},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0.5]]})"),
       "s:1: bodies[0].shape.triangles[0][2]: expected a vertex index, an integer from 0 to 0, "
       "got 0.5"},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0]]})"),
       "s:1: bodies[0].shape.triangles[0]: expected three vertex indices, got an array of 2"},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0]], "scale": 2})"),
       "s:1: bodies[0].shape.scale: expected no \"scale\" beside \"vertices\""},
      {shaped(R"({"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0]], "radius": -1})"),
       "s:1: bodies[0].shape.radius: expected a number >= 0, got -1"},
      {shaped(R"({"mesh": "none.obj"})"),
       "s:1: bodies[0].shape.mesh: expected a mesh file, found none at \"none.obj\""},
      {shaped(R"({"mesh": "package://p/none.obj"})"),
       "s:1: bodies[0].shape.mesh: expected \"package_roots\" in the scene, "
       "to find \"package://p/none.obj\""},
  });
}

TEST(MalformedScene, NamesTheLineOfTheWholeFile) {
  try {
    (void)parse_scene("\n{}", "lines.jsonl", 41);
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_EQ(error.line(), 42);
  }
}

TEST(SceneFile, ThatCannotBeReadIsSaidSo) {
  try {
    (void)read_scene("no_such_scene.json");
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_STREQ(error.what(), "no_such_scene.json: expected a scene file, found none");
  }
  try {
    (void)read_scene("/");
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_STREQ(error.what(), "/: expected a scene file, got a folder");
  }
}

}  // namespace
}  // namespace firstcontact
