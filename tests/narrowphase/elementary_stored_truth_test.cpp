// The elementary tests of all features of two soups, together, against the stored truth about the
// soups' first contact.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "narrowphase/elementary_features.h"
#include "support/exact_motion.h"
#include "support/truth_file.h"

namespace firstcontact::oracle {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Sums of the answers for all pairs of features.
struct Answers {
  double t_lower = kNever;   ///< No contact before.
  double t_proven = kNever;  ///< End of the first proven contact.
  int most_steps = 0;
};

Answers ask_elementary_tests(const GeneratedCase& c) {
  Answers answers;
  for_each_feature_pair(c.A, c.B, [&answers](const ElementaryContact& answer) {
    answers.most_steps = std::max(answers.most_steps, answer.steps);
    if (answer.verdict != ElementaryVerdict::free) {
      answers.t_lower = std::min(answers.t_lower, answer.t_lower);
    }
    if (answer.existence_proven) {
      answers.t_proven = std::min(answers.t_proven, answer.t_upper);
    }
  });
  return answers;
}

/// [m]  What roundings are relative to: the soups, their levers, their way to each other.
double size(const GeneratedCase& c) {
  const std::vector<MotionPiece> A = motion_pieces(c.A.motion, c.A.vertices[0]);
  const std::vector<MotionPiece> B = motion_pieces(c.B.motion, c.B.vertices[0]);
  double levers = 0.0;
  for (const std::vector<MotionPiece>* pieces : {&A, &B}) {
    for (const MotionPiece& piece : *pieces) {
      levers = std::max(levers, norm(piece.lever).upper());
    }
  }
  const double apart = norm(A[0].pivot - B[0].pivot).upper();
  return FirstContactOracle(c.A, c.B, 0.0).size() + 2.0 * levers + apart;
}

/// Whether features of the soups touch at t, up to rounding.
bool touch(const GeneratedCase& c, double t) {
  return FirstContactOracle(c.A, c.B, 0.0).distance(t).lower <= 1e-12 * size(c);
}

/// The plain questions of a family: surfaces without radius or margin.
class ElementaryTests : public testing::TestWithParam<int> {
 protected:
  template <class Judge>
  static void for_each_case(const Judge& judge) {
    const auto family = static_cast<Family>(GetParam());
    const std::filesystem::path data =
        std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests" / "data";
    const std::vector<StoredTruth> truths = read_truth(truth_path(data, family));
    int judged = 0;
    for (std::uint64_t i = 0; i < truths.size(); ++i) {
      const GeneratedCase c = generate(family, i);
      const bool plain = c.margin == 0.0 && c.A.radius == 0.0 && c.B.radius == 0.0;
      if (plain && truths[i].kind != TruthKind::gave_up) {
        SCOPED_TRACE(name(family) + " " + std::to_string(i));
        judge(c, truths[i], ask_elementary_tests(c));
        ++judged;
      }
    }
    EXPECT_GE(judged, 400);
  }
};

TEST_P(ElementaryTests, MissNoContactAndProveNoFalseOne) {
  for_each_case([](const GeneratedCase&, const StoredTruth& truth, const Answers& answers) {
    if (truth.kind == TruthKind::free) {
      EXPECT_EQ(answers.t_proven, kNever);
    } else {
      EXPECT_GE(answers.t_proven, truth.lo);
      // At the start an edge may stand in a face already, with no feature touching another.
      if (truth.lo > 0.0) {
        EXPECT_LE(answers.t_lower, truth.hi);
      }
    }
  });
}

/// Else "perhaps, from the start" would always do.
TEST_P(ElementaryTests, DoubtOnlyWhatTouches) {
  for_each_case([](const GeneratedCase& c, const StoredTruth& truth, const Answers& answers) {
    EXPECT_LE(answers.most_steps, 1000);
    const bool early = truth.kind == TruthKind::free ? answers.t_lower != kNever
                                                     : answers.t_lower < truth.lo - 1e-9;
    if (early) {
      EXPECT_TRUE(touch(c, answers.t_lower)) << "t_lower = " << answers.t_lower;
    }
  });
}

/// Transversal contacts are proven to exist; coplanar ones cannot be.
TEST_P(ElementaryTests, ProveWhatTheyFind) {
  int found = 0;
  int proven = 0;
  for_each_case([&](const GeneratedCase&, const StoredTruth& truth, const Answers& answers) {
    if (truth.kind == TruthKind::contact && truth.lo > 0.0) {
      ++found;
      proven += answers.t_proven <= truth.hi + 1e-8 ? 1 : 0;
    }
  });
  switch (static_cast<Family>(GetParam())) {
    case Family::planar:
    case Family::sliding_faces:
      break;
    case Family::end_contact:  // Half of them end within rounding.
    case Family::parallel_edges:
    case Family::peg_in_hole:
    case Family::rocking:
    case Family::tip_swing:  // Some touch within rounding.
      EXPECT_GE(proven, found / 4);
      break;
    default:
      EXPECT_EQ(proven, found);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, ElementaryTests, testing::Range(0, kFamilyCount),
                         [](const testing::TestParamInfo<int>& parameter) {
                           return name(static_cast<Family>(parameter.param));
                         });

}  // namespace
}  // namespace firstcontact::oracle
