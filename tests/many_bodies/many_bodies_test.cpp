#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/many_bodies/detail/box_join.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/query/detail/ball_path.h>
#include <firstcontact/query/distance.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  Vector3d vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Pose pose(double size) {
    return {.position = vector(size),
            .rotation = Eigen::Quaterniond(uniform(0.1, 1.0), uniform(-1.0, 1.0),
                                           uniform(-1.0, 1.0), uniform(-1.0, 1.0))
                            .normalized()};
  }

 private:
  std::mt19937_64 engine_;
};

/// Every kind of motion, from rest to several turns and fast flights.
Motion random_motion(Random& random, double size) {
  const Pose from = random.pose(size);
  const double kind = random.uniform(0.0, 4.0);
  if (kind < 0.5) {
    return Motion::fixed(from);
  }
  if (kind < 2.0) {
    return Motion::constant_velocity(from, random.vector(random.uniform(0.0, 2.0 * size)),
                                     random.vector(random.uniform(0.0, 10.0)));
  }
  if (kind < 3.0) {
    return Motion::screw(from, random.vector(size), random.vector(1.0), random.uniform(0.0, 7.0),
                         random.uniform(-1.0, 1.0));
  }
  const std::vector<double> times{0.1, 0.4, 0.75};
  const std::vector<Pose> poses{from, random.pose(size), random.pose(size)};
  return Motion::waypoints(times, poses, kind < 3.5 ? Between::constant_velocity : Between::screw);
}

/// A thin, skew tetrahedron with its origin off its centre.
Shape random_shape(Random& random) {
  Mesh mesh;
  mesh.vertices = {random.vector(0.3), random.vector(0.3), random.vector(0.3), random.vector(0.3)};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  return Shape(std::move(mesh), random.uniform(0.0, 1.0) < 0.3 ? 0.05 : 0.0);
}

BodySet random_set(Random& random, std::size_t n, double size) {
  BodySet bodies(PairRules(random.uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.01));
  for (std::size_t k = 0; k < n; ++k) {
    bodies.add(random_shape(random), random_motion(random, size));
  }
  return bodies;
}

FirstContactResult ask_pair(const BodySet& bodies, const BodyPair& pair, double margin) {
  Workspace workspace;
  FirstContactOptions options;
  options.margin = margin;
  return first_contact(bodies.moving_shape(pair[0]), bodies.moving_shape(pair[1]), workspace,
                       options);
}

void expect_equal(const FirstContactResult& x, const FirstContactResult& y) {
  EXPECT_EQ(x.verdict, y.verdict);
  EXPECT_EQ(x.t, y.t);
  ASSERT_EQ(x.contacts.size(), y.contacts.size());
  for (std::size_t k = 0; k < x.contacts.size(); ++k) {
    EXPECT_TRUE(x.contacts[k].feature_A == y.contacts[k].feature_A);
    EXPECT_EQ(x.contacts[k].p_WB, y.contacts[k].p_WB);
  }
}

TEST(BallPath, StaysInItsSweptBoxWhichIsNotMuchLarger) {
  Random random(1);
  for (int k = 0; k < 400; ++k) {
    BodySet bodies;
    bodies.add(random_shape(random), random_motion(random, 3.0));
    const Hierarchy& hierarchy = bodies.shape(0).hierarchy();
    const detail::BallPath ball{bodies.centre_path(0), hierarchy.radius};
    const double begin = random.uniform(0.0, 0.9);
    const double end = begin + random.uniform(0.0, 0.1);
    const Eigen::AlignedBox3d box = detail::swept_box(ball, {begin, end});
    Eigen::AlignedBox3d seen;
    for (int i = 0; i <= 64; ++i) {
      const double t = i == 64 ? end : begin + (end - begin) * i / 64.0;
      const Pose pose = bodies.motion(0).pose(t);
      const Vector3d centre = pose.position + pose.rotation * hierarchy.centre;
      seen.extend(Vector3d(centre.array() - hierarchy.radius));
      seen.extend(Vector3d(centre.array() + hierarchy.radius));
    }
    EXPECT_TRUE(box.contains(seen)) << k;
    const double path =
        (bodies.motion(0).pose(end).position - bodies.motion(0).pose(begin).position).norm();
    EXPECT_LE((box.sizes() - seen.sizes()).maxCoeff(), 1.0 * path + 0.5) << k;
  }
}

