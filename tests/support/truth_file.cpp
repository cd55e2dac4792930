#include "support/truth_file.h"

#include <array>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "support/robot_contact_oracle.h"

namespace firstcontact::oracle {
namespace {

// digest, kind, lo, hi; little-endian, without gaps.
constexpr std::size_t kRecord = 4 + 1 + 8 + 8;
using Record = std::array<char, kRecord>;

}  // namespace

std::filesystem::path truth_path(const std::filesystem::path& data, Family family) {
  return data / "truth" / (name(family) + ".truth");
}

std::filesystem::path truth_path(const std::filesystem::path& data, RobotFamily family) {
  return data / "truth" / "robots" / (name(family) + ".truth");
}

std::vector<StoredTruth> read_truth(const std::filesystem::path& path) {
  std::vector<StoredTruth> result;
  std::ifstream file(path, std::ios::binary);
  for (Record r; file.read(r.data(), kRecord);) {
    StoredTruth truth;
    std::memcpy(&truth.digest, &r[0], 4);
    truth.kind = static_cast<TruthKind>(r[4]);
    std::memcpy(&truth.lo, &r[5], 8);
    std::memcpy(&truth.hi, &r[13], 8);
    result.push_back(truth);
  }
  return result;
}

void append_truth(const std::filesystem::path& path, const std::vector<StoredTruth>& truth) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary | std::ios::app);
  for (const StoredTruth& t : truth) {
    Record r;
    std::memcpy(&r[0], &t.digest, 4);
    r[4] = static_cast<char>(t.kind);
    std::memcpy(&r[5], &t.lo, 8);
    std::memcpy(&r[13], &t.hi, 8);
    file.write(r.data(), kRecord);
  }
  file.flush();
  if (!file) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

StoredTruth find_truth(const GeneratedCase& c) {
  const Truth truth = FirstContactOracle(c.A, c.B, c.margin).first_contact();
  return {digest(c), truth.kind, truth.lo, truth.hi};
}

StoredTruth find_truth(const RobotCase& c) {
  const Truth truth = RobotContactOracle(c).first_contact();
  return {digest(c), truth.kind, truth.lo, truth.hi};
}

}  // namespace firstcontact::oracle
