/// @file
/// Stored answers of the oracle: one file for each family of generated cases.

#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "support/first_contact_oracle.h"
#include "support/generated_case.h"
#include "support/generated_robot_case.h"

namespace firstcontact::oracle {

/// Answer to one generated case; a changed `digest` shows that the case is no longer the same.
struct StoredTruth {
  std::uint32_t digest = 0;
  TruthKind kind = TruthKind::gave_up;
  double lo = 0.0;
  double hi = 1.0;
};

/// Returns the path of a family's answers, below the folder of test data.
std::filesystem::path truth_path(const std::filesystem::path& data, Family family);
std::filesystem::path truth_path(const std::filesystem::path& data, RobotFamily family);

/// Reads the answers to the cases 0, 1, 2, ... in a file; none where the file does not exist.
std::vector<StoredTruth> read_truth(const std::filesystem::path& path);

/// Appends answers to the file.
void append_truth(const std::filesystem::path& path, const std::vector<StoredTruth>& truth);

/// Computes the answer of the oracle.
StoredTruth find_truth(const GeneratedCase& c);
StoredTruth find_truth(const RobotCase& c);

}  // namespace firstcontact::oracle
