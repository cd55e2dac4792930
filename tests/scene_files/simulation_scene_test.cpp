#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/simulation_duration.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::scene;

const std::string kWaypoints =
    R"("motion": {"type": "waypoints", "times": [0, 3], "poses": [{}, {}]})";

std::string free_body(const std::string& dynamics) {
  return scene(body("a", "\"dynamics\": {" + dynamics + "}"));
}

std::string simulated(const std::string& simulation) {
  return scene(body("a") + "," + body("b"), "\"simulation\": {" + simulation + "}");
}

std::string error_of(const std::string& text) {
  try {
    (void)parse_scene(text, "s");
  } catch (const ParseError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_simulation_messages(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [text, message] : cases) {
    EXPECT_EQ(error_of(text), "s:1: " + message) << text;
  }
}

TEST(SimulationScene, TakesEveryKey) {
  const Scene scene = read_scene(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                 "tests/fuzz/corpus/fuzz_scene/good/simulation.json");
  const FreeBody& crate = scene.bodies.at(0).free.value();
  EXPECT_EQ(std::get<FixedMotion>(scene.bodies[0].motion).pose.position.z(), 2.0);
  EXPECT_EQ(crate.density, 500.0);
  EXPECT_EQ(crate.mass, std::nullopt);
  EXPECT_EQ(crate.linear_velocity, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(crate.angular_velocity, Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(scene.bodies[0].surface.friction, 0.4);
  EXPECT_EQ(scene.bodies[0].surface.restitution, 0.1);
  EXPECT_EQ(crate.locked_translation, (std::array{false, true, false}));
  EXPECT_EQ(crate.locked_rotation, (std::array{true, false, true}));
  ASSERT_EQ(crate.forces.size(), 2u);
  EXPECT_EQ(crate.forces[0].from, 0.25);
  EXPECT_EQ(crate.forces[0].to, 0.5);
  EXPECT_EQ(crate.forces[0].force, Eigen::Vector3d(10, 0, 0));
  EXPECT_EQ(crate.forces[0].torque, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(crate.forces[1].from, 0.0);
  EXPECT_TRUE(std::isinf(crate.forces[1].to));

  const FreeBody& cloth = scene.bodies.at(1).free.value();
  EXPECT_EQ(cloth.mass, 2.0);
  EXPECT_EQ(cloth.centre_of_mass, Eigen::Vector3d(0.3, 0.3, 0));
  EXPECT_EQ(cloth.inertia.value()(0, 1), 0.1);
  EXPECT_EQ(cloth.inertia.value()(2, 2), 4.0);

  EXPECT_FALSE(scene.bodies.at(2).free);
  EXPECT_EQ(scene.bodies[2].surface.friction, 0.8);
  EXPECT_EQ(scene.bodies[2].surface.restitution, std::nullopt);
  EXPECT_EQ(scene.bodies[2].surface.velocity, Eigen::Vector3d(0.5, 0.0, -0.25));

  const Simulation& simulation = scene.simulation.value();
  EXPECT_EQ(simulation.duration, 2.0);
  EXPECT_EQ(simulation.step, 0.01);
  EXPECT_EQ(simulation.contact_distance, 1e-4);
  EXPECT_EQ(simulation.impacts, ImpactLaw::simultaneous);
  EXPECT_EQ(Simulation().impacts, ImpactLaw::sequential);
  ASSERT_EQ(simulation.pairs.size(), 2u);
  EXPECT_EQ(simulation.pairs[0].bodies, (BodyPair{0, 2}));
  EXPECT_EQ(simulation.pairs[0].surface.friction, 0.2);
  EXPECT_EQ(simulation.pairs[0].surface.restitution, 0.0);
  EXPECT_EQ(simulation.pairs[1].surface.restitution, std::nullopt);
}

TEST(SimulationScene, TakesTiesOfEveryType) {
  const Scene scene = read_scene(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                 "tests/fuzz/corpus/fuzz_scene/good/ties.json");
  const std::vector<Tie>& ties = scene.simulation.value().ties;
  ASSERT_EQ(ties.size(), 7u);
  EXPECT_EQ(ties[0].type, TieType::spring);
  EXPECT_EQ(ties[0].bodies[0], std::nullopt);
  EXPECT_EQ(ties[0].bodies[1], 0u);
  EXPECT_EQ(ties[0].points[1], Eigen::Vector3d(0, 0, 0.5));
  EXPECT_EQ(ties[0].length, 1.5);
  EXPECT_EQ(ties[0].stiffness, 200.0);
  EXPECT_EQ(ties[0].damping, 2.0);
  EXPECT_EQ(ties[1].stiffness, std::nullopt);
  EXPECT_EQ(ties[3].type, TieType::cable);
  EXPECT_EQ(ties[3].length, std::nullopt);
  EXPECT_EQ(ties[4].type, TieType::hinge);
  EXPECT_EQ(ties[4].axis, Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(ties[4].points[1], std::nullopt);
  EXPECT_EQ(ties[5].type, TieType::pin);
  EXPECT_EQ(ties[6].type, TieType::weld);
}

TEST(SimulationScene, IsThereWhereABodyIsFree) {
  EXPECT_FALSE(parse_scene(scene(body("a")), "s").simulation);
  const Scene free = parse_scene(free_body(""), "s");
  ASSERT_TRUE(free.simulation);
  EXPECT_EQ(free.simulation->duration, 1.0);
  EXPECT_EQ(free.simulation->gravity, Eigen::Vector3d(0, 0, -9.81));
}

// Motions without times take the scene's duration, so that it says how fast they are.
TEST(SimulationScene, LastsAsLongAsIsSaid) {
  const auto durations = [](const std::string& text) {
    const Scene read = parse_scene(text, "s");
    return std::pair(read.duration, read.simulation.value().duration);
  };
  EXPECT_EQ(durations(simulated(R"("duration": 2)")), std::pair(2.0, 2.0));
  EXPECT_EQ(durations(simulated("")), std::pair(1.0, 1.0));
  const std::string moved = body("a", kWaypoints);
  // Until the last waypoint; longer than that; and shorter.
  EXPECT_EQ(durations(scene(moved, R"("simulation": {})")), std::pair(3.0, 3.0));
  EXPECT_EQ(durations(scene(moved, R"("simulation": {"duration": 5})")), std::pair(5.0, 5.0));
  EXPECT_EQ(durations(scene(moved, R"("simulation": {"duration": 2})")), std::pair(3.0, 2.0));
  const std::string options = R"("simulation": {}, "options": {"duration": 4})";
  EXPECT_EQ(durations(scene(body("a"), options)), std::pair(4.0, 4.0));
}

// As `--duration` asks.
TEST(SimulationScene, KeepsRatesForAnotherDuration) {
  const std::string motion = R"("motion": {"type": "constant_velocity", )";
  const std::string bodies =
      body("a", motion + R"("translation": [2, 0, 0], "rotation_vector": [0, 0, 4]})") + "," +
      body("b", motion + R"("to": {"position": [1, 0, 0]}})");
  const Scene scene = parse_scene(test::scene(bodies, R"("simulation": {"duration": 2})"), "s");
  Scene shorter = scene;
  set_simulation_duration(shorter, 1.0);
  EXPECT_EQ(shorter.simulation.value().duration, 1.0);
  EXPECT_EQ(shorter.duration, 2.0);
  const Scene again = parse_scene(write_scene(shorter), "s");
  EXPECT_EQ(std::pair(again.duration, again.simulation.value().duration), std::pair(2.0, 1.0));
  Scene longer = scene;
  set_simulation_duration(longer, 6.0);
  EXPECT_EQ(longer.duration, 6.0);
  for (const Body& body : longer.bodies) {
    const Body& before = scene.bodies.at(body.name == "a" ? 0 : 1);
    const Pose now = normalised_motion(body.motion, 6.0).pose(1.0 / 6.0);
    const Pose then = normalised_motion(before.motion, 2.0).pose(0.5);
    EXPECT_LE((now.position - then.position).norm(), 1e-15) << body.name;
    EXPECT_LE(now.rotation.angularDistance(then.rotation), 1e-15) << body.name;
  }
  EXPECT_EQ(normalised_motion(longer.bodies[0].motion, 6.0).pose(1.0).position.x(), 6.0);
  EXPECT_EQ(normalised_motion(longer.bodies[1].motion, 6.0).pose(1.0).position.x(), 1.0);
}

TEST(SimulationScene, TakesStepsForItsWholeDuration) {
  const auto steps = [](double duration, double step) {
    Simulation simulation;
    simulation.duration = duration;
    simulation.step = step;
    return simulation_step_count(simulation);
  };
  EXPECT_EQ(steps(0.3, 0.1), 3u);    // 0.3 / 0.1 < 3.
  EXPECT_EQ(steps(0.07, 0.01), 7u);  // 0.07 / 0.01 > 7.
  EXPECT_EQ(steps(0.31, 0.1), 4u);
  EXPECT_EQ(steps(0.01, 0.1), 1u);
}

TEST(SimulationScene, NumbersPairsAnewWithTheirBodies) {
  Scene read = parse_scene(simulated(R"("pairs": [{"bodies": ["b", "a"], "friction": 1}])"), "s");
  EXPECT_EQ(read.simulation.value().pairs[0].bodies, (BodyPair{0, 1}));
  // As if the second were a link of a robot.
  read.bodies.pop_back();
  add_body(read, {.name = "c", .shape = {.source = SphereShape{1.0}}, .motion = {}});
  EXPECT_EQ(read.simulation->pairs[0].bodies, (BodyPair{0, 2}));
}

TEST(MalformedDynamics, SaysWhatIsWrong) {
  const std::string a = "bodies[0].dynamics";
  expect_simulation_messages({
      {free_body(R"("densty": 1)"), a + ".densty: unknown key; did you mean \"density\"?"},
      {free_body(R"("density": 0)"), a + ".density: expected a number > 0, got 0"},
      {free_body(R"("density": 1, "mass": 1)"),
       a + ".mass: expected either \"density\" or \"mass\", got both"},
      {free_body(R"("friction": -1)"), a + ".friction: expected a number >= 0, got -1"},
      {free_body(R"("restitution": 1.5)"),
       a + ".restitution: expected a number from 0 to 1, got 1.5"},
      {free_body(R"("linear_velocity": [0, 0])"),
       a + ".linear_velocity: expected three numbers, got an array of 2"},
      {free_body(R"("angular_velocity": [0, 2e8, 0])"),
       a + ".angular_velocity: expected an angular velocity of at most 1e8 rad/s, got an array of "
           "3"},
      {free_body(R"("locked_rotation": [true, false])"),
       a + ".locked_rotation: expected three of true and false, for the axes x, y, z of the "
           "world, got an array of 2"},
      {free_body(R"("locked_rotation": [true, false, 1])"),
       a + ".locked_rotation[2]: expected true or false, got 1"},
      {free_body(R"("forces": [{"from": 1}])"),
       a + ".forces[0]: expected \"force\" or \"torque\", got neither"},
      {free_body(R"("forces": [{"from": 1, "to": 1, "force": [0, 0, 0]}])"),
       a + ".forces[0].to: expected a time later than \"from\", got 1"},
      {scene(body("a", R"("dynamics": {}, "motion": {"type": "fixed"})")),
       a + ": expected either \"dynamics\" (moved by forces, from its \"pose\") or \"motion\" "
           "(moved as it says), got both"},
      {scene(body("a", R"("dynamics": {}, "surface": {"friction": 1})")),
       "bodies[0].surface: expected \"friction\" and \"restitution\" in \"dynamics\", where a "
       "body has them"},
      {scene(body("a", R"("surface": {"density": 1})")),
       "bodies[0].surface.density: unknown key; known are \"friction\", \"restitution\", "
       "\"velocity\""},
  });
}

TEST(MalformedInertia, SaysWhatNoBodyHas) {
  const std::string a = "bodies[0].dynamics.inertia: expected ";
  expect_simulation_messages({
      {free_body(R"("inertia": [[1, 0, 0], [0, 1, 0]])"),
       a + "a matrix of three rows of three numbers, got an array of 2"},
      {free_body(R"("inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]])"),
       a + "a symmetric matrix: row i, column j as row j, column i"},
      {free_body(R"("inertia": [[1, 2, 0], [2, 1, 0], [0, 0, 1]])"), a + "principal moments > 0"},
      {free_body(R"("inertia": [[0, 0, 0], [0, 0, 0], [0, 0, 0]])"), a + "principal moments > 0"},
      {free_body(R"("inertia": [[1, 0, 0], [0, 1, 0], [0, 0, 2.001]])"),
       a + "principal moments of which none is greater than the sum of the other two: no body has "
           "such"},
  });
  // A flat body, of tiny size, as it is printed.
  EXPECT_EQ(error_of(free_body(R"("inertia": [[1e-30, 0, 0], [0, 1e-30, 0], [0, 0, 2e-30]])")),
            "accepted");
}

TEST(MalformedSimulation, SaysWhatIsWrong) {
  expect_simulation_messages({
      {simulated(R"("gravty": [0, 0, 0])"),
       "simulation.gravty: unknown key; did you mean \"gravity\"?"},
      {simulated(R"("step": 0)"), "simulation.step: expected a number > 0, got 0"},
      {simulated(R"("duration": -1)"), "simulation.duration: expected a number > 0, got -1"},
      {simulated(R"("contact_distance": 0)"),
       "simulation.contact_distance: expected a number > 0, got 0"},
      {simulated(R"("impacts": "one by one")"),
       "simulation.impacts: unknown word \"one by one\"; known are \"sequential\", "
       "\"simultaneous\""},
      {simulated(R"("jams": "stop")"),
       "simulation.jams: unknown word \"stop\"; known are \"lose_time\", \"wait\""},
      {simulated(R"("events": 0)"), "simulation.events: expected a number of events > 0, got 0"},
      {simulated(R"("pairs": [{"bodies": ["a", "bb"], "friction": 1}])"),
       "simulation.pairs[0].bodies[1]: expected the name of a body, or robot/link, got \"bb\""},
      {simulated(R"("pairs": [{"bodies": ["a", "a"], "friction": 1}])"),
       "simulation.pairs[0].bodies: expected two bodies, got one twice"},
      {simulated(R"("pairs": [{"bodies": ["a", "b"]}])"),
       "simulation.pairs[0]: expected \"friction\" or \"restitution\", got neither"},
      {simulated(R"("pairs": [{"bodies": ["a", "b"], "friction": 1}, )"
                 R"({"bodies": ["b", "a"], "friction": 1}])"),
       "simulation.pairs[1]: expected each pair once, got a second one"},
      {scene(body("a"), R"("simulation": {"duration": 2}, "options": {"duration": 1})"),
       "options.duration: expected 2 or more, the last time of the simulation, the waypoints (or "
       "no "
       "\"duration\" at all), got 1"},
  });
}

TEST(CheckWarnings, SayThatFreeBodiesRest) {
  const std::string free = R"("dynamics": {})";
  ShapeCache cache;
  const auto warnings = [&](const std::string& bodies) {
    return check_warnings(load_scene(parse_scene(scene(bodies), "s"), cache));
  };
  EXPECT_TRUE(warnings(body("a") + "," + body("b")).empty());
  EXPECT_EQ(warnings(body("a") + "," + body("b", free)).at(0),
            "\"b\" with \"dynamics\": at rest here; \"firstcontact simulate\" moves what has "
            "dynamics");
  EXPECT_EQ(warnings(body("a", free) + "," + body("b", free)).at(0),
            "\"a\" and 1 more with \"dynamics\": at rest here; \"firstcontact simulate\" moves "
            "what has dynamics");
}

}  // namespace
}  // namespace firstcontact
