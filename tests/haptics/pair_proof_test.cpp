// Proven part of a plan, and the motions that a wedged tool may still make.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/detail/pair_proof.h>

#include "support/random.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kDistance = 1e-5;  // [m]  The contact distance.

/// Returns the proven part of the motion of a cube of 2 m, which begins at a gap above a plate.
ProvenPart proven_part(double gap, const Vector3d& way, const Vector3d& turn = Vector3d::Zero()) {
  const std::vector<HapticMember> members = {{.shape = make_box({9.0, 9.0, 2.0})},
                                             {.shape = make_box({2.0, 2.0, 2.0})}};
  const double above = std::isfinite(gap) ? gap : 1.0;
  const Pose start{{0.0, 0.0, 2.0 + above}, Eigen::Quaterniond::Identity()};
  const std::array<Motion, 2> motions = {Motion::fixed(),
                                         Motion::constant_velocity(start, way, turn)};
  HapticPair pair{.members = {0, 1}, .gap = gap};
  Workspace workspace;
  FirstContactResult scratch;
  return prove_plan(members, motions, std::span(&pair, 1), kDistance, {}, workspace, scratch);
}

TEST(PairProof, AWedgedToolMovesWhereItComesNoNearer) {
  const double wedged = 1e-3 * kDistance;
  EXPECT_EQ(proven_part(wedged, {0.0, 0.0, 0.1}).t, 1.0);
  EXPECT_EQ(proven_part(wedged, {0.1, 0.0, 1e-9}).t, 1.0);
  EXPECT_EQ(proven_part(wedged, {0.1, 0.0, -1e-10}).t, 0.0);
  EXPECT_EQ(proven_part(wedged, {0.0, 0.0, 1e-12}, {1e-9, 0.0, 0.0}).t, 0.0);  // An edge sinks.
  EXPECT_EQ(proven_part(wedged, {0.0, 0.0, -0.1}).t, 0.0);
}

TEST(PairProof, SaysThatATooNearToolIsHeld) {
  const double wedged = 1e-3 * kDistance;
  EXPECT_TRUE(proven_part(wedged, {0.1, 0.0, -1e-10}).is_unproven);
  EXPECT_FALSE(proven_part(wedged, {0.1, 0.0, 1e-9}).is_unproven);
  EXPECT_FALSE(proven_part(kDistance, {0.0, 0.0, -0.1}).is_unproven);
}

/// A cube that slides along a plate, and one that rests on it while another one moves: anywhere.
TEST(PairProof, RoundingAloneHoldsNoTool) {
  const double wedged = 1e-3 * kDistance;
  const std::vector<HapticMember> members = {{.shape = make_box({9.0, 9.0, 2.0}), .reach = 6.5},
                                             {.shape = make_box({2.0, 2.0, 2.0}), .reach = 1.8},
                                             {.shape = make_box({2.0, 2.0, 2.0}), .reach = 1.8}};
  Workspace workspace;
  FirstContactResult scratch;
  test::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Quaterniond turn = random.rotation();
    const Vector3d origin = 10.0 * random.direction();
    const auto placed = [&](const Vector3d& p) { return Pose{origin + turn * p, turn}; };
    const std::array<Motion, 3> motions = {
        Motion::fixed(placed(Vector3d::Zero())),
        k % 2 == 0 ? Motion::fixed(placed({0.0, 0.0, 2.0 + wedged}))
                   : Motion::constant_velocity(placed({0.0, 0.0, 2.0 + wedged}),
                                               turn * Vector3d(0.1, 0.2, 0.0)),
        Motion::constant_velocity(placed({0.0, 0.0, 20.0}), turn * Vector3d(0.0, 0.0, -1.0))};
    std::array<HapticPair, 2> pairs = {
        {{.members = {0, 1}, .gap = wedged * (1.0 + 1e-7)},
         {.members = {0, 2}, .gap = std::numeric_limits<double>::infinity()}}};
    EXPECT_EQ(prove_plan(members, motions, pairs, kDistance, {}, workspace, scratch).t, 1.0) << k;
  }
}

TEST(PairProof, AnotherOneMayComeNearerToItsShare) {
  const double gap = 0.2 * kDistance;
  const ProvenPart part = proven_part(gap, {0.0, 0.0, -gap});
  EXPECT_GT(part.t, 0.04);
  EXPECT_LT(part.t, 0.1);  // To 0.9 of the gap.
  EXPECT_LE(part.clearance, 0.9 * gap * (1.0 + 1e-12));
  const ProvenPart far = proven_part(std::numeric_limits<double>::infinity(), {0.0, 0.0, 1.0});
  EXPECT_EQ(far.t, 1.0);
  EXPECT_EQ(far.clearance, kDistance);
}

}  // namespace
}  // namespace firstcontact::detail
