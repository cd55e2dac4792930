#include <firstcontact/query/detail/glide_windows.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <firstcontact/query/detail/glide_cover.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {
namespace {

/// Pairs of triangles that gliding may leave to be followed one by one, or else a part of the time
/// is looked at; how much of it, and how often. Shorter parts of the search's time lead nowhere.
constexpr std::size_t kMostLeftByGlide = 4000;
constexpr double kShorterGlide = 0.25;
constexpr double kLongerGlide = 2.0;
constexpr int kGlideTrials = 7;
constexpr double kShortestGlide = 0x1p-16;

constexpr std::uint32_t kNotRemembered = std::numeric_limits<std::uint32_t>::max();

}  // namespace

bool GlideWindows::may_glide() const {
  return search_.limits.A != nullptr &&
         GlideCover::of(search_.pair, *search_.limits.A, *search_.limits.B, search_.proven_free())
             .has_value();
}

bool GlideWindows::glide_on(double t) {
  if (search_.limits.A != nullptr && !search_.best.contact) {
    if (const auto cover = GlideCover::of(search_.pair, *search_.limits.A, *search_.limits.B, t)) {
      double width = std::min(glide_width_, search_.t_last - t);
      for (int trial = 0; trial < kGlideTrials && may_end_after(t, width); ++trial) {
        search_.t_end = width < search_.t_last - t ? t + width : search_.t_last;
        if (cover->find(search_.t_end, search_.box_threshold, kMostLeftByGlide,
                        search_.workspace)) {
          glide_width_ = kLongerGlide * width;
          follow_left(t);
          return true;
        }
        width *= kShorterGlide;
      }
    }
  }
  search_.t_end = search_.t_last;
  return false;
}

bool GlideWindows::may_end_after(double t, double width) const {
  return width >= search_.t_last - t ||
         width >= kShortestGlide * (search_.t_last - search_.t_begin);
}

void GlideWindows::follow_left(double t) {
  search_.queue.clear();
  for (const IndexPair& left : search_.workspace.left_by_glide) {
    TriangleEntry entry;
    entry.key = t;
    entry.a = left.a;
    entry.b = left.b;
    entry.opened = kNotRemembered;
    search_.queue.push(entry);
  }
}

}  // namespace firstcontact::detail
