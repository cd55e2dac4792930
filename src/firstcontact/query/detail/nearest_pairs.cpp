#include <firstcontact/query/detail/nearest_pairs.h>

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

#include <Eigen/Geometry>

#include <firstcontact/query/detail/facing_cell.h>

namespace firstcontact::detail {
namespace {

/// The nearest pairs of one neighbourhood, by distance, then by their order in the list.
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

/// The nearest pairs of each neighbourhood.
class NearestOfPlaces {
 public:
  explicit NearestOfPlaces(double edge) : edge_(edge) {}

  void add(const ClosestFeatures& closest, std::size_t pair) {
    nearest_[facing_cell(closest.p_A, closest.p_B - closest.p_A, edge_)].add(
        {closest.distance, pair});
  }

  /// The places of the kept pairs, in order.
  [[nodiscard]] std::vector<std::size_t> kept() const {
    std::vector<std::size_t> kept;
    for (const auto& [place, of_place] : nearest_) {
      for (const Nearest::Entry& entry : of_place.entries) {
        if (entry.distance < std::numeric_limits<double>::infinity()) {
          kept.push_back(entry.pair);
        }
      }
    }
    std::ranges::sort(kept);
    return kept;
  }

 private:
  double edge_;
  std::unordered_map<FacingCell, Nearest, CellHash> nearest_;
};

template <class Pair>
void keep(const std::vector<std::size_t>& kept, std::vector<Pair>& pairs) {
  for (std::size_t k = 0; k < kept.size(); ++k) {
    pairs[k] = pairs[kept[k]];  // kept[k] is not before k.
  }
  pairs.resize(kept.size());
}

}  // namespace

void keep_nearest(const ContactFrame& frame, const RelativeState& state, double reach, double edge,
                  std::vector<IndexPair>& pairs) {
  NearestOfPlaces nearest(edge);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const TrianglePair triangles = frame.pair.place(state, pairs[k].a, pairs[k].b);
    const ClosestFeatures closest = triangle_distance(triangles.A, triangles.B);
    if (closest.distance <= reach) {
      nearest.add(closest, k);
    }
  }
  keep(nearest.kept(), pairs);
}

void keep_nearest(double edge, std::vector<NearTriangles>& pairs) {
  NearestOfPlaces nearest(edge);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    nearest.add(pairs[k].closest, k);
  }
  keep(nearest.kept(), pairs);
}

}  // namespace firstcontact::detail
