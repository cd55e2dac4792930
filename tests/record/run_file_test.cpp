#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/record/read_run.h>
#include <firstcontact/record/same_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/scene_bits.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using test::SceneBits;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

RunHeader example_header() {
  RunHeader header;
  header.scene = parse_scene(R"({"firstcontact": 1, "bodies": [
    {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [-0.0, 1e-300, 2]}},
    {"name": "floor", "shape": {"box": {"size": [9, 9, 0.1]}}}]})",
                             "scene.json");
  header.version = "0.1.0";
  header.input_digest = std::string(64, 'a');
  header.masses = {1.0 / 3.0, 0.0};
  header.centres_of_mass = {{-0.0, 1e-17, 1e17}, Eigen::Vector3d::Zero()};
  return header;
}

/// Doubles of every size, -0 and denormal ones among them.
class Doubles {
 public:
  double next() {
    while (true) {
      const std::uint64_t bits = rng_();
      const double x = bits % 50 == 0 ? -0.0 : std::bit_cast<double>(bits);
      if (std::isfinite(x)) {
        return x;
      }
    }
  }
  Eigen::Vector3d vector() { return {next(), next(), next()}; }
  Pose pose() { return {vector(), Eigen::Quaterniond(next(), next(), next(), next())}; }

 private:
  std::mt19937_64 rng_{7};
};

RunStep example_step(std::size_t index, Doubles& doubles) {
  RunStep step;
  step.index = index;
  step.time = 0.1 * static_cast<double>(index);
  step.lasted = 0.1;
  step.time_lost = 1e-3;
  step.clearance = std::abs(doubles.next());
  step.kinetic_energy = doubles.next();
  step.potential_energy = doubles.next();
  step.linear_momentum = doubles.vector();
  step.angular_momentum = doubles.vector();
  step.residual = std::abs(doubles.next());
  step.events = 3;
  RunBody body{.body = 0, .pieces = {}, .X_WB = doubles.pose()};
  for (const double to : {0.03, 0.1}) {
    body.pieces.push_back({to, doubles.pose(), doubles.vector(), doubles.vector()});
  }
  body.linear_velocity = doubles.vector();
  body.angular_velocity = doubles.vector();
  body.behind = index % 2 == 0 ? std::abs(doubles.next()) : 0.0;
  step.bodies.push_back(body);
  RunContact contact;
  contact.bodies = {0, 1};
  contact.feature_A = {FeatureType::edge, 4294967295u, 7};
  contact.feature_B = {FeatureType::face, 2, 2};
  contact.point = doubles.vector();
  contact.normal = doubles.vector();
  contact.distance = doubles.next();
  contact.impulse = doubles.vector();
  step.contacts.push_back(contact);
  step.impacts.push_back({0.03, {0, 1}, doubles.vector(), doubles.vector()});
  return step;
}

std::string example_run(std::size_t steps) {
  Doubles doubles;
  std::string text = write_run_header(example_header());
  for (std::size_t k = 1; k <= steps; ++k) {
    text += write_run_step(example_step(k, doubles));
  }
  return text;
}

