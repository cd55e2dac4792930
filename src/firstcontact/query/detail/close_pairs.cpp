#include <firstcontact/query/detail/close_pairs.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/query/detail/close_list.h>
#include <firstcontact/query/detail/nearest_pairs.h>
#include <firstcontact/query/detail/screw_sliding_cover.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

Vector3d face_normal(const Triangle& T) { return (T[1] - T[0]).cross(T[2] - T[0]); }

/// Whether two triangles are farther apart than `reach` along n, of any length.
bool apart_along(const Vector3d& n, const TrianglePair& pair, double reach) {
  const Vector3d a(n.dot(pair.A[0]), n.dot(pair.A[1]), n.dot(pair.A[2]));
  const Vector3d b(n.dot(pair.B[0]), n.dot(pair.B[1]), n.dot(pair.B[2]));
  const double gap = std::max(b.minCoeff() - a.maxCoeff(), a.minCoeff() - b.maxCoeff());
  return gap > 0.0 && gap * gap > reach * reach * n.squaredNorm();
}

/// Whether a pair is apart along a direction, as most pairs of opened triangles are, by much more
/// than rounding.
bool clearly_apart(const TrianglePair& pair, double reach) {
  constexpr double kClearly = 1.0 + 0x1p-20;
  const Vector3d between =
      (pair.B[0] + pair.B[1] + pair.B[2]) - (pair.A[0] + pair.A[1] + pair.A[2]);
  return apart_along(face_normal(pair.A), pair, kClearly * reach) ||
         apart_along(face_normal(pair.B), pair, kClearly * reach) ||
         apart_along(between, pair, kClearly * reach);
}

/// Number of opened pairs of boxes, or of tested triangles, before the search tries screw sliding.
/// And the most pairs of triangles that screw sliding may leave.
constexpr std::size_t kManyOpened = 1000;
constexpr std::size_t kMostClose = 100'000;

/// More pairs of triangles than these are very many.
constexpr std::size_t kVeryMany = 1000;

/// The features of each of two triangles that are asked for.
struct AskedFeatures {
  unsigned of_A = 0x3f;
  unsigned of_B = 0x3f;
};

/// The greatest distance of features.
struct CloseBand {
  double band = 0.0;   ///< [m]
  double error = 0.0;  ///< [m]  Bound of the error of positions.

  [[nodiscard]] double reach() const { return band + error; }

  /// The band where pairs that are farther than `needed` may be left out.
  [[nodiscard]] CloseBand within(double needed) const { return {std::min(band, needed), error}; }
};

/// Calls use(pair) for each pair of features of two triangles.
template <class Use>
void for_each_close(const ContactFrame& frame, const TrianglePair& triangles, const IndexPair& at,
                    const AskedFeatures& asked, const CloseBand& band, const Use& use) {
  if (clearly_apart(triangles, band.reach())) {
    return;
  }
  const FeaturePairs close =
      feature_pairs_within(triangles.A, triangles.B, band.band, asked.of_A, asked.of_B);
  for (std::size_t k = 0; k < close.count; ++k) {
    use(close_pair(frame, at.a, at.b, close.pairs[k]));
  }
}

/// Lists the close pairs of surfaces that slide on a screw. Begins the list anew.
///
/// Most pairs of boxes of such surfaces are near each other, as boxes of curved patches are thicker
/// than the gap. It returns false where the surfaces do not slide on a screw.
bool find_close_by_screw_sliding(const ContactFrame& frame, const RelativeState& state,
                                 const CloseBand& band, WorkspaceData& workspace, CloseList& list) {
  const MovingPair& pair = frame.pair;
  const std::optional<ScrewSlidingCover> cover =
      ScrewSlidingCover::of(pair, frame.A, frame.B, frame.t);
  if (!cover || !cover->find(frame.t, band.reach(), kMostClose, workspace)) {
    return false;
  }
  std::vector<IndexPair>& left = workspace.left_by_screw_sliding;
  const bool are_chosen = frame.beside > 0.0 && left.size() > kVeryMany;
  if (are_chosen) {
    keep_nearest(frame, state, band.reach(), frame.beside, left);
  }
  const auto own_A = frame.A.own_features();
  const auto own_B = frame.B.own_features();
  list.clear();
  for (const IndexPair& at : left) {
    // A feature counts once where all pairs of triangles are tested.
    const AskedFeatures asked =
        are_chosen ? AskedFeatures{} : AskedFeatures{own_A[at.a], own_B[at.b]};
    if (asked.of_A != 0 || asked.of_B != 0) {
      for_each_close(frame, pair.place(state, at.a, at.b), at, asked, band.within(list.reach()),
                     [&](const ClosePair& close) { list.add(close); });
    }
  }
  return true;
}

}  // namespace

