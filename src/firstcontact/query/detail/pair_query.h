/// @file
/// First contact of two shapes in a part of the step.

#pragma once

#include <limits>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact::detail {

/// @throws std::invalid_argument if an option is outside its documented range
void validate(const FirstContactOptions& options);

/// Finds the first contact in a window, as first_contact() does over the whole step.
///
/// When free, `t` is the window's end.
void first_contact_within(const MovingShape& A, const MovingShape& B, const TimeWindow& window,
                          Workspace& workspace, const FirstContactOptions& options,
                          FirstContactResult& result);

/// How far apart two shapes are when they begin to be tested.
struct StartGap {
  double apart = std::numeric_limits<double>::infinity();  ///< [m]  Infinite: beyond the band.
  double error = 0.0;                                      ///< [m]  Of gaps at the start.
  UndecidedReason stopped = UndecidedReason::none;  ///< By the budget; then nothing is known.
};

/// The gap of two shapes at t, as far as keep_half has to know it.
[[nodiscard]] StartGap start_gap(const ShapePair& pair, double t, Workspace& workspace,
                                 const FirstContactOptions& options, WorkCount& work);

/// That of two pairs of shapes together.
[[nodiscard]] StartGap nearer(const StartGap& one, const StartGap& other);

/// How near two shapes may come.
struct Hold {
  double distance = 0.0;  ///< [m]  They are proven to be farther apart before the first contact.
  /// [m]  A contact is no farther than both together, nor than margin + tolerance.
  double tolerance = std::numeric_limits<double>::infinity();
  UndecidedReason stopped = UndecidedReason::none;  ///< By the budget; then nothing is claimed.
};

/// The hold of StartContacts::keep_half.
///
/// Two shapes that start within the band, but apart, are held to half of their start distance d0.
/// They are in contact at 3/4 of it at most. So they are not in contact at the start, nor for as
/// long as they stay as far apart. Others are held to the margin.
///
/// Derivation: the nearest points that are found are at least d0 apart but for rounding, which 16
/// errors outweigh, and at most d0 / (1 - kSlack). A half and a quarter of that is less than d0.
/// The same holds of the least of several d0, with the greatest of their errors.
[[nodiscard]] Hold keep_half(const StartGap& start, double margin);

/// As first_contact() of a pair, but held to a distance in place of the margin.
void first_contact_held(const ShapePair& pair, const TimeWindow& window, const Hold& hold,
                        Workspace& workspace, const FirstContactOptions& options,
                        FirstContactResult& result);

/// As first_contact() of a pair, but `t` may be earlier than the contact by `early` [-]; `t_upper`
/// is when that is. Lists no contacts.
void first_contact_early(const ShapePair& pair, const TimeWindow& window, double early,
                         Workspace& workspace, const FirstContactOptions& options,
                         FirstContactResult& result);

}  // namespace firstcontact::detail
