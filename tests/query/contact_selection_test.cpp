#include <firstcontact/query/contact_selection.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact {
namespace {

using Ranks = std::vector<ContactRank>;

/// Contacts on a square metre, nearer on one side than on the other.
Ranks random_ranks(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in_metre(0.0, 1.0);
  Ranks ranks;
  for (std::uint64_t k = 0; k < count; ++k) {
    const Eigen::Vector3d place(in_metre(random), in_metre(random), 0.0);
    ranks.push_back({{k, 7 * k % count}, 0.1 * place.x() + 0.01 * in_metre(random), place});
  }
  return ranks;
}

Ranks selected(const Ranks& ranks, std::size_t most) {
  ContactSelection<ContactRank> selection(most);
  for (const ContactRank& rank : ranks) {
    selection.add(rank, rank);
  }
  Ranks kept = selection.take();
  std::sort(kept.begin(), kept.end());
  return kept;
}

bool same(const Ranks& x, const Ranks& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const ContactRank& a, const ContactRank& b) {
                      return a.features == b.features && a.distance == b.distance;
                    });
}

TEST(ContactSelection, KeepsAllThatThereIsRoomFor) {
  for (const std::size_t count : {1u, 2u, 63u, 200u}) {
    EXPECT_EQ(selected(random_ranks(count, 1), 200).size(), count);
  }
}

TEST(ContactSelection, KeepsAsManyAsThereIsRoomFor) {
  for (const std::size_t most : {1u, 2u, 3u, 10u, 64u, 100u, 999u}) {
    EXPECT_EQ(selected(random_ranks(5000, 2), most).size(), most);
  }
}

TEST(ContactSelection, KeepsHalfOfTheNearestAtLeast) {
  Ranks ranks = random_ranks(5000, 3);
  for (const std::size_t most : {1u, 2u, 10u, 100u, 999u}) {
    const Ranks kept = selected(ranks, most);
    std::sort(ranks.begin(), ranks.end());
    const std::size_t half = most - most / 2;
    EXPECT_TRUE(same({kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(half)},
                     {ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(half)}))
        << most;
  }
}

// The nearest alone would all be on one side.
TEST(ContactSelection, ReachesEveryRegion) {
  const Ranks kept = selected(random_ranks(5000, 4), 100);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      EXPECT_TRUE(std::any_of(kept.begin(), kept.end(),
                              [&](const ContactRank& rank) {
                                return static_cast<int>(2.0 * rank.place.x()) == i &&
                                       static_cast<int>(2.0 * rank.place.y()) == j;
                              }))
          << i << ' ' << j;
    }
  }
}

TEST(ContactSelection, DoesNotDependOnTheOrderInWhichContactsCome) {
  Ranks ranks = random_ranks(3000, 5);
  std::mt19937 random(6);
  for (const std::size_t most : {1u, 7u, 100u, 1000u}) {
    const Ranks kept = selected(ranks, most);
    for (int turn = 0; turn < 3; ++turn) {
      std::shuffle(ranks.begin(), ranks.end(), random);
      EXPECT_TRUE(same(selected(ranks, most), kept)) << most;
    }
  }
}

TEST(ContactSelection, DoesNotDependOnWhichBodyIsFirst) {
  Ranks ranks = random_ranks(3000, 7);
  for (std::size_t k = 0; k < ranks.size(); ++k) {
    ranks[k].distance = 0.125 * static_cast<double>(k % 3);  // Most are as near as others.
  }
  Ranks swapped = ranks;
  for (ContactRank& rank : swapped) {
    std::swap(rank.features[0], rank.features[1]);
  }
  Ranks kept = selected(swapped, 50);
  for (ContactRank& rank : kept) {
    std::swap(rank.features[0], rank.features[1]);
  }
  EXPECT_TRUE(same(kept, selected(ranks, 50)));
}

TEST(ContactSelection, CountsAContactOnceThatComesSeveralTimes) {
  const Ranks once = random_ranks(500, 8);
  Ranks thrice;
  for (int turn = 0; turn < 3; ++turn) {
    for (ContactRank rank : once) {
      rank.distance += 1e-3 * turn;
      thrice.push_back(rank);
    }
  }
  EXPECT_TRUE(same(selected(thrice, 100), selected(once, 100)));
}

TEST(ContactSelection, NeverHasAReachBelowThatOfTheNearest) {
  Ranks ranks = random_ranks(1000, 9);
  ContactSelection<ContactRank> selection(64);
  for (const ContactRank& rank : ranks) {
    selection.add(rank, rank);
  }
  selection.forget_far();
  std::sort(ranks.begin(), ranks.end());
  EXPECT_EQ(selection.reach(), ranks[63].distance);
}

}  // namespace
}  // namespace firstcontact
