#include <firstcontact/query/detail/nearest_pairs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include <Eigen/Geometry>

#include <firstcontact/math/cell_hash.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Where a pair is: the cube of its middle, and the octant of the direction from A to B.
using Neighbourhood = std::array<std::int64_t, 4>;

/// The nearest pairs of one neighbourhood, by distance, then by where they were in the list.
struct Nearest {
  struct Entry {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t pair = 0;
  };
  std::array<Entry, 3> entries;

  void add(Entry entry) {
    for (Entry& kept : entries) {
      if (entry.distance < kept.distance) {
        std::swap(entry, kept);
      }
    }
  }
};

Neighbourhood neighbourhood(const ClosestFeatures& closest, double edge) {
  const Vector3d n = closest.p_B - closest.p_A;
  Neighbourhood place{0, 0, 0,
                      (n.x() > 0.0 ? 1 : 0) + (n.y() > 0.0 ? 2 : 0) + (n.z() > 0.0 ? 4 : 0)};
  for (int k = 0; k < 3; ++k) {
    place[static_cast<std::size_t>(k)] = cell_along(closest.p_A[k], edge);
  }
  return place;
}

}  // namespace

void keep_nearest(const ContactFrame& frame, const RelativeState& state, double reach, double edge,
                  std::vector<IndexPair>& pairs) {
  std::unordered_map<Neighbourhood, Nearest, CellHash> nearest;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const TrianglePair triangles = frame.pair.place(state, pairs[k].a, pairs[k].b);
    const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
    if (closest.distance <= reach) {
      nearest[neighbourhood(closest, edge)].add({closest.distance, k});
    }
  }
  std::vector<std::size_t> kept;
  for (const auto& [place, of_place] : nearest) {
    for (const Nearest::Entry& entry : of_place.entries) {
      if (entry.distance <= reach) {
        kept.push_back(entry.pair);
      }
    }
  }
  std::ranges::sort(kept);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    pairs[k] = pairs[kept[k]];  // Not before its own place.
  }
  pairs.resize(kept.size());
}

}  // namespace firstcontact::detail
