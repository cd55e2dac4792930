#include <firstcontact/query/detail/contact_state.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

#include <firstcontact/query/detail/box_pairs.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

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

Vector3d face_normal(const Triangle& T) { return (T[1] - T[0]).cross(T[2] - T[0]); }

Vector3d edge_vector(const Triangle& T, int edge) { return T[(edge + 1) % 3] - T[edge]; }

/// The direction that the features alone define, of any length and sign; zero where none does.
Vector3d feature_normal(const TrianglePair& pair, const ClosestFeatures& closest) {
  using Type = TriangleFeature::Type;
  if (closest.feature_A.type == Type::face) {
    return face_normal(pair.A);
  }
  if (closest.feature_B.type == Type::face) {
    return face_normal(pair.B);
  }
  if (closest.feature_A.type == Type::edge && closest.feature_B.type == Type::edge) {
    return edge_vector(pair.A, closest.feature_A.index)
        .cross(edge_vector(pair.B, closest.feature_B.index));
  }
  return Vector3d::Zero();
}

Vector3d relative_velocity(const RelativeState& state, const Vector3d& p_A, const Vector3d& p_B) {
  const Vector3d v_A = state.rate_A * state.axis_A.cross(p_A - state.p_AQa);
  const Vector3d v_B = state.rate_B * state.axis_B.cross(p_B - state.p_AQb);
  return state.pivot_velocity + v_B - v_A;
}

/// The velocity of a feature's point between those of its corners.
Vector3d rate_at(const Triangle& T, const Triangle& rates, const TriangleFeature& feature,
                 const Vector3d& p) {
  const auto i = static_cast<std::size_t>(feature.index);
  const std::size_t j = (i + 1) % 3;
  if (feature.type == TriangleFeature::Type::vertex) {
    return rates[i];
  }
  if (feature.type == TriangleFeature::Type::edge) {
    const Vector3d along = T[j] - T[i];
    const double part = std::clamp(along.dot(p - T[i]) / along.squaredNorm(), 0.0, 1.0);
    return (1.0 - part) * rates[i] + part * rates[j];
  }
  const Vector3d normal = face_normal(T);
  const auto weight = [&](std::size_t k) {
    const Vector3d opposite = T[(k + 2) % 3] - T[(k + 1) % 3];
    return normal.dot(opposite.cross(p - T[(k + 1) % 3])) / normal.squaredNorm();
  };
  return weight(0) * rates[0] + weight(1) * rates[1] + weight(2) * rates[2];
}

/// Of B's point relative to A's.
Vector3d closest_velocity(const MovingPair& pair, const RelativeState& state,
                          std::uint32_t triangle_A, std::uint32_t triangle_B,
                          const ClosestFeatures& closest) {
  const Vector3d velocity = relative_velocity(state, closest.p_A, closest.p_B);
  if (!pair.deforms()) {
    return velocity;
  }
  const TrianglePair at = pair.place(state, triangle_A, triangle_B);
  const TrianglePair rates = pair.rates(state, triangle_A, triangle_B);
  return velocity + rate_at(at.B, rates.B, closest.feature_B, closest.p_B) -
         rate_at(at.A, rates.A, closest.feature_A, closest.p_A);
}

/// A feature as a number, in the order of types and indices.
std::uint64_t number_of(const Feature& feature) {
  return static_cast<std::uint64_t>(feature.type) << 32 | feature.index;
}

bool comes_before(const CloseKey& x, const CloseKey& y) {
  if (x.feature_A != y.feature_A || x.feature_B != y.feature_B) {
    return x.feature_A != y.feature_A ? x.feature_A < y.feature_A : x.feature_B < y.feature_B;
  }
  return std::tie(x.distance, x.triangle_A, x.triangle_B) <
         std::tie(y.distance, y.triangle_A, y.triangle_B);
}

bool same_features(const CloseKey& x, const CloseKey& y) {
  return x.feature_A == y.feature_A && x.feature_B == y.feature_B;
}

