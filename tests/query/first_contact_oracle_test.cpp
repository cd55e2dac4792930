// The library against the oracle: stored truth of more than 20,000 generated cases, and a fresh
// sample in every run.
//
// FIRSTCONTACT_ORACLE_CASES (default 1500) and FIRSTCONTACT_ORACLE_SEED (default: the clock) choose
// the fresh sample. A million cases take about 10 hours of one core:
//   FIRSTCONTACT_ORACLE_CASES=1000000 build/ci/tests/query/query_slow_test
//     --gtest_filter='*Fresh*'

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/from_environment.h"
#include "support/library_case.h"
#include "support/truth_file.h"

namespace firstcontact::oracle {
namespace {

constexpr std::size_t kStoredCases = 1'100;  // Number of stored cases of each family.
constexpr int kShownComplaints = 10;

std::string label(Family family, std::uint64_t index) {
  return name(family) + " " + std::to_string(index) + ": ";
}

class StoredTruthTest : public testing::TestWithParam<int> {};

TEST_P(StoredTruthTest, IsMet) {
  const auto family = static_cast<Family>(GetParam());
  const std::filesystem::path data =
      std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests" / "data";
  const std::vector<StoredTruth> truths = read_truth(truth_path(data, family));
  ASSERT_GE(truths.size(), kStoredCases) << "make it with: make_truth tests/data 1100";
  Workspace workspace;
  int wrong = 0;
  int undecided_truths = 0;
  for (std::uint64_t i = 0; i < truths.size(); ++i) {
    const GeneratedCase c = generate(family, i);
    const StoredTruth& truth = truths[i];
    ASSERT_EQ(digest(c), truth.digest) << "the generator changed; make the truth anew";
    undecided_truths += truth.kind == TruthKind::gave_up ? 1 : 0;
    const std::string complaints = complaint_either_way(
        c, ask_library(c, workspace), {truth.kind, truth.lo, truth.hi}, workspace);
    if (!complaints.empty() && ++wrong <= kShownComplaints) {
      ADD_FAILURE() << label(family, i) << complaints;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(undecided_truths, static_cast<int>(truths.size()) / 200) << "the oracle gave up";
}

INSTANTIATE_TEST_SUITE_P(Families, StoredTruthTest, testing::Range(0, kFamilyCount),
                         [](const testing::TestParamInfo<int>& parameter) {
                           return name(static_cast<Family>(parameter.param));
                         });

TEST(FreshTruth, IsMet) {
  const std::uint64_t count = test::from_environment("FIRSTCONTACT_ORACLE_CASES", 1'500);
  const std::uint64_t seed = test::from_environment(
      "FIRSTCONTACT_ORACLE_SEED",
      static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  std::printf("FIRSTCONTACT_ORACLE_SEED=%llu FIRSTCONTACT_ORACLE_CASES=%llu\n",
              static_cast<unsigned long long>(seed), static_cast<unsigned long long>(count));
  Workspace workspace;
  std::uint64_t gave_up = 0;
  int wrong = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto family = static_cast<Family>(i % kFamilyCount);
    const std::uint64_t index = seed + i;
    const GeneratedCase c = generate(family, index);
    const Truth truth = FirstContactOracle(c.A, c.B, c.margin).first_contact();
    gave_up += truth.kind == TruthKind::gave_up ? 1 : 0;
    const std::string complaints =
        complaint_either_way(c, ask_library(c, workspace), truth, workspace);
    if (!complaints.empty() && ++wrong <= kShownComplaints) {
      ADD_FAILURE() << label(family, index) << complaints;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(gave_up, count / 200 + 1) << "the oracle gave up";
}

}  // namespace
}  // namespace firstcontact::oracle
