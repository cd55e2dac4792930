/// @file
/// Contacts as people read them.

#pragma once

#include <string>

#include <firstcontact/query/contact.h>

namespace firstcontact::app {

/// "triangle 7", "edge 12 of triangle 7"
[[nodiscard]] std::string feature_text(const Feature& feature);

/// "at (1, 2, 3) m, distance 35.3 nm, normal ( 1.000,  0.000,  0.000), closing at 60 m/s"
///
/// @param duration  [s]  of the step
[[nodiscard]] std::string contact_text(const Contact& contact, double duration);

}  // namespace firstcontact::app
