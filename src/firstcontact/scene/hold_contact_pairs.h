/// @file
/// Gives contact pairs of a planned path the distances that they are held to.

#pragma once

#include <span>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// Gives each contact pair its distance in place of its margin and paddings, along the whole path.
///
/// A scene adds paddings to every margin. So the padding of a link in a contact pair is taken into
/// the margins of the link's other pairs, which stay what they were but for rounding. The tolerance
/// of the scene becomes small beside the distances.
///
/// @throws std::invalid_argument  names a pair that the scene does not have
FIRSTCONTACT_API void hold_contact_pairs(std::span<const NamedContactPair> pairs, Scene& scene);

}  // namespace firstcontact
