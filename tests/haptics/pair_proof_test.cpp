// What of a plan is proven, and what a wedged tool may still do.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/detail/pair_proof.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kDistance = 1e-5;  // [m]  The contact distance.

/// Of a cube of 2 m that lies on a plate by a gap, and moves.
ProvenPart proven_part(double gap, const Vector3d& way, const Vector3d& turn = Vector3d::Zero()) {
  const std::vector<HapticMember> members = {{.shape = make_box({9.0, 9.0, 2.0})},
                                             {.shape = make_box({2.0, 2.0, 2.0})}};
  const double above = std::isfinite(gap) ? gap : 1.0;
  const Pose start{{0.0, 0.0, 2.0 + above}, Eigen::Quaterniond::Identity()};
  const std::array<Motion, 2> motions = {Motion::fixed(),
                                         Motion::constant_velocity(start, way, turn)};
  const HapticPair pair{.members = {0, 1}, .gap = gap};
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
