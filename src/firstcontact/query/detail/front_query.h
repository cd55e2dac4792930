/// @file
/// Questions about two bodies that begin at a front of their box pairs.

#pragma once

#include <vector>

#include <firstcontact/motion/time_window.h>
#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/placed_shape.h>

namespace firstcontact::detail {

/// Whether the questions below may be asked of two shapes.
///
/// The shapes are rigid triangle meshes, and have so many triangles that a front saves work.
[[nodiscard]] bool may_have_front(const Shape& A, const Shape& B);

/// Finds features as close_features() does, in the order of A and B, beginning at their front.
///
/// The front begins here where it is empty, and is refined. It stays empty where another method is
/// shorter.
void close_features_by_front(const PlacedShape& A, const PlacedShape& B, double band, double beside,
                             BoxFront& front, Workspace& workspace, std::vector<Contact>& contacts);

/// Finds the first contact as first_contact_within() does, in the order of A and B, beginning at
/// their front.
///
/// @param front   front of A and B in this order, not empty
/// @param window  when free, `t` is its end
void first_contact_by_front(const BoxFront& front, const MovingShape& A, const MovingShape& B,
                            const TimeWindow& window, Workspace& workspace,
                            const FirstContactOptions& options, FirstContactResult& result);

}  // namespace firstcontact::detail
