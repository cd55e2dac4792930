// The promises hold on every instruction set: stored truth again, a part of it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/instruction_sets.h"
#include "support/library_case.h"
#include "support/truth_file.h"

namespace firstcontact::oracle {
namespace {

constexpr std::size_t kCases = 60;  // Number of cases of each family.

using FirstContactOn = test::OnInstructionSet;

TEST_P(FirstContactOn, MeetsTheTruth) {
  const std::filesystem::path data =
      std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "tests" / "data";
  Workspace workspace;
  for (int family = 0; family < kFamilyCount; ++family) {
    const auto truths = read_truth(truth_path(data, static_cast<Family>(family)));
    ASSERT_GE(truths.size(), kCases);
    for (std::uint64_t i = 0; i < kCases; ++i) {
      const GeneratedCase c = generate(static_cast<Family>(family), i);
      const StoredTruth& truth = truths[i];
      EXPECT_EQ(complaint(c, ask_library(c, workspace), {truth.kind, truth.lo, truth.hi}), "")
          << name(static_cast<Family>(family)) << " " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, FirstContactOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact::oracle
