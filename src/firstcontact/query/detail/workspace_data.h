/// @file
/// What a workspace holds.

#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <firstcontact/query/detail/moving_pair.h>

namespace firstcontact::detail {

/// A pair of boxes, or of triangles, that still may come into contact.
struct SearchEntry {
  double key = 0.0;             ///< [-]  No contact of the pair before this time is proven.
  double priority = 0.0;        ///< [-]  At most the key; the order of the search.
  double threshold = 0.0;       ///< [m]  Closer than this is contact.
  double held_tolerance = 0.0;  ///< [m]  Positive: held to half its start distance, to this.
  BoxId a;
  BoxId b;
  bool far = false;            ///< Was well apart at its last bound: bound again before opening.
  bool start_checked = false;  ///< The threshold accounts for the start distance.
};

struct WorkspaceData {
  std::vector<SearchEntry> queue;
  std::vector<std::pair<BoxId, BoxId>> stack;
  std::vector<std::pair<double, std::pair<BoxId, BoxId>>> nearest;
};

}  // namespace firstcontact::detail
