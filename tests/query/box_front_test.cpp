// Questions that begin at a front of box pairs, against the same from the roots.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/detail/front_query.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/resting_pair.h>
#include <firstcontact/query/distance.h>

#include "support/random.h"
#include "support/rounds.h"
#include "support/thread_mesh.h"

namespace firstcontact {
namespace {

using detail::BoxFront;
using Eigen::Vector3d;

/// A ball of about 1 m with bumps.
Shape rough_ball(std::uint64_t seed) {
  constexpr std::uint32_t kRows = 14;
  constexpr std::uint32_t kColumns = 24;
  test::Random random(seed);
  Mesh mesh;
  for (std::uint32_t i = 0; i <= kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const double tilt = std::numbers::pi * i / kRows;
      const double turn = 2.0 * std::numbers::pi * j / kColumns;
      const double r = random.uniform(0.85, 1.0);
      mesh.vertices.push_back(r * Vector3d(std::sin(tilt) * std::cos(turn),
                                           std::sin(tilt) * std::sin(turn), std::cos(tilt)));
    }
  }
  for (std::uint32_t i = 0; i < kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const std::uint32_t next = (j + 1) % kColumns;
      const std::uint32_t row = kColumns * i;
      mesh.triangles.push_back({row + j, row + kColumns + j, row + kColumns + next});
      mesh.triangles.push_back({row + j, row + kColumns + next, row + next});
    }
  }
  return Shape(std::move(mesh));
}

std::vector<Contact> from_roots(const Shape& A, const Pose& X_WA, const Shape& B, const Pose& X_WB,
                                double band) {
  Workspace workspace;
  std::vector<Contact> contacts;
  close_features(PlacedShape(A, X_WA), PlacedShape(B, X_WB), band, workspace, contacts);
  return contacts;
}

std::vector<Contact> from_front(const Shape& A, const Pose& X_WA, const Shape& B, const Pose& X_WB,
                                double band, BoxFront& front) {
  Workspace workspace;
  std::vector<Contact> contacts;
  close_features_by_front(PlacedShape(A, X_WA), PlacedShape(B, X_WB), band, 0.0, front, workspace,
                          contacts);
  return contacts;
}

/// Expects each contact that is clearly within the band among the others.
void expect_all(const std::vector<Contact>& contacts, const std::vector<Contact>& others,
                double within) {
  for (const Contact& contact : contacts) {
    const auto is_same = [&](const Contact& other) {
      return contact.feature_A.type == other.feature_A.type &&
             contact.feature_A.index == other.feature_A.index &&
             contact.feature_B.type == other.feature_B.type &&
             contact.feature_B.index == other.feature_B.index;
    };
    if (contact.distance < within) {
      EXPECT_TRUE(std::ranges::any_of(others, is_same)) << contact.distance;
    }
  }
}

/// A walk of B around A: small steps, a few large ones, and back to where it was.
class Walk {
 public:
  Walk(std::uint64_t seed, const Vector3d& origin) : random_(seed), origin_(origin) { jump(); }

  [[nodiscard]] Pose A() const { return {origin_, turn_A_}; }
  [[nodiscard]] Pose B() const { return {origin_ + away_, turn_B_}; }
  [[nodiscard]] test::Random& random() { return random_; }

  void step() {
    if (random_.chance(0.05)) {
      jump();
      return;
    }
    const double size = random_.logarithmic(1e-6, 3e-2);
    away_ += random_.vector(0.0, size);
    const double angle = random_.uniform(0.0, size);
    turn_B_ = Eigen::AngleAxisd(angle, random_.direction()) * turn_B_;
    if (random_.chance(0.3)) {  // Both move: only how they are to each other counts.
      const Eigen::Quaterniond turn = random_.rotation();
      turn_A_ = turn * turn_A_;
      turn_B_ = turn * turn_B_;
      away_ = turn * away_;
    }
  }

 private:
  void jump() {
    turn_A_ = random_.rotation();
    turn_B_ = random_.rotation();
    away_ = random_.vector(1.8, 1.95);
  }

  test::Random random_;
  Vector3d origin_;
  Vector3d away_;
  Eigen::Quaterniond turn_A_;
  Eigen::Quaterniond turn_B_;
};

TEST(BoxFront, FindsTheFeaturesThatTheRootsFind) {
  constexpr double kBand = 0.03;
  std::size_t found = 0;
  for (const double far : {0.0, 1e3, 1e6}) {
    const Shape A = rough_ball(1);
    const Shape B = rough_ball(2);
    Walk walk(3, far * Vector3d(1.0, -0.7, 0.4));
    BoxFront front;
    for (int k = 0; k < test::rounds(300, 60); ++k, walk.step()) {
      const auto expected = from_roots(A, walk.A(), B, walk.B(), kBand);
      const auto contacts = from_front(A, walk.A(), B, walk.B(), kBand, front);
      const double within = kBand - 1e-12 - 1e-14 * far;
      expect_all(expected, contacts, within);
      expect_all(contacts, expected, within);
      found += contacts.size();
    }
  }
  EXPECT_GT(found, std::size_t{test::rounds(1000, 200)});
}

