/// @file
/// The instruction sets that the kernel was compiled for and this processor has, one at a time.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <firstcontact/narrowphase/detail/box_bounds.h>

namespace firstcontact::test {

/// Fixture of a test that runs on one instruction set, its parameter.
class OnInstructionSet : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { choose(GetParam()); }
  void TearDown() override { choose(0); }

  /// Selects an instruction set; 0 selects all that the processor has.
  static void choose(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

/// Returns all instruction sets; under sanitizers only the best one and the plainest.
inline std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> sets;
  for (std::int64_t all = detail::box_bounds_targets(); all != 0; all &= all - 1) {
    sets.push_back(all & -all);
  }
  if (FIRSTCONTACT_SANITIZED && sets.size() > 2) {
    sets = {sets.front(), sets.back()};
  }
  return sets;
}

inline std::string instruction_set_name(const testing::TestParamInfo<std::int64_t>& set) {
  return hwy::TargetName(set.param);
}

}  // namespace firstcontact::test