Contact make_contact(const ContactFrame& frame, const RelativeState& state, const ClosePair& pair) {
  const ClosestFeatures& closest = pair.closest;
  Contact contact;
  contact.feature_A = pair.feature_A;
  contact.feature_B = pair.feature_B;
  const Vector3d velocity =
      closest_velocity(frame.pair, state, pair.triangle_A, pair.triangle_B, closest);
  Vector3d n = closest.p_B - closest.p_A;
  if (!(closest.distance > 0.0)) {
    n = feature_normal(frame.pair.place(state, pair.triangle_A, pair.triangle_B), closest);
    n = n.dot(velocity) > 0.0 ? Vector3d(-n) : n;
  }
  const double length = n.norm();
  Vector3d thickness_A = Vector3d::Zero();
  Vector3d thickness_B = Vector3d::Zero();
  if (length > 0.0) {
    contact.n_AB_W = n / length;
    contact.normal_velocity = contact.n_AB_W->dot(velocity);
    thickness_A = frame.A.radius() * *contact.n_AB_W;
    thickness_B = -frame.B.radius() * *contact.n_AB_W;
  }
  contact.p_WA = frame.p_WC + closest.p_A + thickness_A;
  contact.p_WB = frame.p_WC + closest.p_B + thickness_B;
  contact.distance = closest.distance - frame.A.radius() - frame.B.radius();
  return contact;
}

ClosePair close_pair(const ContactFrame& frame, std::uint32_t triangle_A, std::uint32_t triangle_B,
                     const ClosestFeatures& closest) {
  return {global_feature(frame.A, triangle_A, closest.feature_A),
          global_feature(frame.B, triangle_B, closest.feature_B), triangle_A, triangle_B, closest};
}

}  // namespace

Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                     std::uint32_t triangle_A, std::uint32_t triangle_B,
                     const ClosestFeatures& closest) {
  return make_contact(frame, state, close_pair(frame, triangle_A, triangle_B, closest));
}

namespace {

/// Whether two triangles are farther apart than `reach` along n, of any length.
bool apart_along(const Vector3d& n, const TrianglePair& pair, double reach) {
  const Vector3d a(n.dot(pair.A[0]), n.dot(pair.A[1]), n.dot(pair.A[2]));
  const Vector3d b(n.dot(pair.B[0]), n.dot(pair.B[1]), n.dot(pair.B[2]));
  const double gap = std::max(b.minCoeff() - a.maxCoeff(), a.minCoeff() - b.maxCoeff());
  return gap > 0.0 && gap * gap > reach * reach * n.squaredNorm();
}

/// Most pairs of triangles that were opened are, by far more than rounding.
bool clearly_apart(const TrianglePair& pair, double reach) {
  constexpr double kClearly = 1.0 + 0x1p-20;
  const Vector3d between =
      (pair.B[0] + pair.B[1] + pair.B[2]) - (pair.A[0] + pair.A[1] + pair.A[2]);
  return apart_along(face_normal(pair.A), pair, kClearly * reach) ||
         apart_along(face_normal(pair.B), pair, kClearly * reach) ||
         apart_along(between, pair, kClearly * reach);
}

/// Which features of each of two triangles are asked.
struct AskedFeatures {
  unsigned of_A = 0x3f;
  unsigned of_B = 0x3f;
};

/// @param reach  [m]  the band, and more than positions err
void append_pairs(const ContactFrame& frame, const TrianglePair& triangles,
                  std::uint32_t triangle_A, std::uint32_t triangle_B, const AskedFeatures& asked,
                  double band, double reach, std::vector<ClosePair>& pairs) {
  if (clearly_apart(triangles, reach)) {
    return;
  }
  const FeaturePairs close =
      feature_pairs_within(triangles.A, triangles.B, band, asked.of_A, asked.of_B);
  for (std::size_t k = 0; k < close.count; ++k) {
    pairs.push_back(close_pair(frame, triangle_A, triangle_B, close.pairs[k]));
  }
}

/// Appends the contacts of the pairs by their order, the nearest one of each pair of features.
void append_once(const ContactFrame& frame, const RelativeState& state, WorkspaceData& workspace,
                 std::vector<Contact>& contacts) {
  std::vector<CloseKey>& keys = workspace.close_keys;
  keys.clear();
  for (const ClosePair& pair : workspace.close_pairs) {
    keys.push_back({number_of(pair.feature_A), number_of(pair.feature_B), pair.closest.distance,
                    pair.feature_A.triangle, pair.feature_B.triangle, &pair});
  }
  std::sort(keys.begin(), keys.end(), comes_before);
  const auto end = std::unique(keys.begin(), keys.end(), same_features);
  for (auto key = keys.begin(); key != end; ++key) {
    contacts.push_back(make_contact(frame, state, *key->pair));
  }
}

}  // namespace

