/// @file
/// Lists contacts in a contact set.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/contact_coordinates.h>
#include <firstcontact/haptics/detail/contact_reduction.h>

namespace firstcontact::detail {

/// Lists contacts in a set: all; or where these are too many, those of projections; or of these a
/// reduced number (reduce_contacts()).
///
/// @param projected  the touches that projections take
/// @param listed     takes the touches that are listed, in the order of the set
void list_contacts(const std::vector<HapticTouch>& touches, const ReducedContacts& projected,
                   const ToolFrames& frames, std::size_t tools, const ContactLoopOptions& options,
                   HapticContactSet& set, std::vector<HapticTouch>& listed);

}  // namespace firstcontact::detail
