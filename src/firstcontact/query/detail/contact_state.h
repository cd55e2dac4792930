/// @file
/// The features that are close at one instant.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Makes a contact from the closest features of two triangles (indices in the hierarchies' order).
[[nodiscard]] Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                                   std::uint32_t triangle_A, std::uint32_t triangle_B,
                                   const ClosestFeatures& closest);

/// Appends the feature pairs within `band` [m] (radii included), sorted, each once; returns their
/// number.
///
/// They are those of the pairs of triangles that the last search opened: all of them, or `most`
/// pairs that ContactSelection chooses.
ContactCount collect_contacts_of(const ContactFrame& frame, double band, std::size_t most,
                                 WorkspaceData& workspace, std::vector<Contact>& contacts);

/// Appends the feature pairs of all triangles likewise.
ContactCount collect_contacts(const ContactFrame& frame, double band, std::size_t most,
                              WorkspaceData& workspace, std::vector<Contact>& contacts);

/// Appends all feature pairs of two rigid triangle meshes likewise, from their front where there is
/// one.
void collect_contacts_by_front(const ContactFrame& frame, double band, BoxFront& front,
                               WorkspaceData& workspace, std::vector<Contact>& contacts);

}  // namespace firstcontact::detail
