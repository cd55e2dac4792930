/// @file
/// First contact of two shapes in a part of the step.

#pragma once

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

}  // namespace firstcontact::detail
