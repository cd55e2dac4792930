#include <cmath>
#include <random>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/query/close_features.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// A surface z = height sin(x) cos(y) over n by n squares, wide enough for a real hierarchy.
Shape waves(int n, double height) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = 4.0 * i / n - 2.0;
      const double y = 4.0 * j / n - 2.0;
      mesh.vertices.emplace_back(x, y, height * std::sin(3.0 * x) * std::cos(2.0 * y));
    }
  }
  const auto index = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return Shape(std::move(mesh));
}

Pose at(double z) { return {.position = {0.0, 0.0, z}}; }

// A law: two surfaces fall together; halving the speed doubles the time.
TEST(FirstContact, TimeIsInverselyProportionalToTheSpeed) {
  const Shape A = waves(24, 0.1);
  const Shape B = waves(20, 0.2);
  const Motion rest = Motion::fixed();
  Workspace workspace;
  const auto time_at_speed = [&](double speed) {
    const Motion fall = Motion::constant_velocity(at(2.0), {0.0, 0.0, -speed});
    return first_contact({A, rest}, {B, fall}, workspace).t;
  };
  const double fast = time_at_speed(8.0);
  EXPECT_GT(fast, 0.2);
  EXPECT_NEAR(time_at_speed(4.0), 2.0 * fast, 1e-6);
}

// The features that are close at the time of the first contact are those that it lists.
TEST(CloseFeatures, AreThoseOfTheFirstContact) {
  const Shape A = waves(24, 0.1);
  const Shape B = waves(20, 0.2);
  const Motion rest = Motion::fixed();
  const Motion fall = Motion::constant_velocity(at(2.0), {0.0, 0.0, -4.0}, {0.1, 0.2, 0.3});
  Workspace workspace;
  FirstContactOptions options;
  options.contact_band = 0.01;
  const FirstContactResult first = first_contact({A, rest}, {B, fall}, workspace, options);
  ASSERT_EQ(first.verdict, Verdict::contact);
  std::vector<Contact> close(3);
  const double band = options.tolerance + options.contact_band;
  close_features({A, rest}, {B, fall}, first.t, band, workspace, close);
  ASSERT_EQ(close.size(), first.contacts.size());
  ASSERT_GT(close.size(), 1u);
  for (std::size_t k = 0; k < close.size(); ++k) {
    EXPECT_EQ(close[k].feature_A, first.contacts[k].feature_A);
    EXPECT_EQ(close[k].feature_B, first.contacts[k].feature_B);
    EXPECT_LE(close[k].distance, band * (1.0 + 1e-9));
  }
  std::vector<Contact> swapped;
  close_features({B, fall}, {A, rest}, first.t, band, workspace, swapped);
  EXPECT_EQ(swapped.size(), close.size());
  EXPECT_THROW(close_features({A, rest}, {B, fall}, 1.5, band, workspace, close),
               std::invalid_argument);
  EXPECT_THROW(close_features({A, rest}, {B, fall}, 0.5, std::nan(""), workspace, close),
               std::invalid_argument);
}

// Splitting the step at a waypoint changes nothing but the tolerance's share.
TEST(FirstContact, IsTheSameForASplitStep) {
  const Shape A = waves(24, 0.1);
  const Shape B = waves(20, 0.2);
  const Motion rest = Motion::fixed();
  const std::vector<double> times{0.0, 0.25, 1.0};
  const std::vector<Pose> poses{at(2.0), at(1.0), at(-2.0)};
  Workspace workspace;
  const auto whole = first_contact(
      {A, rest}, {B, Motion::constant_velocity(at(2.0), {0.0, 0.0, -4.0})}, workspace);
  const auto split = first_contact({A, rest}, {B, Motion::waypoints(times, poses)}, workspace);
  ASSERT_EQ(split.verdict, Verdict::contact);
  EXPECT_NEAR(split.t, whole.t, 1e-6);
}

