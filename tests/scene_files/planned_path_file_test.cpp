// Path files: what is written is read back bit for bit. Nothing is planned or proven here.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/scene_bits.h"
#include "scene_files/planned_path_case.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using test::message_of;
using test::PlannedPathFile;
using test::Random;

/// All numbers, by their bits.
std::vector<std::uint64_t> path_bits(const PlannedPath& path) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double number) { bits.push_back(std::bit_cast<std::uint64_t>(number)); };
  const auto add_row = [&](const std::vector<double>& row) {
    bits.push_back(row.size());
    for (const double number : row) {
      add(number);
    }
  };
  const auto add_given = [&](const std::optional<double>& number) {
    bits.push_back(number.has_value() ? 1 : 0);
    add(number.value_or(0.0));
  };
  for (const auto* rows : {&path.waypoints, &path.goals}) {
    bits.push_back(rows->size());
    for (const std::vector<double>& row : *rows) {
      add_row(row);
    }
  }
  add_row(path.times);
  for (const std::optional<double>& clearance : path.clearances) {
    add_given(clearance);
  }
  for (const double number : {path.margin, path.tolerance, path.extra_clearance,
                              path.distance_to_goal, path.cost, path.time}) {
    add(number);
  }
  add_given(path.clearance);
  bits.push_back(path.goal.value_or(~std::size_t{0}));
  bits.push_back(path.seed);
  for (const NamedContactPair& pair : path.contact_pairs) {
    bits.push_back(static_cast<std::uint64_t>(pair.policy));
    bits.push_back(static_cast<std::uint64_t>(pair.at));
    add(pair.distance);
  }
  bits.push_back(path.is_proven ? 1 : 0);
  bits.push_back(static_cast<std::uint64_t>(path.planner));
  bits.push_back(static_cast<std::uint64_t>(path.contacts));
  for (const Turning turning : path.turnings) {
    bits.push_back(static_cast<std::uint64_t>(turning));
  }
  const PlannedPathStatistics& counts = path.statistics;
  add(counts.seconds);
  add_given(counts.first_path_seconds);
  add_given(counts.first_cost);
  for (const std::size_t count : {counts.iterations, counts.nodes, counts.edges_checked,
                                  counts.states_checked, counts.undecided}) {
    bits.push_back(count);
  }
  for (const NamedBlockingPair& pair : counts.blocked) {
    bits.push_back(pair.count);
  }
  return bits;
}

std::vector<std::string> path_words(const PlannedPath& path) {
  std::vector<std::string> words = path.robots;
  words.insert(words.end(), path.joints.begin(), path.joints.end());
  words.insert(words.end(), {path.body, path.version, path.input_digest, path.scene.text_digest});
  for (const NamedContactPair& pair : path.contact_pairs) {
    words.insert(words.end(), pair.pair.begin(), pair.pair.end());
  }
  for (const NamedBlockingPair& pair : path.statistics.blocked) {
    words.insert(words.end(), pair.pair.begin(), pair.pair.end());
  }
  return words;
}

void expect_path_kept(const PlannedPath& path) {
  const std::string text = write_planned_path(path);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const PlannedPath read = parse_planned_path(text, "elsewhere/path.json");
  EXPECT_EQ(path_bits(read), path_bits(path)) << text;
  EXPECT_EQ(path_words(read), path_words(path)) << text;
  EXPECT_EQ(test::SceneBits(read.scene), test::SceneBits(path.scene)) << text;
  EXPECT_EQ(write_planned_path(read), text);
}

