/// @file
/// The progress of a batch, and its results.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "exit_status.h"

namespace firstcontact::app {

class BatchTally {
 public:
  /// @param total  number of scenes
  explicit BatchTally(std::size_t total) : total_(total) {}

  /// Counts an answer of an earlier run; none stands for an error.
  void keep(std::optional<Verdict> verdict);
  void add(std::optional<Verdict> verdict);

  [[nodiscard]] std::size_t kept() const { return kept_; }
  [[nodiscard]] bool complete() const { return done_ == total_; }

  /// The worst status of all answers; undecided where some are missing.
  [[nodiscard]] ExitStatus status() const;

  /// The progress as text: "[=====     ]  50 %  500 of 1000, 12.5 a second, 40 s left".
  [[nodiscard]] std::string progress(double seconds) const;

  /// The lines for the end of the batch.
  [[nodiscard]] std::string summary(double seconds) const;

 private:
  /// [1/s]  Rate of this run.
  [[nodiscard]] double rate(double seconds) const;

  std::size_t total_;
  std::size_t kept_ = 0;
  std::size_t done_ = 0;  // Number of answers, the kept ones included.
  std::size_t free_ = 0;
  std::size_t contact_ = 0;
  std::size_t contact_at_start_ = 0;
  std::size_t undecided_ = 0;
  std::size_t errors_ = 0;
  ExitStatus status_ = kSuccess;
};

}  // namespace firstcontact::app
