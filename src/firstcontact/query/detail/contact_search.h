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
  double t_upper = 0.0;    ///< The time of a contact; later than t only with `early`.
  bool contact = false;    ///< Whether some pair is within the band at t_upper.
  bool finished = false;   ///< Whether the whole piece is proven free.
  bool impatient = false;  ///< Whether the work that one search may take was spent, with neither of
                           ///< the two.
  /// Whether WorkspaceData::opened_pairs holds every pair of triangles within the band at t.
  bool all_remembered = false;
  /// [m]  Tolerance above the threshold at t for a contact that double-doubles confirmed; else 0.
  double precise_tolerance = 0.0;
  UndecidedReason reason = UndecidedReason::none;
  std::uint32_t triangle_A = 0;  ///< The pair that decided, in the hierarchies' order.
  std::uint32_t triangle_B = 0;
};

struct SearchLimits {
  double threshold = 0.0;  ///< [m]  Closer than this is contact; radii of the shapes are included.
  double tolerance = 0.0;  ///< [m]
  /// [m]  Greatest distance of reported contacts; at least threshold + tolerance, up to rounding.
  ///
  /// It is greater where a pair is held to less than the margin.
  double band = 0.0;
  /// [m]  The tolerance that was asked for; below `tolerance` where doubles cannot resolve it.
  ///
  /// Then, and where doubles come no further, corners that move on lines are tested again in
  /// double-double.
  double asked = 0.0;
  double early = 0.0;  ///< [-]  The most by which a contact may be later than the end of the proven
                       ///< time.
  const CornerLines* lines = nullptr;  ///< The lines of the corners, if there are any.
  const WorkBudget& budget;
  std::uint64_t patience = std::numeric_limits<std::uint64_t>::max();  ///< Work of one search.
  const Shape* A = nullptr;  ///< Shape of the pair, where screw sliding may be tried.
  const Shape* B = nullptr;
  const BoxFront* front = nullptr;  ///< Front of the pair, if there is one: the search begins
                                    ///< there.
};

/// Searches [t_begin, t_end] of a piece for the first contact.
///
/// At all times exactly one entry of the queue stands for each pair of triangles. A pair that is
/// proven free for as long as the search looks ahead needs none. The entry is the pair itself or a
/// pair of boxes around it. Its key is proven to be no later than the pair's first contact. So the
/// least key is never later than the first contact of the shapes. Keys of nearly tied pairs are
/// lowered a little with each level of the hierarchies, so that ties are searched depth-first.
///
/// Where surfaces slide on a screw, very many pairs are near each other. The screw sliding proves
/// most of them apart (screw_sliding_cover.h), window by window.
PieceResult search_piece(const MovingPair& pair, double t_begin, double t_end,
                         const SearchLimits& limits, WorkspaceData& workspace, WorkCount& work);

}  // namespace firstcontact::detail
