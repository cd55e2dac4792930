/// @file
/// The words of verdicts and options of a query, in files and in Python.

#pragma once

#include <array>

namespace firstcontact {

/// The words of Verdict, in its order.
inline constexpr std::array<const char*, 4> kVerdictWords{"free", "contact", "contact_at_start",
                                                          "undecided"};

/// The words of UndecidedReason, in its order.
inline constexpr std::array<const char*, 6> kUndecidedReasonWords{
    "none", "work", "deadline", "memory", "precision", "cancelled"};

/// The words of StartContacts, in its order.
inline constexpr std::array<const char*, 2> kStartContactsWords{"report", "keep_half"};

/// The words of ContactState::none, first and all; `nearest` is a number.
inline constexpr std::array<const char*, 3> kContactStateWords{"none", "first", "all"};

}  // namespace firstcontact