/// Two of the same shape, which queries order by their places: a front has an order of its own.
TEST(BoxFront, ServesTwoOfOneShape) {
  constexpr double kBand = 0.03;
  const Shape ball = rough_ball(4);
  Walk walk(5, Vector3d::Zero());
  BoxFront front;
  for (int k = 0; k < 200; ++k, walk.step()) {
    const auto expected = from_roots(ball, walk.A(), ball, walk.B(), kBand);
    const auto contacts = from_front(ball, walk.A(), ball, walk.B(), kBand, front);
    expect_all(expected, contacts, kBand - 1e-12);
    expect_all(contacts, expected, kBand - 1e-12);
  }
}

/// Expects that what is proven free is, and that a contact is one.
void expect_true(const FirstContactResult& result, const MovingShape& A, const MovingShape& B,
                 const FirstContactOptions& options, double rounding) {
  Workspace workspace;
  for (int k = 0; k <= 20 && result.verdict != Verdict::contact_at_start; ++k) {
    const double t = result.t * k / 20.0;
    EXPECT_GT(distance(A, B, t, workspace).distance, options.margin - rounding) << t;
  }
  if (result.verdict != Verdict::free) {
    EXPECT_LE(distance(A, B, result.t, workspace).distance,
              options.margin + options.tolerance + rounding);
  }
}

TEST(BoxFront, ProvesMotionsOfAnyLength) {
  std::size_t free = 0;
  std::size_t met = 0;
  const FirstContactOptions options{
      .margin = 1e-3, .tolerance = 1e-4, .contacts = ContactState::none};
  for (const double far : {0.0, 1e3, 1e6}) {
    const Shape A = rough_ball(6);
    const Shape B = rough_ball(7);
    Walk walk(8, far * Vector3d(0.2, 1.0, -0.5));
    BoxFront front;
    for (int k = 0; k < test::rounds(150, 30); ++k, walk.step()) {
      (void)from_front(A, walk.A(), B, walk.B(), 2e-3, front);
      test::Random& random = walk.random();
      const double size = random.logarithmic(1e-4, 3.0);
      const Motion motion_A = random.chance(0.5)
                                  ? Motion::fixed(walk.A())
                                  : Motion::constant_velocity(walk.A(), random.vector(0.0, size),
                                                              random.vector(0.0, size));
      const Motion motion_B =
          Motion::constant_velocity(walk.B(), random.vector(0.0, size), random.vector(0.0, size));
      Workspace workspace;
      FirstContactResult result;
      const MovingShape moving_A{A, motion_A};
      const MovingShape moving_B{B, motion_B};
      first_contact_by_front(front, moving_A, moving_B, {}, workspace, options, result);
      const FirstContactResult expected = first_contact(moving_A, moving_B, workspace, options);
      ASSERT_NE(result.verdict, Verdict::undecided);
      if (result.verdict != expected.verdict) {  // Only where they graze.
        EXPECT_TRUE(result.verdict == Verdict::free || expected.verdict == Verdict::free);
      }
      expect_true(result, moving_A, moving_B, options, 1e-12 + 1e-14 * far);
      (result.verdict == Verdict::free ? free : met) += 1;
    }
  }
  EXPECT_GT(free, std::size_t{test::rounds(50, 10)});
  EXPECT_GT(met, std::size_t{test::rounds(50, 10)});
}

/// A motion of the surroundings from a pose: a door on its hinge, a screw, or a course with bends.
Motion surroundings_from(const Pose& start, test::Random& random, double size) {
  const Vector3d hinge = start.position + random.vector(0.5, 3.0);
  const double angle = random.uniform(-size, size);
  if (random.chance(0.6)) {
    const double along = random.chance(0.5) ? 0.0 : random.uniform(-size, size);
    return Motion::screw(start, hinge, random.direction(), angle, along);
  }
  const auto moved = [&](const Pose& from) {
    return Pose{from.position + random.vector(0.0, size),
                Eigen::AngleAxisd(0.5 * size, random.direction()) * from.rotation};
  };
  const Pose bend = moved(start);
  return Motion::waypoints(std::array{0.0, random.uniform(0.2, 0.8), 1.0},
                           std::array{start, bend, moved(bend)});
}

