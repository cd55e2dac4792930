/// @file
/// The best-first search for the first contact over one piece of two motions.

#pragma once

#include <cstdint>
#include <limits>

#include <firstcontact/moving_pairs/detail/box_front.h>
#include <firstcontact/query/detail/corner_lines.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// The result of the search of one piece.
struct PieceResult {
  double t = 0.0;          ///< Proven: no contact of the piece before t.
  double t_upper = 0.0;    ///< With a contact: when that is; later than t only with `early`.
  bool contact = false;    ///< At t_upper some pair is within the band.
  bool finished = false;   ///< Neither: the whole piece is proven free.
  bool impatient = false;  ///< Neither: the work that one search may take was spent.
  /// WorkspaceData::opened_pairs holds every pair of triangles within the band at t.
  bool all_remembered = false;
  /// [m]  Above the threshold, at t: of a contact that was asked again in double-double; else 0.
  double precise_tolerance = 0.0;
  UndecidedReason reason = UndecidedReason::none;
  std::uint32_t triangle_A = 0;  ///< The pair that decided, in the hierarchies' order.
  std::uint32_t triangle_B = 0;
};

struct SearchLimits {
  double threshold = 0.0;  ///< [m]  Closer than this is contact; radii of the shapes included.
  double tolerance = 0.0;  ///< [m]
  /// [m]  At most so far apart are contacts that may be reported; at least threshold + tolerance
  /// but for rounding. Greater where a pair is held to less than the margin.
  double band = 0.0;
  /// [m]  What was asked: below `tolerance` where doubles cannot tell. Then, and where doubles come
  /// no further, corners that move on lines are asked again in double-double.
  double asked = 0.0;
  double early = 0.0;  ///< [-]  By so much a contact may be later than what is proven free.
  const CornerLines* lines = nullptr;  ///< If there are any.
  const WorkBudget& budget;
  std::uint64_t patience = std::numeric_limits<std::uint64_t>::max();  ///< Work of one search.
  const Shape* A =
      nullptr;  ///< Of the pair, where it may be asked whether one slides on its screw.
  const Shape* B = nullptr;
  const BoxFront* front = nullptr;  ///< Of the pair, if there is one: the search begins there.
};

/// Searches [t_begin, t_end].
///
/// Every pair of triangles is at all times represented by exactly one entry of the queue, unless it
/// is proven free for as long as the search looks ahead: itself or a pair of boxes around it, whose
/// key is proven to be no later than the pair's first contact. The least key is hence never later
/// than the first contact of the shapes. Keys of nearly tied pairs are lowered a little with each
/// level of the hierarchies, so that ties are searched depth-first.
///
/// Where very many pairs are near each other as surfaces screw_sliding, most are proven apart by
/// that (screw_sliding_cover.h), window by window.
PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work);

}  // namespace firstcontact::detail
