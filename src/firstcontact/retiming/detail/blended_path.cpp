#include <firstcontact/retiming/detail/blended_path.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {

BlendedPath::BlendedPath(const WaypointPath& path, const std::vector<Blend>& blends,
                         std::size_t first, std::size_t last)
    : path_(path) {
  double S = 0.0;
  double factor = 1.0;
  double x = 0.0;
  for (std::size_t edge = first; edge < last; ++edge) {
    const bool has_blend = edge + 1 < last;
    const Blend blend = has_blend ? blends.at(edge) : Blend{};  // About waypoint edge + 1.
    const double straight = (1.0 - blend.before - x) / factor;
    pieces_.push_back(
        {.edge = edge, .begin = S, .end = S + straight, .x_begin = x, .factor = factor});
    S += straight;
    if (has_blend) {
      const double length = 2.0 * blend.before / factor;
      pieces_.push_back({.edge = edge,
                         .begin = S,
                         .end = S + length,
                         .factor = factor,
                         .is_blend = true,
                         .before = blend.before,
                         .after = blend.after});
      S += length;
      factor *= blend.after / blend.before;
      x = blend.after;
    }
  }
}

PathPlace BlendedPath::place(const Piece& piece, double S) const {
  const std::vector<double>& a = path_.waypoints[piece.edge];
  const std::vector<double>& b = path_.waypoints[piece.edge + 1];
  const std::size_t joints = a.size();
  PathPlace place{std::vector<double>(joints), std::vector<double>(joints),
                  std::vector<double>(joints)};
  if (!piece.is_blend) {
    const double x = piece.x_begin + (S - piece.begin) * piece.factor;
    for (std::size_t j = 0; j < joints; ++j) {
      place.p[j] = a[j] + x * (b[j] - a[j]);
      place.dp[j] = piece.factor * (b[j] - a[j]);
    }
    return place;
  }
  const std::vector<double>& c = path_.waypoints[piece.edge + 2];
  const double length = piece.end - piece.begin;
  const double s = std::clamp((S - piece.begin) / length, 0.0, 1.0);
  for (std::size_t j = 0; j < joints; ++j) {
    const double in = piece.before * (b[j] - a[j]);
    const double turn = piece.after * (c[j] - b[j]) - in;
    place.p[j] = b[j] - in + 2.0 * in * s + 2.0 * turn * s * s * s * (1.0 - 0.5 * s);
    place.dp[j] = (2.0 * in + 2.0 * turn * s * s * (3.0 - 2.0 * s)) / length;
    place.ddp[j] = 12.0 * turn * s * (1.0 - s) / (length * length);
  }
  return place;
}

PathPlace BlendedPath::place(double S) const {
  const auto ends_before = [](const Piece& piece, double at) { return piece.end < at; };
  const auto found = std::lower_bound(pieces_.begin(), pieces_.end(), S, ends_before);
  return place(found == pieces_.end() ? pieces_.back() : *found, S);
}

}  // namespace firstcontact::detail
