// Which contacts are listed where there are very many.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/first_contact.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

/// [m]  The band holds many pairs of features of two plates that are 10 mm apart at one edge.
constexpr double kMargin = 0.03;

/// A square plate of n x n cells of 1 mm.
Shape plate(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      mesh.vertices.emplace_back(1e-3 * i, 1e-3 * j, 1e-6 * ((7 * i + 3 * j) % 5));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = i * (n + 1) + j;
      mesh.triangles.push_back({k, k + n + 1, k + 1});
      mesh.triangles.push_back({k + 1, k + n + 1, k + n + 2});
    }
  }
  return Shape(std::move(mesh));
}

auto features(const Contact& contact) {
  return std::tuple(contact.feature_A.type, contact.feature_A.index, contact.feature_B.type,
                    contact.feature_B.index);
}

bool comes_before(const Contact& x, const Contact& y) { return features(x) < features(y); }

/// A plate and one above it that is tilted a little.
struct Plates {
  explicit Plates(std::uint32_t n) : A(plate(n)), B(plate(n + 1)) {}

  [[nodiscard]] FirstContactResult ask(const ContactState& contacts) const {
    return ask({A, X_WA}, {B, X_WB}, contacts);
  }
  /// With A and B swapped, and its contacts swapped back.
  [[nodiscard]] FirstContactResult ask_swapped(const ContactState& contacts) const {
    FirstContactResult result = ask({B, X_WB}, {A, X_WA}, contacts);
    std::for_each(result.contacts.begin(), result.contacts.end(), swap_bodies);
    std::sort(result.contacts.begin(), result.contacts.end(), comes_before);
    return result;
  }

  Shape A;
  Shape B;
  Motion X_WA = Motion::fixed();
  Motion X_WB = Motion::fixed(
      {{0.0, 0.0, 0.01}, Eigen::Quaterniond(Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitY()))});

 private:
  /// Contacts by the features of A, whichever of the two comes first by content.
  static FirstContactResult ask(const MovingShape& first, const MovingShape& second,
                                const ContactState& contacts) {
    Workspace workspace;
    FirstContactResult result =
        first_contact(first, second, workspace, {.margin = kMargin, .contacts = contacts});
    std::sort(result.contacts.begin(), result.contacts.end(), comes_before);
    return result;
  }
};

std::vector<double> distances(const std::vector<Contact>& contacts) {
  std::vector<double> sorted;
  for (const Contact& contact : contacts) {
    sorted.push_back(contact.distance);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Every contact of some is one of all.
void expect_among(const std::vector<Contact>& some, const std::vector<Contact>& all) {
  for (const Contact& contact : some) {
    const auto found = std::lower_bound(
        all.begin(), all.end(), contact,
        [](const Contact& x, const Contact& y) { return features(x) < features(y); });
    ASSERT_NE(found, all.end());
    ASSERT_EQ(features(*found), features(contact));
    ASSERT_NEAR(found->distance, contact.distance, 1e-15);
  }
}

// Few enough to be listed before some are chosen, and so many that they are chosen as they come.
class ContactList : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ContactList, HasAllWhereAllAreAskedFor) {
  const FirstContactResult all = Plates(GetParam()).ask(ContactState::all);
  EXPECT_EQ(all.verdict, Verdict::contact_at_start);
  EXPECT_TRUE(all.contact_count.is_exact);
  EXPECT_EQ(all.contact_count.at_least, all.contacts.size());
  const FirstContactResult most = Plates(GetParam()).ask(ContactState::nearest(10'000'000));
  EXPECT_EQ(most.contacts.size(), all.contacts.size());
}

TEST_P(ContactList, HasTheNearestOfManyAndTheirCount) {
  const Plates plates(GetParam());
  const FirstContactResult all = plates.ask(ContactState::all);
  const std::vector<double> nearest = distances(all.contacts);
  for (const std::size_t most : {1u, 2u, 7u, 100u, 1000u}) {
    const FirstContactResult some = plates.ask(ContactState::nearest(most));
    ASSERT_EQ(some.contacts.size(), most);
    EXPECT_TRUE(some.contact_count.is_exact);
    EXPECT_EQ(some.contact_count.at_least, all.contacts.size());
    expect_among(some.contacts, all.contacts);
    const std::vector<double> kept = distances(some.contacts);
    for (std::size_t k = 0; k < most - most / 2; ++k) {
      ASSERT_NEAR(kept[k], nearest[k], 1e-15) << most << ' ' << k;
    }
  }
}

// The nearest alone would all be at the edge where the plates come closest.
TEST_P(ContactList, ReachesOverTheWholeSurface) {
  const FirstContactResult some = Plates(GetParam()).ask(ContactState::nearest(100));
  const double side = 1e-3 * GetParam();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      EXPECT_TRUE(std::any_of(some.contacts.begin(), some.contacts.end(),
                              [&](const Contact& c) {
                                return std::floor(2.0 * c.p_WA.x() / side) == i &&
                                       std::floor(2.0 * c.p_WA.y() / side) == j;
                              }))
          << i << ' ' << j;
    }
  }
}

TEST_P(ContactList, IsTheSameWithTheBodiesSwapped) {
  const Plates plates(GetParam());
  const FirstContactResult found = plates.ask(ContactState::nearest(50));
  const FirstContactResult swapped = plates.ask_swapped(ContactState::nearest(50));
  EXPECT_EQ(found.contact_count.at_least, swapped.contact_count.at_least);
  ASSERT_EQ(found.contacts.size(), swapped.contacts.size());
  for (std::size_t k = 0; k < found.contacts.size(); ++k) {
    EXPECT_EQ(features(found.contacts[k]), features(swapped.contacts[k]));
    EXPECT_EQ(found.contacts[k].distance, swapped.contacts[k].distance);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ContactList, testing::Values(8u, test::rounds(18, 12)));

TEST(ContactListOfVeryMany, EndsCountingAndStillHasTheNearest) {
  const Plates plates(40);
  const FirstContactResult found = plates.ask(ContactState::nearest(10));
  EXPECT_EQ(found.contacts.size(), 10u);
  EXPECT_FALSE(found.contact_count.is_exact);
  EXPECT_EQ(found.contact_count.at_least, std::uint64_t{1} << 18);
  const FirstContactResult first = plates.ask(ContactState::nearest(1));
  ASSERT_EQ(first.contacts.size(), 1u);
  EXPECT_EQ(distances(first.contacts)[0], distances(found.contacts)[0]);
}

TEST(ContactListOfVeryMany, OfNoneOrTheFirstCountsNothing) {
  const Plates plates(8);
  const FirstContactResult none = plates.ask(ContactState::none);
  EXPECT_TRUE(none.contacts.empty());
  EXPECT_FALSE(none.contact_count.is_exact);
  const FirstContactResult first = plates.ask(ContactState::first);
  EXPECT_EQ(first.contacts.size(), 1u);
  EXPECT_EQ(first.contact_count.at_least, 1u);
  EXPECT_FALSE(first.contact_count.is_exact);
}

TEST(ContactListOfVeryMany, RefusesToListNoneByNumber) {
  EXPECT_THROW((void)Plates(2).ask(ContactState::nearest(0)), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