/// The reader's message for a run.
std::string complaint(const std::string& text) {
  std::istringstream stream(text);
  try {
    RunReader reader(stream, "run.jsonl");
    while (reader.next()) {
    }
  } catch (const ParseError& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

// The writer is a function of every number, and it is the same text that comes back: so are the
// numbers, as each is written so that it reads back to the same double.
TEST(RunFile, ReadsBackBitForBit) {
  const std::string text = example_run(50);
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  std::string again = write_run_header(reader.header());
  Doubles doubles;
  std::size_t count = 0;
  while (const auto step = reader.next()) {
    again += write_run_step(*step);
    const RunStep original = example_step(++count, doubles);
    const auto bits = [](const RunStep& s) {
      std::vector<std::uint64_t> all;
      for (const RunPiece& piece : s.bodies.at(0).pieces) {
        for (int k = 0; k < 3; ++k) {
          all.push_back(std::bit_cast<std::uint64_t>(piece.X_WB.position[k]));
          all.push_back(std::bit_cast<std::uint64_t>(piece.translation[k]));
          all.push_back(std::bit_cast<std::uint64_t>(piece.rotation_vector[k]));
        }
        for (const double x : piece.X_WB.rotation.coeffs()) {
          all.push_back(std::bit_cast<std::uint64_t>(x));
        }
      }
      return all;
    };
    EXPECT_EQ(bits(*step), bits(original));
    EXPECT_EQ(step->clearance, original.clearance);
    EXPECT_EQ(step->bodies.at(0).behind, original.bodies.at(0).behind);
    EXPECT_EQ(step->contacts.at(0).feature_A, original.contacts.at(0).feature_A);
  }
  EXPECT_EQ(count, 50u);
  EXPECT_EQ(again, text);
  EXPECT_FALSE(reader.is_cut_off());
  EXPECT_EQ(reader.size(), text.size());
}

/// A header of a scene whose shapes are files in a folder.
RunHeader header_of_files(const std::string& folder) {
  RunHeader header = example_header();
  std::vector<Body>& bodies = header.scene.bodies;
  bodies.resize(4, bodies[0]);
  bodies[0].shape.source = MeshFile{.path = folder + "/m.obj"};
  bodies[1].shape.source = ConvexHullShape{.of = MeshFile{.path = folder + "/m.obj"}};
  bodies[2].shape.source = PointFile{.path = folder + "/p.xyz"};
  bodies[3].shape.source = HeightFile{.path = folder + "/h.csv", .cell = {1.0, 1.0}};
  return header;
}

std::string line_of(const RunHeader& header) {
  std::string line = write_run_header(header);
  line.pop_back();
  return line;
}

TEST(RunFile, IsTheSameByOtherPaths) {
  const RunHeader header = header_of_files("scenes");
  EXPECT_TRUE(is_header_line_of(line_of(header), header));
  EXPECT_TRUE(is_header_line_of(line_of(header_of_files("/home/me/scenes")), header));
}

TEST(RunFile, IsAnotherByAnythingElse) {
  const RunHeader header = header_of_files("scenes");
  RunHeader other = header_of_files("/home/me/scenes");
  other.input_digest[63] = 'b';
  EXPECT_FALSE(is_header_line_of(line_of(other), header));
  other = header_of_files("/home/me/scenes");
  other.version = "0.1.1";
  EXPECT_FALSE(is_header_line_of(line_of(other), header));
  other = header_of_files("/home/me/scenes");
  other.scene.bodies[2].shape.radius = 0.1;
  EXPECT_FALSE(is_header_line_of(line_of(other), header));
  other = header_of_files("/home/me/scenes");
  std::swap(other.scene.bodies[0], other.scene.bodies[1]);
  EXPECT_FALSE(is_header_line_of(line_of(other), header));
}

TEST(RunFile, IsNoHeaderWhereALineIsNone) {
  const RunHeader header = example_header();
  const std::string line = line_of(header);
  for (const std::string& other :
       {std::string(), std::string("{}"), std::string("[1]"), std::string(R"({"scene": 1})"),
        line.substr(0, line.size() - 1), line + "x"}) {
    EXPECT_FALSE(is_header_line_of(other, header)) << other;
  }
}

// The files of the other spelling need not be there.
TEST(RunFile, IsReadWithItsKnownHeader) {
  std::istringstream stream(write_run_header(header_of_files("nowhere")));
  RunReader reader(stream, "run.jsonl", example_header());
  EXPECT_EQ(reader.header().masses, example_header().masses);
  EXPECT_EQ(reader.size(), write_run_header(header_of_files("nowhere")).size());
  std::istringstream none("{");
  EXPECT_THROW(RunReader(none, "run.jsonl", example_header()), ParseError);
}

TEST(RunFile, KeepsItsScene) {
  std::istringstream stream(example_run(0));
  const RunReader reader(stream, "run.jsonl");
  EXPECT_TRUE(SceneBits(reader.header().scene) == SceneBits(example_header().scene));
  EXPECT_EQ(reader.header().masses, example_header().masses);
  EXPECT_EQ(reader.header().centres_of_mass, example_header().centres_of_mass);
  EXPECT_TRUE(std::signbit(reader.header().centres_of_mass[0].x()));
}

TEST(RunFile, SaysOfWhatItIsTheRecord) {
  const auto read = [](const std::string& header) {
    std::istringstream stream(header);
    return RunReader(stream, "run.jsonl").header().kind;
  };
  RunHeader header = example_header();
  const std::string simulation = write_run_header(header);
  EXPECT_EQ(simulation.find(R"("kind")"), std::string::npos);
  EXPECT_EQ(read(simulation), RunKind::simulation);
  header.kind = RunKind::haptics;
  const std::string haptics = write_run_header(header);
  EXPECT_EQ(read(haptics), RunKind::haptics);
  const std::string word = R"("haptics")";
  std::string other = haptics;
  other.replace(other.find(word), word.size(), R"("dreams")");
  EXPECT_NE(complaint(other).find("expected \"haptics\""), std::string::npos) << complaint(other);
}

TEST(RunFile, HasNoClearanceWhereThereIsNoPair) {
  Doubles doubles;
  RunStep step = example_step(1, doubles);
  step.clearance = kInfinity;
  std::istringstream stream(write_run_header(example_header()) + write_run_step(step));
  RunReader reader(stream, "run.jsonl");
  EXPECT_EQ(reader.next().value().clearance, kInfinity);
}

TEST(RunFile, HasStepsThatLastNoTime) {
  Doubles doubles;
  RunStep step = example_step(1, doubles);
  step.lasted = 0.0;
  step.bodies[0].pieces = {{0.0, Pose{}}};
  const auto read = [&] {
    std::istringstream stream(write_run_header(example_header()) + write_run_step(step));
    return RunReader(stream, "run.jsonl").next();
  };
  EXPECT_EQ(read().value().bodies.at(0).pieces.size(), 1u);
  step.bodies[0].pieces.clear();
  EXPECT_TRUE(read().value().bodies.at(0).pieces.empty());
}

TEST(RunFile, HoldsFiniteNumbersOnly) {
  Doubles doubles;
  RunStep step = example_step(1, doubles);
  step.bodies[0].pieces[1].translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)write_run_step(step), std::invalid_argument);
  step = example_step(1, doubles);
  step.kinetic_energy = kInfinity;
  EXPECT_THROW((void)write_run_step(step), std::invalid_argument);
  RunHeader header = example_header();
  header.masses[0] = kInfinity;
  EXPECT_THROW((void)write_run_header(header), std::invalid_argument);
}

