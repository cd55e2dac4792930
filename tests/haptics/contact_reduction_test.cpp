// Few contacts in place of many: what they allow.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/contact_reduction.h>

#include "support/rounds.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

ToolFrames bolt_frames() {
  ToolFrames frames;
  frames.lengths = {0.02, 0.02};
  frames.p_WC = {Vector3d::Zero(), Vector3d::Zero()};
  return frames;
}

/// Contacts of a nut on the lower flank of its thread: thousands along a helix.
std::vector<HapticContact> thread_contacts(int count, double friction, bool both_flanks) {
  std::vector<HapticContact> contacts;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> gap(1e-6, 2e-6);
  for (int k = 0; k < count; ++k) {
    const double turn = 8.0 * 2.0 * std::numbers::pi * k / count;
    const Vector3d out(std::cos(turn), std::sin(turn), 0.0);
    HapticContact contact;
    contact.point = 0.008 * out + Vector3d(0.0, 0.0, 0.002 * turn / (2.0 * std::numbers::pi));
    const double side = both_flanks && k % 2 == 0 ? -1.0 : 1.0;
    contact.normal =
        (0.5 * -out + side * Vector3d::UnitZ() + side * 0.04 * Vector3d::UnitZ().cross(out))
            .normalized();
    contact.gap = gap(rng);
    contact.friction = friction;
    contacts.push_back(contact);
  }
  return contacts;
}

Vector6d row(const HapticContact& contact, const ToolFrames& frames) {
  return Eigen::Map<const Vector6d>(cone_contact(contact, frames).rows[0].data());
}

class Reductions : public testing::TestWithParam<bool> {};

TEST_P(Reductions, LeaveOtherContactsByNoMoreThanTheirAngle) {
  const ToolFrames frames = bolt_frames();
  const auto contacts = thread_contacts(4000, 0.0, GetParam());
  const ReducedContacts reduced = reduce_contacts(contacts, frames, 1, 0.0175, 128);
  EXPECT_LT(reduced.kept.size(), 128U);
  EXPECT_LT(reduced.angle, 0.3);
  ConeProjection few(6, reduced.kept.size());
  for (const std::size_t k : reduced.kept) {
    ConeContact cone = cone_contact(contacts[k], frames);
    few.add(cone);
  }
  std::mt19937 rng(4);
  std::normal_distribution<double> normal;
  double greatest = 0.0;
  for (int i = 0; i < 300; ++i) {
    Coordinates free{};
    for (std::size_t k = 0; k < 6; ++k) {
      free[k] = normal(rng);
    }
    const ConeProjectionResult found = few.project(free, 1e-12, 500);
    ASSERT_TRUE(found.is_solved);
    const Vector6d x = Eigen::Map<const Vector6d>(found.x.data());
    if (x.norm() < 1e-6) {
      continue;
    }
    for (const HapticContact& contact : contacts) {
      const Vector6d a = row(contact, frames);
      greatest = std::max(greatest, -a.dot(x) / (a.norm() * x.norm()));
    }
  }
  EXPECT_LE(greatest, std::sin(reduced.angle) + 1e-9);
}
INSTANTIATE_TEST_SUITE_P(OneAndBothFlanks, Reductions, testing::Bool());

// The other way round: what all contacts allow, the few allow too, as they are among them. So the
// projections differ little.
TEST(Reduction, ChangesProjectionsLittle) {
  const ToolFrames frames = bolt_frames();
  const auto contacts = thread_contacts(1000, 0.0, false);
  const ReducedContacts reduced = reduce_contacts(contacts, frames, 1, 0.0175, 128);
  ConeProjection all(6, contacts.size());
  for (const HapticContact& contact : contacts) {
    all.add(cone_contact(contact, frames));
  }
  ConeProjection few(6, 128);
  for (const std::size_t k : reduced.kept) {
    few.add(cone_contact(contacts[k], frames));
  }
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    Coordinates free{};
    for (std::size_t k = 0; k < 6; ++k) {
      free[k] = normal(rng);
    }
    const ConeProjectionResult x = all.project(free, 1e-12, 1000);
    const ConeProjectionResult y = few.project(free, 1e-12, 1000);
    ASSERT_TRUE(x.is_solved && y.is_solved);
    const Vector6d free_v = Eigen::Map<const Vector6d>(free.data());
    const Vector6d off =
        Eigen::Map<const Vector6d>(x.x.data()) - Eigen::Map<const Vector6d>(y.x.data());
    EXPECT_LT(off.norm(), 0.15 * free_v.norm()) << i;
  }
}

TEST(Reduction, KeepsAllOfFew) {
  std::vector<HapticContact> contacts(3);
  contacts[1].normal = Vector3d::UnitX();
  contacts[2].normal = Vector3d::UnitY();
  const ReducedContacts reduced = reduce_contacts(contacts, bolt_frames(), 1, 0.0175, 32);
  EXPECT_EQ(reduced.kept.size(), 3U);
  EXPECT_EQ(reduced.angle, 0.0);
}

// The friction of one contact keeps nothing apart: it does not stand for the normal of another one.
TEST(Reduction, KeepsANormalThatOnlyFrictionSpans) {
  std::vector<HapticContact> contacts(2);
  contacts[0].friction = 1.0;
  contacts[1].normal = Vector3d(0.5, 0.0, std::sqrt(0.75));  // 30 degrees off.
  contacts[1].gap = 1e-6;
  EXPECT_EQ(reduce_contacts(contacts, bolt_frames(), 1, 0.0175, 32).kept.size(), 2U);
}

