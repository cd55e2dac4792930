/// @file
/// The status that the tool returns to the shell.

#pragma once

#include <firstcontact/query/first_contact.h>

namespace firstcontact::app {

/// The exit status; its values are those of the shell.
enum class ExitStatus { free = 0, contact = 1, bad_input = 2, undecided = 3 };

inline constexpr ExitStatus kSuccess = ExitStatus::free;

[[nodiscard]] inline ExitStatus status_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::free:
      return ExitStatus::free;
    case Verdict::contact:
    case Verdict::contact_at_start:
      return ExitStatus::contact;
    case Verdict::undecided:
      break;
  }
  return ExitStatus::undecided;
}

/// The worse status, in the order bad input, undecided, contact, free.
[[nodiscard]] inline ExitStatus worse(ExitStatus a, ExitStatus b) {
  const auto badness = [](ExitStatus status) {
    return status == ExitStatus::bad_input ? 4 : static_cast<int>(status);
  };
  return badness(a) < badness(b) ? b : a;
}

}  // namespace firstcontact::app