TEST(FirstContact, EndsUndecidedWithAProvenFreeTimeWhenWorkIsSpent) {
  const Shape A = waves(24, 0.1);
  const Motion rest = Motion::fixed();
  const Motion fall = Motion::constant_velocity(at(2.0), {0.0, 0.0, -4.0}, {0.3, 0.2, 0.1});
  Workspace workspace;
  const FirstContactResult full = first_contact({A, rest}, {A, fall}, workspace);
  ASSERT_EQ(full.verdict, Verdict::contact);
  for (const std::uint64_t steps : {0u, 1u, 4u, 16u}) {
    FirstContactOptions options;
    options.budget.steps = steps;
    const FirstContactResult cut = first_contact({A, rest}, {A, fall}, workspace, options);
    EXPECT_EQ(cut.verdict, Verdict::undecided);
    EXPECT_EQ(cut.reason, UndecidedReason::work);
    EXPECT_LE(cut.t, full.t);
  }
  std::stop_source source;
  source.request_stop();
  FirstContactOptions options;
  options.budget.stop = source.get_token();
  EXPECT_EQ(first_contact({A, rest}, {A, fall}, workspace, options).reason,
            UndecidedReason::cancelled);
  options.budget.stop = {};
  options.budget.deadline = std::chrono::steady_clock::now();
  EXPECT_EQ(first_contact({A, rest}, {A, fall}, workspace, options).reason,
            UndecidedReason::deadline);
}

// Starting at half the tolerance: sliding goes on, pressing ends before the surfaces meet.
TEST(FirstContact, HoldsAPairThatStartsInTheBandToHalfItsDistance) {
  const Shape A = waves(8, 0.0);
  const Shape B = waves(6, 0.0);
  const Motion rest = Motion::fixed();
  const double start = 5e-7;
  Workspace workspace;
  FirstContactOptions options;
  const Motion slide = Motion::constant_velocity(at(start), {0.5, 0.0, 0.0});
  options.start_contacts = StartContacts::keep_half;
  EXPECT_EQ(first_contact({A, rest}, {B, slide}, workspace, options).verdict, Verdict::free);
  const Motion press = Motion::constant_velocity(at(start), {0.0, 0.0, -1e-6});
  const FirstContactResult pressed = first_contact({A, rest}, {B, press}, workspace, options);
  ASSERT_EQ(pressed.verdict, Verdict::contact);
  const double left = start - 1e-6 * pressed.t;
  EXPECT_GE(left, 0.5 * start);
  EXPECT_LE(left, 0.75 * start);
}

bool same(const Feature& x, const Feature& y) { return x.type == y.type && x.index == y.index; }

// The search lists the contacts among the pairs of triangles that it opened; a wider band, though
// by nothing that counts, has them found by distance, where other triangles stand for features.
void expect_same_contacts_by_distance(const Shape& A, const Shape& B, const Motion& motion_A,
                                      const Motion& motion_B, double tolerance) {
  Workspace workspace;
  FirstContactOptions options;
  options.tolerance = tolerance;
  const FirstContactResult by_search =
      first_contact({A, motion_A}, {B, motion_B}, workspace, options);
  options.contact_band = 1e-300;
  const FirstContactResult by_distance =
      first_contact({A, motion_A}, {B, motion_B}, workspace, options);
  ASSERT_EQ(by_search.verdict, by_distance.verdict);
  ASSERT_EQ(by_search.t, by_distance.t);
  ASSERT_EQ(by_search.contacts.size(), by_distance.contacts.size());
  for (std::size_t k = 0; k < by_search.contacts.size(); ++k) {
    const Contact& x = by_search.contacts[k];
    const Contact& y = by_distance.contacts[k];
    EXPECT_TRUE(same(x.feature_A, y.feature_A) && same(x.feature_B, y.feature_B)) << k;
    EXPECT_NEAR(x.distance, y.distance, 1e-15) << k;
  }
}

TEST(FirstContact, ListsTheContactsThatAreWithinTheBandAtItsTime) {
  const Shape A = waves(24, 0.1);
  const Shape B = waves(17, 0.2);
  const Motion rest = Motion::fixed(at(0.0));
  constexpr double kTolerance = 5e-3;  // So wide that it holds pairs which touch much later.
  for (int k = 0; k < 64; ++k) {
    const double x = 0.31 * std::sin(1.7 * k);
    const Pose from{.position = {x, 0.2 * std::cos(k), 0.8}};
    expect_same_contacts_by_distance(
        A, B, rest,
        Motion::constant_velocity(from, {0.1, -x, -1.0}, {0.3 * std::sin(k), 0.2, 0.5 * x}),
        kTolerance);
  }
}