/// The unit rows of contacts: normals alone, or the edges of those with friction alone.
std::vector<Vector6d> unit_rows(const std::vector<HapticContact>& contacts, bool edges) {
  std::vector<Vector6d> found;
  for (const HapticContact& contact : contacts) {
    const ConeContact cone = cone_contact(contact, bolt_frames());
    const auto row_of = [&](std::size_t k) -> Vector6d {
      return Eigen::Map<const Vector6d>(cone.rows[k].data());
    };
    if (!edges) {
      found.push_back(row_of(0).normalized());
    }
    for (const double mu : {cone.friction, -cone.friction}) {
      for (const std::size_t way : {1, 2}) {
        if (edges && mu != 0.0) {
          found.push_back((row_of(0) + mu * row_of(way)).normalized());
        }
      }
    }
  }
  return found;
}

/// [-]  How far the motions that `few` allow leave the half space of `row`: no less than the sine.
///
/// The sine is the distance of the row from the cone of the few (Moreau's decomposition). Whatever
/// shares >= 0 are found, the rest that they leave is no less.
double leave(const std::vector<Vector6d>& few, const Vector6d& row) {
  Vector6d rest = row;
  std::vector<double> shares(few.size(), 0.0);
  double moved = 1.0;
  for (int sweep = 0; sweep < 20000 && moved > 1e-10; ++sweep) {
    moved = 0.0;
    for (std::size_t k = 0; k < few.size(); ++k) {
      const double share = std::max(0.0, shares[k] + few[k].dot(rest));
      rest -= (share - shares[k]) * few[k];
      moved = std::max(moved, std::abs(share - shares[k]));
      shares[k] = share;
    }
  }
  return rest.norm();
}

// Contacts with and without friction, and angles so large that sines are far from straight.
TEST(Reduction, KeepsItsAngleWithAndWithoutFriction) {
  std::mt19937 rng(6);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> friction(0.1, 0.9);
  double tightest = 0.0;
  for (const double angle : {0.0175, 0.3, 0.7, 1.2, 1.5}) {
    for (int trial = 0; trial < test::rounds(4, 2); ++trial) {
      std::vector<HapticContact> contacts(60);
      for (HapticContact& contact : contacts) {
        contact.point = 0.02 * Vector3d(normal(rng), normal(rng), normal(rng));
        contact.normal = Vector3d(normal(rng), normal(rng), 2.0 + normal(rng)).normalized();
        contact.gap = 1e-6 * std::abs(normal(rng));
        contact.friction = trial % 2 == 0 || normal(rng) < 0.0 ? 0.0 : friction(rng);
      }
      const ReducedContacts reduced = reduce_contacts(contacts, bolt_frames(), 1, angle, 60);
      ASSERT_LE(reduced.angle, angle);
      std::vector<HapticContact> kept;
      for (const std::size_t k : reduced.kept) {
        kept.push_back(contacts[k]);
      }
      for (const bool edges : {false, true}) {
        const std::vector<Vector6d> few = unit_rows(kept, edges);
        const std::vector<Vector6d> rows = unit_rows(contacts, edges);
        for (std::size_t k = 0; k < rows.size(); k += test::rounds(1, 40)) {
          const double sine = leave(few, rows[k]);
          EXPECT_LE(sine, std::sin(reduced.angle) + 1e-6) << angle << ' ' << trial << ' ' << edges;
          tightest = std::max(tightest, sine / std::sin(angle));
        }
      }
    }
  }
  EXPECT_GT(tightest, 0.4);  // The bound is less than 2.5 times what happens.
}

TEST(Reduction, ClaimsALargerAngleWhereFewAreAllowed) {
  const auto contacts = thread_contacts(2000, 0.3, true);
  const ReducedContacts reduced = reduce_contacts(contacts, bolt_frames(), 1, 0.0175, 4);
  EXPECT_LE(reduced.kept.size(), 4U);
  EXPECT_GT(reduced.angle, 0.0175);
}

// Without time nothing is claimed, but the ends of a line of contacts are kept.
TEST(Reduction, KeepsTheOutermostWhereItsTimeIsOver) {
  ToolFrames frames;
  frames.lengths = {0.03, 0.03};
  std::vector<HapticContact> line(200);
  for (std::size_t k = 0; k < line.size(); ++k) {
    line[k].point = {1e-4 * static_cast<double>(k), 0.0, 0.0};
    line[k].gap = 1e-6 + 1e-9 * static_cast<double>(k % 7);
    line[k].friction = 0.3;
  }
  const ReducedContacts reduced =
      reduce_contacts(line, frames, 1, 0.0175, 8, std::chrono::steady_clock::time_point{});
  EXPECT_EQ(reduced.kept.size(), 8U);
  EXPECT_EQ(reduced.angle, std::numbers::pi);
  EXPECT_LE(reduced.kept.front(), 10U);
  EXPECT_GE(reduced.kept.back(), 189U);
}

// A cylinder that lies on a plate: the ends of the line are enough.
TEST(Reduction, KeepsTheEndsOfALine) {
  ToolFrames frames;
  frames.lengths = {0.03, 0.03};
  std::vector<HapticContact> line(200);
  for (std::size_t k = 0; k < line.size(); ++k) {
    line[k].point = {1e-4 * static_cast<double>(k), 0.0, 0.0};
    line[k].gap = 1e-6 + 1e-9 * static_cast<double>(k * 37 % 101);
    line[k].friction = 0.3;
  }
  const ReducedContacts reduced = reduce_contacts(line, frames, 1, 0.0175, 32);
  EXPECT_LE(reduced.kept.size(), 5U);
  EXPECT_EQ(reduced.kept.front(), 0U);
  EXPECT_EQ(reduced.kept.back(), 199U);
}

}  // namespace
}  // namespace firstcontact::detail
