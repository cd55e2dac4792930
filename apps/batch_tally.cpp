#include "batch_tally.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "quantity_text.h"

namespace firstcontact::app {
namespace {

/// A duration as text: "40 s", "2 min 40 s", "3 h 2 min".
std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) {
    return fmt::format("{} s", whole);
  }
  if (whole < 3600) {
    return fmt::format("{} min {} s", whole / 60, whole % 60);
  }
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

void BatchTally::keep(std::optional<Verdict> verdict) {
  add(verdict);
  ++kept_;
}

void BatchTally::add(std::optional<Verdict> verdict) {
  ++done_;
  status_ = worse(status_, verdict ? status_of(*verdict) : ExitStatus::bad_input);
  errors_ += verdict ? 0 : 1;
  free_ += verdict == Verdict::free ? 1 : 0;
  contact_ += verdict == Verdict::contact ? 1 : 0;
  contact_at_start_ += verdict == Verdict::contact_at_start ? 1 : 0;
  undecided_ += verdict == Verdict::undecided ? 1 : 0;
}

ExitStatus BatchTally::status() const {
  return complete() ? status_ : worse(status_, ExitStatus::undecided);
}

double BatchTally::rate(double seconds) const {
  return static_cast<double>(done_ - kept_) / std::max(seconds, 1e-9);
}

std::string BatchTally::progress(double seconds) const {
  constexpr std::size_t kWidth = 20;
  const std::size_t percent = total_ > 0 ? 100 * done_ / total_ : 100;
  std::string text =
      fmt::format("[{:<{}}] {:3} %  {} of {}", std::string(percent * kWidth / 100, '='), kWidth,
                  percent, done_, total_);
  if (done_ > kept_) {
    const double left = static_cast<double>(total_ - done_) / rate(seconds);
    text += fmt::format(", {} a second, {} left", plain_number(rate(seconds)), duration_text(left));
  }
  return text;
}

std::string BatchTally::summary(double seconds) const {
  std::string text = fmt::format("{} of {} scenes answered", done_, total_);
  const char* separator = ": ";
  const auto some = [&](std::size_t count, const char* what) {
    if (count > 0) {
      text += fmt::format("{}{} {}", separator, count, what);
      separator = ", ";
    }
  };
  some(free_, "free");
  some(contact_, "contact");
  some(contact_at_start_, "contact at start");
  some(undecided_, "undecided");
  some(errors_, errors_ == 1 ? "error" : "errors");
  if (kept_ > 0) {
    text += fmt::format("\n{} of them by an earlier run", kept_);
  }
  if (done_ > kept_) {
    text += fmt::format("\n{} in {}, {} a second", done_ - kept_, duration_text(seconds),
                        plain_number(rate(seconds)));
  }
  if (!complete()) {
    text += "\ninterrupted; go on with --resume";
  }
  return text + "\n";
}

}  // namespace firstcontact::app