TEST(FirstContact, ListsTheContactsOfAFlatLanding) {
  const Shape plate = waves(24, 0.0);
  const Motion rest = Motion::fixed(at(0.0));
  expect_same_contacts_by_distance(
      plate, plate, rest, Motion::constant_velocity(at(0.5), {0.03, 0.02, -1.0}, Vector3d::Zero()),
      1e-6);
}

TEST(FirstContact, RefusesOptionsOutOfRange) {
  const Shape A = waves(2, 0.0);
  const Motion rest = Motion::fixed();
  Workspace workspace;
  FirstContactOptions options;
  options.tolerance = std::nan("");
  EXPECT_THROW((void)first_contact({A, rest}, {A, rest}, workspace, options),
               std::invalid_argument);
  options.tolerance = 1e-6;
  options.margin = -1.0;
  EXPECT_THROW((void)first_contact({A, rest}, {A, rest}, workspace, options),
               std::invalid_argument);
}

TEST(Distance, IsTheHeightOfAParallelPlate) {
  const Shape A = waves(12, 0.0);
  const Shape B = waves(9, 0.0);
  const Motion fall = Motion::constant_velocity(at(2.0), {0.0, 0.0, -1.0});
  Workspace workspace;
  for (const double t : {0.0, 0.3, 1.0}) {
    const DistanceResult result = distance({A, Motion::fixed()}, {B, fall}, t, workspace);
    EXPECT_NEAR(result.distance, 2.0 - t, 1e-14);
    EXPECT_LE(result.lower_bound, 2.0 - t);
    EXPECT_GE(result.lower_bound, 2.0 - t - 1e-12);
  }
}

// A corner turns over a plate: the least height is known in closed form.
TEST(ClosestApproach, FindsTheLowestPointOfATurn) {
  const Shape plate = waves(6, 0.0);
  const Shape needle(
      Mesh{.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, .triangles = {{0, 1, 1}}});
  const Motion swing = Motion::constant_velocity(at(1.25), Vector3d::Zero(), {0.0, 3.0, 0.0});
  Workspace workspace;
  const ClosestApproachResult result =
      closest_approach({plate, Motion::fixed()}, {needle, swing}, workspace);
  EXPECT_EQ(result.reason, UndecidedReason::none);
  EXPECT_NEAR(result.distance, 0.25, 1e-6);
  EXPECT_LE(result.lower_bound, 0.25);
  EXPECT_GE(result.lower_bound, 0.25 - 2e-6);
}

TEST(ClosestApproach, OfATouchIsTheFirstContact) {
  const Shape A = waves(6, 0.1);
  const Shape B = waves(5, 0.2);
  const Motion fall = Motion::constant_velocity(at(2.0), {0.1, 0.0, -4.0}, {0.3, 0.2, 0.1});
  Workspace workspace;
  const MovingShape resting{A, Motion::fixed()};
  const double t = first_contact(resting, {B, fall}, workspace).t;
  const ClosestApproachResult result = closest_approach(resting, {B, fall}, workspace);
  EXPECT_EQ(result.t, t);
  EXPECT_LE(result.distance, result.tolerance_used);
  EXPECT_EQ(result.lower_bound, 0.0);
}

