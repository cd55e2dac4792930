#include <firstcontact/query/detail/screw_sliding_windows.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <firstcontact/query/detail/screw_sliding_cover.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {
namespace {

/// Most pairs of triangles that screw sliding may leave to be followed one by one; else a shorter
/// window is tried, by the second factor. Windows that are too short gain nothing.
constexpr std::size_t kMostLeftByScrewSliding = 4000;
constexpr double kShorterScrewSliding = 0.25;
constexpr double kLongerScrewSliding = 2.0;
constexpr int kScrewSlidingTrials = 7;
constexpr double kShortestScrewSliding = 0x1p-16;

constexpr std::uint32_t kNotRemembered = std::numeric_limits<std::uint32_t>::max();

}  // namespace

bool ScrewSlidingWindows::may_screw_sliding() const {
  return search_.limits.A != nullptr &&
         ScrewSlidingCover::of(search_.pair, *search_.limits.A, *search_.limits.B,
                               search_.proven_free())
             .has_value();
}

bool ScrewSlidingWindows::screw_sliding_on(double t) {
  if (search_.limits.A != nullptr && !search_.best.contact) {
    if (const auto cover =
            ScrewSlidingCover::of(search_.pair, *search_.limits.A, *search_.limits.B, t)) {
      double width = std::min(screw_sliding_width_, search_.t_last - t);
      for (int trial = 0; trial < kScrewSlidingTrials && may_end_after(t, width); ++trial) {
        search_.t_end = width < search_.t_last - t ? t + width : search_.t_last;
        if (cover->find(search_.t_end, search_.box_threshold, kMostLeftByScrewSliding,
                        search_.workspace)) {
          screw_sliding_width_ = kLongerScrewSliding * width;
          follow_left(t);
          return true;
        }
        width *= kShorterScrewSliding;
      }
    }
  }
  search_.t_end = search_.t_last;
  return false;
}

bool ScrewSlidingWindows::may_end_after(double t, double width) const {
  return width >= search_.t_last - t ||
         width >= kShortestScrewSliding * (search_.t_last - search_.t_begin);
}

void ScrewSlidingWindows::follow_left(double t) {
  search_.queue.clear();
  for (const IndexPair& left : search_.workspace.left_by_screw_sliding) {
    TriangleEntry entry;
    entry.key = t;
    entry.a = left.a;
    entry.b = left.b;
    entry.opened = kNotRemembered;
    search_.queue.push(entry);
  }
}

}  // namespace firstcontact::detail
