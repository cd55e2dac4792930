/// @file
/// First contact of two convex sets over a part of a piece, within a budget.

#pragma once

#include <firstcontact/narrowphase/convex_pair.h>
#include <firstcontact/query/detail/contact_search.h>

namespace firstcontact::detail {

/// Searches [t_begin, t_end] as search_piece() does, without boxes.
///
/// @param cores  of two convex sets; `limits` include their radii
PieceResult search_convex_pair(const ConvexPair& cores, double t_begin, double t_end,
                               const SearchLimits& limits, WorkCount& work);

}  // namespace firstcontact::detail