TEST(BallPath, PairsAreApartUntilTheTimeThatIsProven) {
  Random random(2);
  int limited = 0;
  for (int k = 0; k < 2000; ++k) {
    BodySet bodies = random_set(random, 2, 1.5);
    const detail::BallPath A{bodies.centre_path(0), bodies.shape(0).hierarchy().radius};
    const detail::BallPath B{bodies.centre_path(1), bodies.shape(1).hierarchy().radius};
    const double margin = random.uniform(0.0, 0.1);
    const double begin = random.uniform(0.0, 1.0);
    const double end = random.uniform(begin, 1.0);
    const double until = detail::apart_until(A, B, margin, {begin, end});
    ASSERT_GE(until, begin);
    limited += until > begin && until < end;
    const auto gap = [&](double t) {
      const Pose a = bodies.motion(0).pose(t);
      const Pose b = bodies.motion(1).pose(t);
      return (a.position + a.rotation * bodies.shape(0).hierarchy().centre - b.position -
              b.rotation * bodies.shape(1).hierarchy().centre)
                 .norm() -
             A.radius - B.radius - margin;
    };
    for (int i = 0; i < 100; ++i) {
      const double t = begin + (std::min(until, end) - begin) * i / 100.0;
      EXPECT_TRUE(until == begin || gap(t) > -1e-12) << k << " at " << t;
    }
    if (until == begin) {
      EXPECT_LT(gap(begin), 1e-9);  // Nothing else keeps it from a step.
    }
  }
  EXPECT_GT(limited, 50);
}

TEST(BoxJoin, FindsWhatComparingAllPairsFinds) {
  Random random(3);
  for (const std::size_t n : {0u, 1u, 2u, 9u, 100u, 700u}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t k = 0; k < n; ++k) {
      const Vector3d at = random.vector(1.0);
      boxes.emplace_back(
          at, at + Vector3d::Constant(0.1) + random.uniform(0.0, 0.05) * Vector3d(1.0, 2.0, 3.0));
    }
    std::vector<BodyPair> expected;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        if (boxes[i].intersects(boxes[j])) {
          expected.push_back({i, j});
        }
      }
    }
    detail::BoxJoin join;
    std::vector<BodyPair> pairs;
    ASSERT_TRUE(join.join(boxes, expected.size(), pairs));
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, expected);
    if (!expected.empty()) {
      pairs.clear();
      EXPECT_FALSE(join.join(boxes, expected.size() - 1, pairs));
    }
  }
}

TEST(PairRules, TheMostSpecificRuleHoldsAndIgnoringWins) {
  PairRules rules(0.1);
  const std::size_t fixtures = rules.add_group({0, 1, 2});
  const std::size_t parts = rules.add_group({2, 3});
  rules.ignore_groups(fixtures, fixtures);
  rules.set_group_margin(fixtures, parts, 0.3);
  rules.set_margin({1, 3}, 0.2);
  EXPECT_FALSE(rules.margin({0, 1}));
  EXPECT_FALSE(rules.margin({0, 2}));  // Inside the fixtures, though also a part.
  EXPECT_EQ(rules.margin({0, 3}), 0.3);
  EXPECT_EQ(rules.margin({1, 3}), 0.2);
  EXPECT_EQ(rules.margin({3, 4}), 0.1);
  rules.ignore({1, 3});
  rules.set_margin({1, 3}, 0.5);
  EXPECT_FALSE(rules.margin({1, 3}));
  EXPECT_EQ(rules.least_margin(), 0.1);
  const std::vector<double> greatest = rules.greatest_margins(5);
  EXPECT_EQ(greatest[0], 0.3);
  EXPECT_EQ(greatest[4], 0.1);
}

TEST(PairRules, RefusesWhatMakesNoSense) {
  EXPECT_THROW(PairRules(-1.0), std::invalid_argument);
  EXPECT_THROW(PairRules(std::nan("")), std::invalid_argument);
  PairRules rules;
  EXPECT_THROW(rules.ignore({2, 2}), std::invalid_argument);
  EXPECT_THROW(rules.set_margin({0, 1}, INFINITY), std::invalid_argument);
  EXPECT_THROW(rules.ignore_groups(0, 0), std::invalid_argument);
}