// A simulation may be killed at any byte; what is whole before it counts, and nothing else does.
TEST(RunFile, KnowsWhereItWasCutOff) {
  const std::string text = example_run(3);
  const std::size_t header = text.find('\n') + 1;
  for (std::size_t size = header; size <= text.size();
       size += static_cast<std::size_t>(test::rounds(1, 7))) {
    const std::string part = text.substr(0, size);
    std::istringstream stream(part);
    RunReader reader(stream, "run.jsonl");
    while (reader.next()) {
    }
    ASSERT_EQ(reader.size(), part.rfind('\n') + 1);
    ASSERT_EQ(reader.is_cut_off(), part.back() != '\n');
  }
  EXPECT_EQ(complaint(text.substr(0, header - 1)),
            "run.jsonl:1: expected the header of a run, got no whole line");
  EXPECT_EQ(complaint(""), "run.jsonl:1: expected the header of a run, got no whole line");
}

/// A haptic run of one step.
std::string felt_run(Doubles& doubles, bool has_link = false) {
  RunHeader header = example_header();
  header.kind = RunKind::haptics;
  RunStep step = example_step(1, doubles);
  step.devices.push_back(
      {.body = 0, .X_WB = doubles.pose(), .force = doubles.vector(), .torque = doubles.vector()});
  if (has_link) {
    step.devices[0].links = {{.body = 0, .X_WB = doubles.pose()}};
  }
  return write_run_header(header) + write_run_step(step);
}

TEST(RunFile, HoldsDevicesOfHapticTools) {
  Doubles doubles;
  const std::string text = felt_run(doubles);
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  const std::string header = write_run_header(reader.header());
  const RunStep step = reader.next().value();
  ASSERT_EQ(step.devices.size(), 1U);
  EXPECT_EQ(header + write_run_step(step), text);
}

TEST(RunFile, HoldsLinksWhereDevicesLeadThem) {
  Doubles doubles;
  const std::string text = felt_run(doubles, true);
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  const std::string header = write_run_header(reader.header());
  const RunStep step = reader.next().value();
  ASSERT_EQ(step.devices[0].links.size(), 1U);
  EXPECT_EQ(header + write_run_step(step), text);
  const std::string links = text.substr(text.find("\"links\":[") + 9);
  const std::string one = links.substr(0, links.find('}') + 1);
  EXPECT_EQ(complaint(with(text, one, one + "," + one)),
            "run.jsonl:2: devices[0].links[1].body: expected links in the order of their numbers, "
            "each once");
  EXPECT_EQ(complaint(with(text, one, with(one, "\"body\":0", "\"body\":1"))),
            "run.jsonl:2: devices[0].links[0].body: expected the number of a link, a body with a "
            "mass");
}

