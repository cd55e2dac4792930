/// @file
/// Gives contact pairs of a planned path their distances.

#pragma once

#include <span>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// Holds each contact pair to its distance in place of its margin and paddings, along the whole
/// path.
///
/// A scene adds paddings to every margin. So the padding of a link in a contact pair moves into the
/// margins of the link's other pairs, which keep their sums up to rounding. The tolerance of the
/// scene becomes small beside the distances.
///
/// @throws std::invalid_argument  names a pair that the scene does not have
FIRSTCONTACT_API void hold_contact_pairs(std::span<const NamedContactPair> pairs, Scene& scene);

}  // namespace firstcontact
