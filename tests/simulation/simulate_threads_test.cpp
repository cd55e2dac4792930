// A run has the same bits for any number of threads, and where it is resumed: with heaps, ties,
// circles and scripts in islands of their own, and with loops of links.

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>
#include <firstcontact/record/write_run.h>

namespace firstcontact {
namespace {

constexpr std::size_t kSteps = 40;
constexpr std::size_t kResumed = 17;  // Steps before a run is resumed.

/// All numbers of a step, with all their digits.
std::vector<std::string> texts(const std::vector<RunStep>& steps) {
  std::vector<std::string> all;
  for (const RunStep& step : steps) {
    all.push_back(write_run_step(step));
  }
  return all;
}

std::string ball_at(const std::string& name, double x, double y, double z, double v = 0.0) {
  return test::body(
      name, test::ball("0.05"), test::numbers({x, y, z}),
      R"(, "dynamics": {"linear_velocity": )" + test::numbers({v, 0.3 * v, 0.0}) + "}");
}

/// Groups of bodies that do not meet, each with what ties can be: a net of springs, a chain of
/// pins, a swinging cable, two welded balls that hit a pile, a lifted load.
std::string tied_scene() {
  std::ostringstream bodies;
  std::ostringstream ties;
  const auto tie = [&](const std::string& type, const std::string& a, const std::string& b,
                       const std::string& more = "") {
    ties << (ties.tellp() > 0 ? ", " : "") << R"({"type": ")" << type << R"(", "bodies": [)"
         << (a.empty() ? "null" : "\"" + a + "\"") << ", \"" << b << "\"]" << more << "}";
  };
  bodies << test::body("floor", test::box("[30, 30, 1]"), "[0, 0, -0.5]");
  for (int k = 0; k < 4; ++k) {
    const double x = 3.0 * k;
    const std::string n = std::to_string(k);
    for (int i = 0; i < 5; ++i) {
      const std::string name = "s" + n + std::to_string(i);
      bodies << ", " << ball_at(name, x + 0.2 * i, 0.0, 0.3 + 0.05 * k, 0.2 * (i - 2));
      if (i > 0) {
        tie("spring", "s" + n + std::to_string(i - 1), name,
            R"(, "points": [[0, 0, 0], [0, 0, 0]], "length": 0.2, "stiffness": 300, "damping": 2)");
      }
      const std::string link = "p" + n + std::to_string(i);
      bodies << ", " << ball_at(link, x + 0.15 * i, 2.0, 1.0);
      tie("pin", i == 0 ? "" : "p" + n + std::to_string(i - 1), link,
          i == 0 ? R"(, "points": [)" + test::numbers({x - 0.1, 2.0, 1.0}) + ", [-0.1, 0, 0]]"
                 : R"(, "points": [[0.075, 0, 0], [-0.075, 0, 0]])");
    }
    bodies << ", " << ball_at("c" + n, x + 0.4, 4.0, 1.0) << ", "
           << ball_at("w" + n, x, 6.0, 0.06, 1.0 + k) << ", "
           << ball_at("u" + n, x, 6.12, 0.06, 1.0 + k);
    tie("cable", "", "c" + n,
        R"(, "points": [)" + test::numbers({x, 4.0, 1.0}) + R"(, [0, 0, 0]], "length": 0.45)");
    tie("weld", "w" + n, "u" + n);
    for (int i = 0; i < 6; ++i) {
      bodies << ", "
             << test::body("b" + n + std::to_string(i), test::box("[0.1, 0.1, 0.1]"),
                           test::numbers({x + 0.4, 5.9 + 0.12 * (i % 3), 0.051 + 0.11 * (i / 3)}),
                           R"(, "dynamics": {})");
    }
  }
  return R"({"firstcontact": 1, "bodies": [)" + bodies.str() +
         R"(], "simulation": {"step": 0.01, "friction": 0.4, "ties": [)" + ties.str() + "]}}";
}

Simulator made() {
  ShapeCache cache;
  return Simulator(load_scene(parse_scene(tied_scene(), "test.json"), cache));
}

TEST(SimulateThreads, TiesGiveTheSameBits) {
  std::vector<std::string> one;
  std::vector<RunStep> steps;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    Simulator simulator = made();
    steps = test::run(simulator, kSteps);
    one = texts(steps);
  }
  bool pulls = false;
  for (const RunStep& step : steps) {
    pulls = pulls || !step.ties.empty();
  }
  EXPECT_TRUE(pulls);
  for (const std::size_t threads : {2, 3, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Simulator simulator = made();
    EXPECT_EQ(texts(test::run(simulator, kSteps)), one) << threads;
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
  Simulator resumed = made();
  resumed.resume(steps[kResumed - 1]);
  EXPECT_EQ(texts(test::run(resumed, kSteps - kResumed)),
            std::vector<std::string>(one.begin() + kResumed, one.end()));
}

TEST(SimulateThreads, AreLimited) {
  Simulator one = made();
  one.set_threads(1);
  Simulator all = made();
  EXPECT_EQ(texts(test::run(one, 5)), texts(test::run(all, 5)));
  EXPECT_THROW(one.set_threads(-1), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