void collect_contacts_of(const ContactFrame& frame, double band, WorkspaceData& workspace,
                         std::vector<Contact>& contacts) {
  std::vector<ClosePair>& close = workspace.close_pairs;
  close.clear();
  const RelativeState state = frame.pair.motion().state(frame.t);
  const double reach = band + 2.0 * frame.pair.gap_error(state);
  for (const OpenedPair& pair : workspace.opened_pairs) {
    const double travel = frame.pair.speed_bound() * std::abs(frame.t - pair.t);
    if (pair.distance - travel <= reach) {
      append_pairs(frame, frame.pair.place(state, pair.a, pair.b), pair.a, pair.b, {}, band, reach,
                   close);
    }
  }
  append_once(frame, state, workspace, contacts);
}

namespace {

/// Of meshes with so few triangles each pair is looked at: boxes around boxes tell no more.
constexpr std::size_t kFewTriangles = 16;

/// A triangle at an instant, and the box around it along the axes of body A.
struct BoxedTriangle {
  Triangle corners;
  Eigen::AlignedBox3d box;
};

BoxedTriangle boxed(const Triangle& corners, const Eigen::Matrix3d& R_WA) {
  BoxedTriangle triangle{corners, {}};
  for (const Vector3d& corner : corners) {
    triangle.box.extend(R_WA.transpose() * corner);
  }
  return triangle;
}

/// Each feature need be asked but once, where all pairs of triangles that are close are looked at.
///
/// @param reach  [m]  the band, and more than positions err
void find_close_of_few(const ContactFrame& frame, const RelativeState& state, double band,
                       double reach, std::vector<ClosePair>& close) {
  const MovingPair& pair = frame.pair;
  const auto own_A = frame.A.own_features();
  const auto own_B = frame.B.own_features();
  const double apart = reach + pair.gap_error(state);
  std::array<BoxedTriangle, kFewTriangles> of_B;
  for (std::uint32_t b = 0; b < pair.B().triangles.size(); ++b) {
    of_B[b] = boxed(pair.place(state, 0, b).B, state.R_WA);
  }
  for (std::uint32_t a = 0; a < pair.A().triangles.size(); ++a) {
    const BoxedTriangle of_A = boxed(pair.place(state, a, 0).A, state.R_WA);
    for (std::uint32_t b = 0; b < pair.B().triangles.size(); ++b) {
      const AskedFeatures own{own_A[a], own_B[b]};
      if ((own.of_A != 0 || own.of_B != 0) &&
          !(of_A.box.squaredExteriorDistance(of_B[b].box) > apart * apart)) {
        append_pairs(frame, {of_A.corners, of_B[b].corners}, a, b, own, band, reach, close);
      }
    }
  }
}

void find_close(const ContactFrame& frame, const RelativeState& state, double band, double reach,
                WorkspaceData& workspace) {
  const MovingPair& pair = frame.pair;
  const BoxesAtInstant boxes(pair, state);
  const auto own_A = frame.A.own_features();
  const auto own_B = frame.B.own_features();
  auto& stack = workspace.stack;
  stack.assign(1, {false, 0, 0, root(pair.A()), root(pair.B())});
  while (!stack.empty()) {
    const BoxPair top = stack.back();
    stack.pop_back();
    if (top.is_triangle_pair) {
      const AskedFeatures own{own_A[top.triangle_A], own_B[top.triangle_B]};
      if (own.of_A != 0 || own.of_B != 0) {
        append_pairs(frame, pair.place(state, top.triangle_A, top.triangle_B), top.triangle_A,
                     top.triangle_B, own, band, reach, workspace.close_pairs);
      }
      continue;
    }
    boxes.open(top.A, top.B, [&](const BoxesAtInstant::Lane& lane) {
      if (!(lane.gap() > reach)) {
        stack.push_back(lane.inside());
      }
    });
  }
}

}  // namespace

void collect_contacts(const ContactFrame& frame, double band, WorkspaceData& workspace,
                      std::vector<Contact>& contacts) {
  const RelativeState state = frame.pair.motion().state(frame.t);
  const double reach = band + frame.pair.gap_error(state);
  workspace.close_pairs.clear();
  if (std::max(frame.pair.A().triangles.size(), frame.pair.B().triangles.size()) <= kFewTriangles) {
    find_close_of_few(frame, state, band, reach, workspace.close_pairs);
  } else {
    find_close(frame, state, band, reach, workspace);
  }
  append_once(frame, state, workspace, contacts);
}

}  // namespace firstcontact::detail