TEST(BoxFront, ProvesWhereSurroundingsTurnOnHingesAndScrews) {
  std::size_t free = 0;
  std::size_t met = 0;
  const FirstContactOptions options{
      .margin = 1e-3, .tolerance = 1e-4, .contacts = ContactState::none};
  const Shape A = rough_ball(15);
  const Shape B = rough_ball(16);
  Walk walk(17, Vector3d(0.3, -0.2, 0.1));
  BoxFront front;
  for (int k = 0; k < test::rounds(300, 60); ++k, walk.step()) {
    (void)from_front(A, walk.A(), B, walk.B(), 2e-3, front);
    test::Random& random = walk.random();
    const double size = random.logarithmic(1e-4, 1.0);
    const Motion motion_A = surroundings_from(walk.A(), random, size);
    const Motion motion_B = random.chance(0.5)
                                ? Motion::fixed(walk.B())
                                : Motion::constant_velocity(walk.B(), random.vector(0.0, size),
                                                            random.vector(0.0, size));
    Workspace workspace;
    FirstContactResult result;
    first_contact_by_front(front, {A, motion_A}, {B, motion_B}, {}, workspace, options, result);
    ASSERT_NE(result.verdict, Verdict::undecided);
    expect_true(result, {A, motion_A}, {B, motion_B}, options, 1e-12);
    (result.verdict == Verdict::free ? free : met) += 1;
  }
  EXPECT_GT(free, std::size_t{test::rounds(50, 10)});
  EXPECT_GT(met, std::size_t{test::rounds(50, 10)});
}

/// A front that is refined again and again takes no more memory than a few new ones.
TEST(BoxFront, StaysSmallHoweverLongItIsKept) {
  constexpr double kBand = 0.03;
  const Shape A = rough_ball(18);
  const Shape B = rough_ball(19);
  Walk walk(20, Vector3d::Zero());
  BoxFront kept;
  std::size_t largest = 0;
  std::size_t largest_new = 0;
  for (int k = 0; k < test::rounds(3000, 600); ++k, walk.step()) {
    (void)from_front(A, walk.A(), B, walk.B(), kBand, kept);
    BoxFront begun;
    (void)from_front(A, walk.A(), B, walk.B(), kBand, begun);
    largest = std::max(largest, kept.size());
    largest_new = std::max(largest_new, begun.size());
  }
  EXPECT_GT(largest_new, 20U);
  EXPECT_LE(largest, 3 * largest_new);
}

/// The front's bounds may be used up to the last bit, and are no wider than the motion.
TEST(BoxFront, IsUsedUpByTheWholeWay) {
  const Shape A = rough_ball(9);
  const Shape B = rough_ball(10);
  Workspace workspace;
  test::Random random(11);
  for (int k = 0; k < 50; ++k) {
    const Pose X_WA{{0.0, 0.0, 0.0}, random.rotation()};
    Pose X_WB{random.vector(2.3, 2.6), random.rotation()};
    BoxFront front;
    constexpr double kBand = 0.01;
    EXPECT_TRUE(from_front(A, X_WA, B, X_WB, kBand, front).empty());
    const Motion motion_A = Motion::fixed(X_WA);
    const Motion motion_B = Motion::fixed(X_WB);
    const DistanceResult start = distance({A, motion_A}, {B, motion_B}, 0.0, workspace);
    const Vector3d d = start.closest->p_WB - start.closest->p_WA;
    // To the band and no farther, but for what rounding may leave.
    const double way = start.distance - kBand * (1.0 - 1e-9);
    X_WB.position -= way / d.norm() * d;
    const PlacedShape placed_A(A, X_WA);
    const PlacedShape placed_B(B, X_WB);
    const detail::RestingPair resting(placed_A.path(), placed_B.path());
    const detail::MovingPair pair(A.hierarchy(), B.hierarchy(), resting);
    const detail::FrontMotion moved(front.place(), pair, resting.state(0.0), 0.0);
    EXPECT_GE(moved.most(), way);
    EXPECT_LE(moved.most(), way + 1e-9);
    EXPECT_FALSE(from_front(A, X_WA, B, X_WB, kBand, front).empty());
  }
}