Feature global_feature(const Shape& shape, std::uint32_t triangle, const TriangleFeature& local) {
  const std::uint32_t index = shape.hierarchy().triangle_index[triangle];
  const auto& corners = shape.mesh().triangles[index];
  switch (local.type) {
    case TriangleFeature::Type::vertex:
      return {FeatureType::vertex, corners[local.index], index};
    case TriangleFeature::Type::edge:
      return {FeatureType::edge,
              shape.edge_index(corners[local.index], corners[(local.index + 1) % 3]), index};
    case TriangleFeature::Type::face:
      break;
  }
  return {FeatureType::face, index, index};
}

ClosePair close_pair(const ContactFrame& frame, std::uint32_t triangle_A, std::uint32_t triangle_B,
                     const ClosestFeatures& closest) {
  return {global_feature(frame.A, triangle_A, closest.feature_A),
          global_feature(frame.B, triangle_B, closest.feature_B), triangle_A, triangle_B, closest};
}

void find_close_among_opened(const ContactFrame& frame, const RelativeState& state, double band,
                             WorkspaceData& workspace) {
  workspace.close_pairs.clear();
  const CloseBand close{band, 2.0 * frame.pair.gap_error(state)};
  for (const OpenedPair& pair : workspace.opened_pairs) {
    const double travel = frame.pair.speed_bound() * std::abs(frame.t - pair.t);
    if (pair.distance - travel <= close.reach()) {
      for_each_close(frame, frame.pair.place(state, pair.a, pair.b), {pair.a, pair.b}, {}, close,
                     [&](const ClosePair& found) { workspace.close_pairs.push_back(found); });
    }
  }
}

std::optional<ContactCount> find_close(const ContactFrame& frame, const RelativeState& state,
                                       double band, std::size_t most, WorkspaceData& workspace) {
  const MovingPair& pair = frame.pair;
  const CloseBand all{band, pair.gap_error(state)};
  CloseList list(workspace.close_pairs, most);
  const BoxesAtInstant boxes(pair, state);
  const auto own_A = frame.A.own_features();
  const auto own_B = frame.B.own_features();
  auto& stack = workspace.stack;
  stack.assign(1, {false, 0, 0, root(pair.A()), root(pair.B())});
  std::size_t opened = 0;
  while (!stack.empty()) {
    if (++opened == kManyOpened &&
        find_close_by_screw_sliding(frame, state, all, workspace, list)) {
      break;
    }
    const CloseBand close = all.within(list.reach());
    const BoxPair top = stack.back();
    stack.pop_back();
    if (top.is_triangle_pair) {
      const AskedFeatures own{own_A[top.triangle_A], own_B[top.triangle_B]};
      if (own.of_A != 0 || own.of_B != 0) {
        for_each_close(frame, pair.place(state, top.triangle_A, top.triangle_B),
                       {top.triangle_A, top.triangle_B}, own, close,
                       [&](const ClosePair& found) { list.add(found); });
      }
      continue;
    }
    boxes.open(top.A, top.B, [&](const BoxesAtInstant::Lane& lane) {
      if (!(lane.gap() > close.reach())) {
        stack.push_back(lane.inside());
      }
    });
  }
  return list.finish();
}

}  // namespace firstcontact::detail