/// Numbers and words of all kinds in a path that keeps its counts.
PlannedPath randomized(PlannedPath path, Random& random) {
  const auto size = [&] {
    constexpr std::array kSpecial{0.0, 5e-324, 0.1, 1.7976931348623157e308};
    const auto which = static_cast<std::size_t>(random.uniform(0.0, 8.0));
    return which < kSpecial.size() ? kSpecial.at(which) : random.logarithmic(1e-150, 1e150);
  };
  const auto given = [&] { return random.chance(0.5) ? std::optional(size()) : std::nullopt; };
  const auto count = [&] { return static_cast<std::size_t>(random.uniform(0.0, 0x1p53)); };
  for (std::vector<double>& waypoint : path.waypoints) {
    for (double& number : waypoint) {
      const double number_size = size();
      number = random.chance(0.5) ? number_size : -number_size;
    }
  }
  path.is_proven = random.chance(0.5);
  path.goals.back() = path.waypoints.back();
  path.goal = path.is_proven ? std::optional<std::size_t>(1) : std::nullopt;
  path.clearances = {given(), given()};
  path.clearance = given();
  path.margin = size();
  path.extra_clearance = size();
  path.tolerance = random.logarithmic(1e-300, 1.0);
  path.distance_to_goal = size();
  path.cost = size();
  path.planner = random.chance(0.5) ? Planner::rrt_connect : Planner::lazy_prm_star;
  path.contacts = static_cast<ContactUse>(count() % kContactUseWords.size());
  path.seed = count();
  path.time = random.logarithmic(1e-9, 1e9);
  path.statistics = {.seconds = size(),
                     .first_path_seconds = given(),
                     .iterations = count(),
                     .nodes = count(),
                     .edges_checked = count(),
                     .states_checked = count(),
                     .undecided = count(),
                     .first_cost = given(),
                     .blocked = {{{"wall", "a \"b\"\\\n\xc3\xa4"}, count()}, {{"p", "q"}, 0}}};
  for (std::size_t k = 0; k < 3; ++k) {
    path.contact_pairs.push_back({.pair = {"peg \xe2\x82\xac", "wall\t" + std::to_string(k)},
                                  .policy = static_cast<ContactPolicy>(k),
                                  .at = random.chance(0.5) ? PathEnd::start : PathEnd::goal,
                                  .distance = random.logarithmic(1e-300, 1.0)});
  }
  path.scene.id = "\"quoted\" \xf0\x9f\x98\x80";
  return path;
}

TEST_F(PlannedPathFile, IsReadBackBitForBit) {
  Random random(41);
  const std::vector<PlannedPath> movers = {of_body(), of_robots({"right"}),
                                           of_robots({"right", "left"}), in_time()};
  for (const PlannedPath& path : movers) {
    expect_path_kept(path);
    for (int round = 0; round < 50; ++round) {
      SCOPED_TRACE(round);
      expect_path_kept(randomized(path, random));
    }
  }
}

// Else a comparison that saw nothing would pass.
TEST_F(PlannedPathFile, IsComparedByEveryBit) {
  PlannedPath path = of_body();
  const auto before = path_bits(path);
  path.waypoints[1][6] = std::nextafter(path.waypoints[1][6], 1.0);
  EXPECT_NE(path_bits(path), before);
}

TEST_F(PlannedPathFile, IsReadFromAFileOrNamesIt) {
  folder_.write("path.json", write_planned_path(of_body()));
  EXPECT_EQ(path_bits(read_planned_path(folder_.path() / "path.json")), path_bits(of_body()));
  const std::filesystem::path none = folder_.path() / "none.json";
  EXPECT_EQ(message_of<ParseError>([&] { (void)read_planned_path(none); }),
            none.string() + ": expected a path file, found none");
}

TEST_F(PlannedPathFile, HoldsFiniteNumbersOnly) {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto written = [](const auto& change) {
    PlannedPath path = of_body();
    change(path);
    return message_of<std::invalid_argument>([&] { (void)write_planned_path(path); });
  };
  const std::string said = "a path file holds finite numbers only, got ";
  EXPECT_EQ(written([](PlannedPath& path) { path.cost = kInfinity; }), said + "inf");
  EXPECT_EQ(written([](PlannedPath& path) { path.clearances[0] = kInfinity; }), said + "inf");
  EXPECT_EQ(written([](PlannedPath& path) { path.goals[0][3] = -kInfinity; }), said + "-inf");
  EXPECT_EQ(written([](PlannedPath& path) { path.statistics.first_cost = std::nan(""); }),
            said + "nan");
  EXPECT_EQ(written([](PlannedPath&) {}), "accepted");
}

}  // namespace
}  // namespace firstcontact
