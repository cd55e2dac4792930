// The order of the search's queue, against that of the priorities themselves.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/query/detail/workspace_data.h>

#include "support/random.h"

namespace firstcontact::detail {
namespace {

TEST(SearchQueue, AnItemKeepsItsPriority) {
  for (const double priority :
       {0.0, -0.0, 1.0, -1.0, 0x1p-1074, -0x1p-1074, 1e300, -1e300, 0.1, -0.1}) {
    EXPECT_EQ(QueueItem(priority, 3, true).priority(), priority);
  }
}

TEST(SearchQueue, ItemsAreOrderedAsTheirPriorities) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> rising = {-infinity, -1e300, -1.0, -0x1p-1074, 0.0,
                                      0x1p-1074, 0.5,    1.0,  1e300,      infinity};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    for (std::size_t k = 0; k < rising.size(); ++k) {
      EXPECT_EQ(QueueItem(rising[i], 0, false) < QueueItem(rising[k], 0, false), i < k);
    }
  }
}

// Lags make the first priorities of a step negative.
TEST(SearchQueue, GivesTheLeastFirst) {
  test::Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    SearchQueue queue;
    std::vector<double> left;  // Sorted.
    for (int action = 0; action < 300; ++action) {
      const double choice = random.uniform(0.0, 1.0);
      const double priority = random.uniform(-0.1, 1.0);
      if (left.empty() || choice < 0.5) {
        queue.push({priority, static_cast<std::uint32_t>(action), false});
        left.push_back(priority);
      } else if (choice < 0.75) {
        queue.pop();
        left.erase(left.begin());
      } else {
        queue.replace_top({priority, static_cast<std::uint32_t>(action), true});
        left.front() = priority;
      }
      std::ranges::sort(left);
      ASSERT_EQ(queue.size(), left.size());
      if (!left.empty()) {
        ASSERT_EQ(queue.top().priority(), left.front()) << trial << ", " << action;
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact::detail