// The whole against its parts: every pair asked alone, over the whole step.
TEST(ManyBodies, AnswersAsTheEarliestOfAllPairs) {
  Random random(4);
  int contacts = 0;
  int late = 0;
  for (int k = 0; k < 150; ++k) {
    const double size = random.uniform(1.5, 8.0);
    const BodySet bodies = random_set(random, 24, size);
    ManyBodiesWorkspace workspace;
    const SceneResult found = first_contact(bodies, workspace);
    double earliest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        const FirstContactResult pair = ask_pair(bodies, {i, j}, *bodies.rules().margin({i, j}));
        ASSERT_NE(pair.verdict, Verdict::undecided);
        earliest = pair.verdict == Verdict::free ? earliest : std::min(earliest, pair.t);
      }
    }
    ASSERT_EQ(found.verdict != Verdict::free, std::isfinite(earliest)) << k;
    if (found.verdict == Verdict::free) {
      EXPECT_EQ(found.t, 1.0);
      EXPECT_TRUE(found.pairs.empty());
      continue;
    }
    // Two proven times of one contact lie within the tolerance of motion of each other.
    EXPECT_NEAR(found.t, earliest, 1e-5) << k;
    EXPECT_EQ(found.verdict == Verdict::contact_at_start, earliest == 0.0);
    ++contacts;
    late += found.t > 0.0;
    const PairAnswer& first = found.pairs.front();
    Workspace own;
    EXPECT_LE(distance(bodies.moving_shape(first.members[0]), bodies.moving_shape(first.members[1]),
                       found.t, own)
                  .distance,
              first.margin + 1e-6);
  }
  EXPECT_GT(contacts, 50);
  EXPECT_GT(late, 30);
}

TEST(ManyBodies, EachPairAnswersAsIfAlone) {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const BodySet bodies = random_set(random, 16, random.uniform(1.5, 8.0));
    ManyBodiesWorkspace workspace;
    const std::vector<PairAnswer> answers = answer_each_pair(bodies, workspace);
    ASSERT_EQ(answers.size(), 16u * 15u / 2u);
    for (const PairAnswer& answer : answers) {
      const FirstContactResult alone = ask_pair(bodies, answer.members, answer.margin);
      expect_equal(answer, alone);
      EXPECT_EQ(answer.clearance, alone.clearance);
    }
  }
}

TEST(ManyBodies, NumberOfThreadsChangesNothing) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  Random random(6);
  for (int k = 0; k < test::rounds(10, 2); ++k) {
    const BodySet bodies = random_set(random, 200, 12.0);
    ManyBodiesWorkspace workspace;
    ManyBodiesOptions options;
    options.threads = 1;
    const SceneResult one = first_contact(bodies, workspace, options);
    const std::vector<PairAnswer> one_each = answer_each_pair(bodies, workspace, options);
    for (const int threads : {2, 8}) {
      options.threads = threads;
      const SceneResult many = first_contact(bodies, workspace, options);
      EXPECT_EQ(many.verdict, one.verdict);
      EXPECT_EQ(many.t, one.t);
      EXPECT_EQ(many.work.steps, one.work.steps);
      ASSERT_EQ(many.pairs.size(), one.pairs.size());
      for (std::size_t i = 0; i < one.pairs.size(); ++i) {
        EXPECT_EQ(many.pairs[i].members, one.pairs[i].members);
        expect_equal(many.pairs[i], one.pairs[i]);
      }
      const std::vector<PairAnswer> each = answer_each_pair(bodies, workspace, options);
      for (std::size_t i = 0; i < each.size(); ++i) {
        expect_equal(each[i], one_each[i]);
      }
    }
  }
}

TEST(ManyBodies, ReplacedBodiesAnswerAsNewOnes) {
  Random random(7);
  BodySet bodies = random_set(random, 12, 2.0);
  BodySet fresh(bodies.rules());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (k % 2 == 0) {
      bodies.set_shape(k, random_shape(random));
    }
    if (k % 3 == 0) {
      bodies.set_motion(k, random_motion(random, 2.0));
    }
    fresh.add(bodies.shape(k), bodies.motion(k));
  }
  ManyBodiesWorkspace workspace;
  const SceneResult replaced = first_contact(bodies, workspace);
  const SceneResult built = first_contact(fresh, workspace);
  EXPECT_EQ(replaced.verdict, built.verdict);
  EXPECT_EQ(replaced.t, built.t);
  EXPECT_THROW(bodies.set_motion(99, Motion::fixed()), std::out_of_range);
}

