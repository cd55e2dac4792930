// First contact of links against the oracle of 256 bits: stored truth of more than 5,000 generated
// cases, chains of up to 12 joints of all types.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "robot_check/robot_library_case.h"
#include "support/generated_robot_case.h"
#include "support/robot_contact_oracle.h"
#include "support/truth_file.h"

namespace firstcontact::oracle {
namespace {

constexpr std::size_t kStoredCases = 460;  // Number of stored cases of each family.
static_assert(kStoredCases * kRobotFamilyCount > 5'000);
constexpr int kShownComplaints = 10;

class RobotStoredTruthTest : public testing::TestWithParam<int> {};

TEST_P(RobotStoredTruthTest, IsMet) {
  const auto family = static_cast<RobotFamily>(GetParam());
  const std::filesystem::path data =
      std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests" / "data";
  const std::vector<StoredTruth> truths = read_truth(truth_path(data, family));
  ASSERT_GE(truths.size(), kStoredCases) << "make it with: make_truth tests/data 1100 460";
  Workspace workspace;
  int wrong = 0;
  std::size_t contacts = 0;
  std::size_t unknown = 0;
  for (std::uint64_t i = 0; i < truths.size(); ++i) {
    const RobotCase c = generate(family, i);
    const StoredTruth& stored = truths[i];
    ASSERT_EQ(digest(c), stored.digest) << "the generator changed; make the truth anew";
    const Truth truth{stored.kind, stored.lo, stored.hi};
    contacts += truth.kind == TruthKind::contact ? 1 : 0;
    unknown += truth.kind == TruthKind::gave_up ? 1 : 0;
    const FirstContactResult answer = ask_library(c, false, workspace);
    const FirstContactResult other = ask_library(c, true, workspace);
    std::string complaints = complaint(c, answer, truth);
    if (other.verdict != answer.verdict || other.t != answer.t) {
      complaints += " differs when swapped: t = " + std::to_string(other.t);
    }
    if (!complaints.empty() && ++wrong <= kShownComplaints) {
      ADD_FAILURE() << name(family) << " " << i << ": " << complaints;
    }
  }
  EXPECT_EQ(wrong, 0);
  // Else the family asks nothing.
  EXPECT_GE(contacts, truths.size() / 8);
  EXPECT_LE(contacts, truths.size() * 7 / 8);
  EXPECT_LE(unknown, truths.size() / 100) << "the oracle gave up";
}

/// The judge itself: answers that break a promise by a little are found out.
TEST(RobotComplaint, NoticesWrongAnswers) {
  RobotCase c;
  Truth truth;
  for (std::uint64_t i = 0; truth.kind != TruthKind::contact || truth.lo < 0.1; ++i) {
    c = generate(RobotFamily::link_and_body, i);
    truth = RobotContactOracle(c).first_contact();
  }
  FirstContactResult answer;
  answer.verdict = Verdict::contact;
  answer.tolerance_used = c.tolerance;
  answer.t = truth.lo;
  EXPECT_EQ(complaint(c, answer, truth), "");
  answer.t = truth.hi + 1e-9;
  EXPECT_EQ(complaint(c, answer, truth).substr(0, 4), "late");
  answer.t = truth.lo - 0.05;
  EXPECT_EQ(complaint(c, answer, truth).substr(0, 5), "false");
  answer.verdict = Verdict::free;
  EXPECT_EQ(complaint(c, answer, truth).substr(0, 6), "missed");
}

INSTANTIATE_TEST_SUITE_P(Families, RobotStoredTruthTest, testing::Range(0, kRobotFamilyCount),
                         [](const testing::TestParamInfo<int>& parameter) {
                           return name(static_cast<RobotFamily>(parameter.param));
                         });

}  // namespace
}  // namespace firstcontact::oracle
