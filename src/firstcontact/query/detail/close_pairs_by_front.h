/// @file
/// The pairs of features that are close at one instant, found from a front.

#pragma once

#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Lists all pairs of features within `band` [m] in workspace.close_pairs, as find_close() does.
///
/// Some of them are listed more than once. The search begins at the front, and refines it. Where
/// that is empty, or a new one is due, the front begins at this instant. For surfaces that slide on
/// a screw that may be long. Then the function returns false, lists nothing, and gives the front up
/// for a while.
///
/// @param state  at the instant, of rigid bodies
/// @param band   [m]  radii included
[[nodiscard]] bool find_close_by_front(const ContactFrame& frame, const RelativeState& state,
                                       double band, BoxFront& front, WorkspaceData& workspace);

}  // namespace firstcontact::detail
