// Computes the answers of the oracle that the tests compare the library with.
//
// usage: make_truth FOLDER COUNT ROBOT_COUNT [THREADS]
//
// tests/data holds the output of `make_truth tests/data 1100 460 2` (about 20 minutes on two
// cores). Answers the first COUNT cases of every family of bodies into FOLDER/truth/FAMILY.truth,
// the first ROBOT_COUNT of every family of robots into FOLDER/truth/robots/FAMILY.truth. What a
// file holds already is kept, so that the command can be stopped and started again.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <thread>
#include <vector>

#include "support/truth_file.h"

namespace {

using namespace firstcontact::oracle;

template <class AnyFamily>
void answer_family(const std::filesystem::path& folder, AnyFamily family, std::size_t count) {
  const std::filesystem::path path = truth_path(folder, family);
  std::size_t gave_up = 0;
  std::vector<StoredTruth> fresh;
  for (std::size_t i = read_truth(path).size(); i < count; ++i) {
    fresh.push_back(find_truth(generate(family, i)));
    if (fresh.back().kind == TruthKind::gave_up) {
      ++gave_up;
    }
    if (fresh.size() == 50 || i + 1 == count) {
      append_truth(path, fresh);
      fresh.clear();
    }
  }
  std::printf("%-18s %zu cases, gave up on %zu of those computed now\n", name(family).c_str(),
              count, gave_up);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: make_truth FOLDER COUNT ROBOT_COUNT [THREADS]\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const auto count = static_cast<std::size_t>(std::strtoul(argv[2], nullptr, 10));
  const auto robot_count = static_cast<std::size_t>(std::strtoul(argv[3], nullptr, 10));
  const int threads = argc > 4 ? std::atoi(argv[4]) : 1;
  std::atomic<int> next = 0;
  std::atomic<bool> failed = false;
  const auto work = [&] {
    try {
      for (int f = next++; f < kFamilyCount + kRobotFamilyCount; f = next++) {
        if (f < kFamilyCount) {
          answer_family(folder, static_cast<Family>(f), count);
        } else {
          answer_family(folder, static_cast<RobotFamily>(f - kFamilyCount), robot_count);
        }
      }
    } catch (const std::exception& error) {
      std::fprintf(stderr, "make_truth: %s\n", error.what());
      failed = true;
    }
  };
  std::vector<std::thread> pool;
  for (int i = 0; i < std::max(threads, 1); ++i) {
    pool.emplace_back(work);
  }
  for (std::thread& thread : pool) {
    thread.join();
  }
  return failed ? 1 : 0;
}
