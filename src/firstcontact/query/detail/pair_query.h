/// @file
/// First contact of two shapes in a part of the step.

#pragma once

#include <limits>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact::detail {

/// Refuses options outside their ranges.
///
/// @throws std::invalid_argument if an option is outside its documented range
void validate(const FirstContactOptions& options);

/// Finds the first contact in a window, as first_contact() does over the whole step.
///
/// When free, `t` is the window's end.
void first_contact_within(const MovingShape& A, const MovingShape& B, const TimeWindow& window,
                          Workspace& workspace, const FirstContactOptions& options,
                          FirstContactResult& result);

/// The distance of two shapes when their test begins.
struct StartGap {
  double apart = std::numeric_limits<double>::infinity();  ///< [m]  Infinite: beyond the band.
  double error = 0.0;                                      ///< [m]  Error of gaps at the start.
  UndecidedReason stopped = UndecidedReason::none;  ///< The limit of the budget that ended the
                                                    ///< search; then nothing is known.
};

/// The gap of two shapes at t, as far as keep_half() needs it.
[[nodiscard]] StartGap start_gap(const ShapePair& pair, double t, Workspace& workspace,
                                 const FirstContactOptions& options, WorkCount& work);

/// The gap of two pairs of shapes together.
[[nodiscard]] StartGap nearer(const StartGap& one, const StartGap& other);

/// The distance to which two shapes are held.
struct Hold {
  double distance = 0.0;  ///< [m]  The shapes are proven to be farther apart before the first
                          ///< contact.
  /// [m]  A contact is no farther than both together, nor than margin + tolerance.
  double tolerance = std::numeric_limits<double>::infinity();
  UndecidedReason stopped = UndecidedReason::none;  ///< The limit of the budget that ended the
                                                    ///< search; then nothing is claimed.
};

/// The hold of StartContacts::keep_half.
///
/// Two shapes that start within the band, but apart, are held to half of their start distance d0.
/// They are in contact at 3/4 of it at most. So they are not in contact at the start, nor for as
/// long as they stay as far apart. Other shapes are held to the margin.
///
/// Derivation: the nearest points that are found are at least d0 apart up to rounding, which 16
/// errors outweigh. They are at most d0 / (1 - kSlack) apart. A half and a quarter of that is less
/// than d0. The same holds for the least of several d0, with the greatest of their errors.
[[nodiscard]] Hold keep_half(const StartGap& start, double margin);

/// Finds the first contact of a pair that is held to a distance in place of the margin.
void first_contact_held(const ShapePair& pair, const TimeWindow& window, const Hold& hold,
                        Workspace& workspace, const FirstContactOptions& options,
                        FirstContactResult& result);

/// Finds the first contact of a pair, with `t` earlier than the contact by at most `early` [-].
///
/// `t_upper` is the time of the contact. No contacts are listed.
void first_contact_early(const ShapePair& pair, const TimeWindow& window, double early,
                         Workspace& workspace, const FirstContactOptions& options,
                         FirstContactResult& result);

}  // namespace firstcontact::detail