TEST(RunFile, SaysWhichDeviceIsWrong) {
  Doubles doubles;
  const std::string text = felt_run(doubles);
  const std::string device = text.substr(text.find("\"devices\":[") + 11);
  const std::string one = device.substr(0, device.find('}') + 1);
  EXPECT_EQ(
      complaint(with(text, one, one + "," + one)),
      "run.jsonl:2: devices[1].body: expected tools in the order of their numbers, each once");
  EXPECT_EQ(complaint(with(text, one, with(one, "\"body\":0", "\"body\":1"))),
            "run.jsonl:2: devices[0].body: expected the number of a tool, a body with a mass");
  EXPECT_EQ(complaint(with(text, one, with(one, "\"force\":[", "\"force\":[0,"))),
            "run.jsonl:2: devices[0].force: expected an array of 3");
  EXPECT_EQ(complaint(with(text, "\"kind\":\"haptics\",", "")),
            "run.jsonl:2: devices: expected no such key here: only runs of haptics have devices");
}

TEST(RunFile, SaysWhereItIsWrong) {
  const std::string text = example_run(2);
  EXPECT_EQ(complaint(text), "");
  const auto after = [&](const std::string& old, const std::string& replacement) {
    return complaint(with(text, old, replacement));
  };
  EXPECT_EQ(after("\"firstcontact_run\":1", "\"firstcontact_run\":2"),
            "run.jsonl:1: expected the header of a run, an object with \"firstcontact_run\": 1");
  EXPECT_EQ(after("\"sphere\"", "\"spere\"").rfind("run.jsonl:1: scene: bodies[0].shape", 0), 0u);
  EXPECT_EQ(
      after("\"radius\":0.1", "\"radius\":0.2"),
      "run.jsonl:1: resolved_digest: expected the digest of \"scene\", which was edited; make "
      "the run again");
  EXPECT_EQ(after("\"masses\":[", "\"masses\":[-1,"),
            "run.jsonl:1: masses: expected an array of 2");
  EXPECT_EQ(after("\"step\":2", "\"step\":3"), "run.jsonl:3: step: expected 2, the steps in order");
  EXPECT_EQ(after("\"lasted\":0.1", "\"lasted\":0.2"),
            "run.jsonl:2: bodies[0].pieces: expected a last piece that ends with the step");
  EXPECT_EQ(after("[[0.03,", "[[0.2,"),
            "run.jsonl:2: bodies[0].pieces[1]: expected a piece that ends after the one before it");
  EXPECT_EQ(after("[[0.03,", "[[null,"), "run.jsonl:2: bodies[0].pieces[0][0]: expected a number");
  EXPECT_EQ(after("\"body\":0", "\"body\":2"),
            "run.jsonl:2: bodies[0].body: expected an integer from 0 to 1");
  EXPECT_EQ(after("\"body\":0,", "\"body\":0,\"behind\":-1,"),
            "run.jsonl:2: bodies[0].behind: expected a number that is not negative");
  EXPECT_EQ(after("\"edge\"", "\"hedge\""),
            "run.jsonl:2: contacts[0].features[0].type: expected vertex, edge or face");
  EXPECT_EQ(after("\"at\":0.03", "\"at\":-1"),
            "run.jsonl:2: impacts[0].at: expected a number that is not negative");
  EXPECT_EQ(after("\"residual\":", "\"resi\\ndual\":"),
            "run.jsonl:2: expected the key \"residual\"");
  EXPECT_EQ(after("\"residual\":", "\"a\\nb\":1,\"residual\":"),
            "run.jsonl:2: a\\nb: expected no such key here");
  EXPECT_EQ(after("\"time\":0.1", "\"time\":1e999"),
            "run.jsonl:2: expected numbers that fit a double");
  EXPECT_EQ(after("\"time\":0.1", "\"time\":NaN").rfind("run.jsonl:2: expected one JSON object", 0),
            0u);
  EXPECT_EQ(complaint(text + "\n").rfind("run.jsonl:4: expected one JSON object", 0), 0u);
}

}  // namespace
}  // namespace firstcontact