/// A front that begins elsewhere loses the way of each of its balls, and no more.
TEST(BoxFront, FallsByTheWayWhereItBeginsAnew) {
  const Shape A = rough_ball(21);
  const Shape B = rough_ball(22);
  test::Random random(23);
  for (int k = 0; k < 20; ++k) {
    const Pose X_WA{{0.0, 0.0, 0.0}, random.rotation()};
    Pose X_WB{random.vector(2.0, 2.1), random.rotation()};
    BoxFront front;
    (void)from_front(A, X_WA, B, X_WB, 0.01, front);
    X_WB.position += random.vector(0.0, 0.1);
    X_WB.rotation = Eigen::AngleAxisd(random.uniform(0.0, 0.1), random.direction()) * X_WB.rotation;
    const PlacedShape placed_A(A, X_WA);
    const PlacedShape placed_B(B, X_WB);
    const detail::RestingPair resting(placed_A.path(), placed_B.path());
    const detail::MovingPair pair(A.hierarchy(), B.hierarchy(), resting);
    const detail::FrontMotion moved(front.place(), pair, resting.state(0.0), 0.0);
    const BoxFront before = front;
    front.rebase(pair, resting.state(0.0));
    ASSERT_EQ(front.size(), before.size());
    for (std::size_t group = 0; group < front.size(); ++group) {
      if (front.group(group).live == 0) {
        continue;
      }
      const double left = before.least(group) - moved.of(front.ball(group));
      EXPECT_LE(front.least(group), left);
      EXPECT_GE(front.least(group), left - 1e-5);
    }
    const detail::FrontMotion still(front.place(), pair, resting.state(0.0), 0.0);
    EXPECT_LT(still.most(), 1e-9);
  }
}

/// No point of A gets nearer to one of B by more than the bound of its ball. Where A does not turn,
/// the point of B gets no farther, as A sees it.
TEST(BoxFront, BoundsByHowMuchPointsComeNearer) {
  test::Random random(12);
  const Shape A = rough_ball(13);
  const Shape B = rough_ball(14);
  double tightest = 1e9;
  for (int k = 0; k < 500; ++k) {
    const bool turns = random.chance(0.3);
    const double size = random.logarithmic(1e-3, 1.0);
    const Pose start_A{random.vector(0.0, 2.0), random.rotation()};
    const Pose start_B{start_A.position + random.vector(2.0, 3.0), random.rotation()};
    const Motion motion_A = Motion::constant_velocity(
        start_A, random.vector(0.0, size), turns ? random.vector(0.0, size) : Vector3d::Zero());
    const Motion motion_B =
        Motion::constant_velocity(start_B, random.vector(0.0, size), random.vector(0.0, size));
    ConstantRatePair motion = detail::motion_of({A, motion_A}, {B, motion_B}, 1e-9);
    motion.enter(0.0);
    const detail::MovingPair pair(A.hierarchy(), B.hierarchy(), motion);
    BoxFront front;
    front.begin(pair, motion.state(0.0));
    const BoxFront::Ball ball{(random.vector(0.0, 0.9)).cast<float>(),
                              static_cast<float>(random.uniform(0.0, 0.05))};
    const double t = random.uniform(0.0, 1.0);
    const double tau = random.uniform(0.0, 1.0 - t);
    const detail::FrontMotion bound(front.place(), pair, motion.state(t), tau);
    const Vector3d y =
        ball.centre.cast<double>() + random.vector(0.0, static_cast<double>(ball.radius));
    const auto seen = [&](double at) -> Vector3d {
      const RelativeState state = motion.state(at);
      return state.R_WA.transpose() * (state.p_AB + state.R_WB * y);
    };
    const double way = (seen(t + tau) - seen(0.0)).norm();
    const Vector3d a = random.vector(0.0, 0.99);
    const double nearer = (seen(0.0) - a).norm() - (seen(t + tau) - a).norm();
    EXPECT_LE(nearer, bound.of(ball)) << k;
    if (!turns) {
      EXPECT_LE(way, bound.of(ball)) << k;
      tightest = std::min(tightest, bound.of(ball) - way);
    }
    EXPECT_LE(bound.of(ball), bound.most());
  }
  EXPECT_LT(tightest, 1e-3);
}

/// Threads that slide in each other are near everywhere: they are sooner found by their screw.
TEST(BoxFront, IsGivenUpWhereThreadsSlide) {
  const Shape rod = test::make_thread({.segments = 200, .turns = 5});
  const Shape nut = test::make_thread({.segments = 200, .turns = 3, .wider = 0.01, .shift = 1.0});
  const Pose X_WA;
  const Pose X_WB{{0.0, 0.0, 0.5}, Eigen::Quaterniond::Identity()};
  BoxFront front;
  const auto contacts = from_front(rod, X_WA, nut, X_WB, 0.02, front);
  EXPECT_TRUE(front.is_empty());
  const auto expected = from_roots(rod, X_WA, nut, X_WB, 0.02);
  ASSERT_FALSE(contacts.empty());
  const auto nearest = [](const std::vector<Contact>& all) {
    return std::ranges::min_element(all, {}, &Contact::distance)->distance;
  };
  EXPECT_NEAR(nearest(contacts), nearest(expected), 1e-12);
}

}  // namespace
}  // namespace firstcontact
