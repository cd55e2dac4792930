/// @file
/// Contacts as people read them.

#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include <firstcontact/query/contact.h>

namespace firstcontact::app {

/// A point as text: "(1, 2, 3)".
[[nodiscard]] std::string point_text(const Eigen::Vector3d& point);

/// A feature as text: "triangle 7", "edge 12 of triangle 7".
[[nodiscard]] std::string feature_text(const Feature& feature);

/// A contact as text: "at (1, 2, 3) m, distance 35.3 nm, normal ( 1.000,  0.000,  0.000), closing
/// at 60 m/s".
///
/// @param duration  [s]  of the step
[[nodiscard]] std::string contact_text(const Contact& contact, double duration);

/// A count as text: "7 feature pairs", "1000 of 180045 feature pairs", "1000 of more than 262144
/// feature pairs".
///
/// @param listed  number of listed pairs
[[nodiscard]] std::string contact_count_text(const ContactCount& count, std::size_t listed);

}  // namespace firstcontact::app