// The least claim, at once, however long the proof would take.
TEST(ClosestApproach, EndsWithItsBudget) {
  const Shape A = waves(40, 0.1);
  const Shape B = waves(30, 0.2);
  const Motion pass = Motion::constant_velocity(at(0.5), {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  std::stop_source stop;
  stop.request_stop();
  Workspace workspace;
  ClosestApproachOptions options;
  options.budget.stop = stop.get_token();
  const ClosestApproachResult result =
      closest_approach({A, Motion::fixed()}, {B, pass}, workspace, options);
  EXPECT_EQ(result.reason, UndecidedReason::cancelled);
  EXPECT_EQ(result.lower_bound, 0.0);
}

// The least distance of the answer is attained, and no sample is closer.
TEST(ClosestApproach, IsAttainedAndBoundsEverySample) {
  const Shape A = waves(6, 0.1);
  const Shape B = waves(5, 0.2);
  const Motion rest = Motion::fixed();
  std::mt19937_64 rng(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Workspace workspace;
  for (int i = 0; i < 30; ++i) {
    const Motion pass = Motion::constant_velocity(at(1.5 + uniform(rng)),
                                                  {uniform(rng), uniform(rng), 0.3 * uniform(rng)},
                                                  {3.0 * uniform(rng), uniform(rng), uniform(rng)});
    const ClosestApproachResult result = closest_approach({A, rest}, {B, pass}, workspace);
    ASSERT_EQ(result.reason, UndecidedReason::none);
    EXPECT_LE(result.distance, result.lower_bound + result.tolerance_used);
    EXPECT_EQ(distance({A, rest}, {B, pass}, result.t, workspace).distance, result.distance);
    for (int k = 0; k <= 200; k += test::rounds(1, 10)) {
      EXPECT_GE(distance({A, rest}, {B, pass}, k / 200.0, workspace).distance, result.lower_bound)
          << "motion " << i << " at " << k / 200.0;
    }
  }
}

// Shapes and motions are only read: many threads share them and get the same bits.
TEST(QueryThreads, ShareShapesAndAgree) {
  const Shape A = waves(40, 0.1);
  const Shape B = waves(30, 0.2);
  const Motion rest = Motion::fixed();
  const Motion fall = Motion::constant_velocity(at(2.0), {0.1, 0.0, -4.0}, {0.3, 0.2, 0.1});
  Workspace workspace;
  const FirstContactResult expected = first_contact({A, rest}, {B, fall}, workspace);
  std::vector<double> times(4);
  {
    std::vector<std::jthread> threads;
    for (double& t : times) {
      threads.emplace_back([&] {
        Workspace own;
        t = first_contact({A, rest}, {B, fall}, own).t;
      });
    }
  }
  for (const double t : times) {
    EXPECT_EQ(t, expected.t);
  }
}

// The search ends with the first pair that it finds there, and most others were not looked at.
TEST(FirstContact, AtTheStartListsAllThatOverlaps) {
  const Shape A(waves(8, 0.1).mesh(), 0.3);
  const Shape B(waves(8, 0.2).mesh(), 0.1);
  const Motion rest = Motion::fixed(at(0.2));
  Workspace workspace;
  FirstContactOptions options;
  const FirstContactResult exact =
      first_contact({A, Motion::fixed()}, {B, rest}, workspace, options);
  options.contact_band = 1e-12;
  const FirstContactResult wider =
      first_contact({A, Motion::fixed()}, {B, rest}, workspace, options);
  ASSERT_EQ(exact.verdict, Verdict::contact_at_start);
  EXPECT_EQ(exact.clearance, 0.0);
  EXPECT_GT(exact.contacts.size(), 10u);
  EXPECT_EQ(exact.contacts.size(), wider.contacts.size());
}

// Searches for what is closer by a tolerance at a time would take half a minute.
TEST(ClosestApproach, FindsAShortDipBetweenPlateaus) {
  const Shape A(waves(2, 0.0).mesh(), 0.0);
  const Shape B(waves(2, 0.0).mesh(), 0.1);
  const std::vector<double> times{0.0, 0.432, 0.43201, 0.43202, 1.0};
  const std::vector<Pose> poses{at(2.0), at(2.0), at(1.0), at(2.0), at(2.0)};
  const Motion dip = Motion::waypoints(times, poses, Between::constant_velocity);
  Workspace workspace;
  ClosestApproachOptions options;
  options.budget.steps = 20'000;
  const ClosestApproachResult result =
      closest_approach({A, Motion::fixed()}, {B, dip}, workspace, options);
  EXPECT_EQ(result.reason, UndecidedReason::none);
  EXPECT_NEAR(result.distance, 0.9, 1e-6);
  EXPECT_LE(result.distance - result.lower_bound, 1.1e-6);
  EXPECT_NEAR(result.t, 0.43201, 1e-9);
}

}  // namespace
}  // namespace firstcontact
