/// @file
/// First contact of two shapes in a part of the step.

#pragma once

#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// A part of the step, both ends included; before it the shapes are proven free.
struct Window {
  double begin = 0.0;
  double end = 1.0;
};

/// @throws std::invalid_argument if an option is outside its documented range
void validate(const FirstContactOptions& options);

/// As first_contact(), which asks for the whole step; when free, `t` is the window's end.
void first_contact_within(const MovingShape& A, const MovingShape& B, const Window& window,
                          Workspace& workspace, const FirstContactOptions& options,
                          FirstContactResult& result);

}  // namespace firstcontact::detail