// Bodies that fly far past many others: the step is halved until they sweep over few.
TEST(ManyBodies, FindsTheOneContactOfFastBodies) {
  Random random(8);
  BodySet bodies;
  Mesh mesh;
  mesh.vertices = {{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.1}};
  mesh.triangles = {{0, 1, 2}};
  const Shape shape(mesh);
  for (int k = 0; k < 400; ++k) {  // Lanes side by side, each 40 m long in a random direction.
    const Vector3d at(0.5 * (k % 20), 0.5 * (k / 20), random.uniform(-20.0, 20.0));
    bodies.add(shape, Motion::constant_velocity({.position = at},
                                                {0.0, 0.0, random.uniform(-40.0, 40.0)}));
  }
  ManyBodiesWorkspace workspace;
  EXPECT_EQ(first_contact(bodies, workspace).verdict, Verdict::free);
  // A diagonal flight through all lanes meets the body that rests at its end.
  bodies.add(shape,
             Motion::constant_velocity({.position = {-1.0, -1.0, -30.0}}, {20.0, 20.0, 1.0}));
  bodies.add(shape, Motion::fixed({.position = {18.0, 18.0, -29.05}}));
  const SceneResult found = first_contact(bodies, workspace);
  ASSERT_EQ(found.verdict, Verdict::contact);
  EXPECT_EQ(found.pairs.front().members, (BodyPair{400, 401}));
  EXPECT_NEAR(found.t, 0.95, 0.02);
}

TEST(ManyBodies, ContactAtTheVeryEndIsFound) {
  Mesh mesh;
  mesh.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  BodySet bodies;
  bodies.add(Shape(mesh), Motion::fixed());
  bodies.add(Shape(mesh),
             Motion::constant_velocity({.position = {0.0, 0.0, 1.0}}, {0.0, 0.0, -1.0}));
  ManyBodiesWorkspace workspace;
  const SceneResult found = first_contact(bodies, workspace);
  EXPECT_EQ(found.verdict, Verdict::contact);
  EXPECT_NEAR(found.t, 1.0, 1e-6);
}

TEST(ManyBodies, NothingToTestIsFree) {
  BodySet bodies;
  ManyBodiesWorkspace workspace;
  EXPECT_EQ(first_contact(bodies, workspace).verdict, Verdict::free);
  EXPECT_EQ(first_contact(bodies, workspace).clearance, std::numeric_limits<double>::infinity());
  Random random(9);
  bodies.add(random_shape(random), Motion::fixed());
  bodies.add(random_shape(random), Motion::fixed());
  bodies.rules().ignore({0, 1});
  const SceneResult found = first_contact(bodies, workspace);
  EXPECT_EQ(found.verdict, Verdict::free);
  EXPECT_EQ(found.clearance, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(answer_each_pair(bodies, workspace).empty());
}

TEST(ManyBodies, StopsWithWhatIsProven) {
  Random random(10);
  const BodySet bodies = random_set(random, 50, 3.0);
  ManyBodiesWorkspace workspace;
  const SceneResult whole = first_contact(bodies, workspace);
  ASSERT_NE(whole.verdict, Verdict::free);
  std::stop_source stop;
  stop.request_stop();
  ManyBodiesOptions options;
  options.pair.budget.stop = stop.get_token();
  const SceneResult found = first_contact(bodies, workspace, options);
  EXPECT_EQ(found.verdict, Verdict::undecided);
  EXPECT_EQ(found.reason, UndecidedReason::cancelled);
  EXPECT_LE(found.t, whole.t);
}

TEST(ManyBodies, TellsItsProgress) {
  Random random(11);
  const BodySet bodies = random_set(random, 50, 6.0);
  ManyBodiesWorkspace workspace;
  std::vector<double> told;
  ManyBodiesOptions options;
  options.progress = [&](double done) { told.push_back(done); };
  (void)first_contact(bodies, workspace, options);
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.front(), 0.0);
  EXPECT_LE(told.back(), 1.0);
}

TEST(ManyBodies, RefusesOptionsOutOfRange) {
  BodySet bodies;
  ManyBodiesWorkspace workspace;
  ManyBodiesOptions options;
  options.pair.tolerance = 0.0;
  EXPECT_THROW((void)first_contact(bodies, workspace, options), std::invalid_argument);
  EXPECT_THROW((void)answer_each_pair(bodies, workspace, options), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
