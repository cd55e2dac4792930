#include <firstcontact/query/detail/contact_state.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>

#include <Eigen/Geometry>

#include <firstcontact/query/contact_selection.h>
#include <firstcontact/query/detail/close_list.h>
#include <firstcontact/query/detail/close_pairs.h>
#include <firstcontact/query/detail/close_pairs_by_front.h>
#include <firstcontact/query/detail/close_pairs_of_few.h>
#include <firstcontact/query/detail/convex_contacts.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

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

/// The velocity of a feature's point, interpolated between those of its corners.
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

/// The velocity of B's point relative to A's.
Vector3d closest_velocity(const MovingPair& pair, const RelativeState& state,
                          std::uint32_t triangle_A, std::uint32_t triangle_B,
                          const ClosestFeatures& closest) {
  Vector3d velocity = relative_velocity(state, closest.p_A, closest.p_B);
  if (!pair.deforms()) {
    return velocity;
  }
  const TrianglePair at = pair.place(state, triangle_A, triangle_B);
  const TrianglePair rates = pair.rates(state, triangle_A, triangle_B);
  return velocity + rate_at(at.B, rates.B, closest.feature_B, closest.p_B) -
         rate_at(at.A, rates.A, closest.feature_A, closest.p_A);
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

/// Lists the keys of the close pairs in order, with the nearest pair for each two features.
void sort_once(WorkspaceData& workspace) {
  std::vector<CloseKey>& keys = workspace.close_keys;
  keys.clear();
  for (const ClosePair& pair : workspace.close_pairs) {
    keys.push_back({number_of(pair.feature_A), number_of(pair.feature_B), pair.closest.distance,
                    pair.feature_A.triangle, pair.feature_B.triangle, &pair});
  }
  std::sort(keys.begin(), keys.end(), comes_before);
  keys.erase(std::unique(keys.begin(), keys.end(), same_features), keys.end());
}

/// Keeps `most` of the keys, in the same order.
void keep_most(std::size_t most, std::vector<CloseKey>& keys) {
  if (keys.size() <= most) {
    return;
  }
  ContactSelection<std::size_t> selection(most);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    selection.add(rank_of(*keys[k].pair), k);
  }
  std::vector<std::size_t> kept = selection.take();
  std::sort(kept.begin(), kept.end());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    keys[k] = keys[kept[k]];  // kept[k] is not before k.
  }
  keys.resize(kept.size());
}

/// Appends the contacts of the pairs with these keys, each once.
ContactCount append_contacts(const ContactFrame& frame, const RelativeState& state,
                             std::size_t most, std::vector<CloseKey>& keys,
                             std::vector<Contact>& contacts) {
  const ContactCount count{keys.size(), true};
  keep_most(most, keys);
  for (const CloseKey& key : keys) {
    contacts.push_back(make_contact(frame, state, *key.pair));
  }
  return count;
}

}  // namespace

Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                     std::uint32_t triangle_A, std::uint32_t triangle_B,
                     const ClosestFeatures& closest) {
  if (frame.pair.is_convex()) {
    return make_contact(frame, state,
                        close_convex_pair(frame, state, triangle_A, triangle_B, closest));
  }
  return make_contact(frame, state, close_pair(frame, triangle_A, triangle_B, closest));
}

ContactCount collect_contacts_of(const ContactFrame& frame, double band, std::size_t most,
                                 WorkspaceData& workspace, std::vector<Contact>& contacts) {
  if (frame.pair.is_convex()) {
    return collect_contacts(frame, band, most, workspace, contacts);
  }
  const RelativeState state = frame.pair.motion().state(frame.t);
  find_close_among_opened(frame, state, band, workspace);
  sort_once(workspace);
  return append_contacts(frame, state, most, workspace.close_keys, contacts);
}

ContactCount collect_contacts(const ContactFrame& frame, double band, std::size_t most,
                              WorkspaceData& workspace, std::vector<Contact>& contacts) {
  const RelativeState state = frame.pair.motion().state(frame.t);
  std::optional<ContactCount> of_more;  // The number of all, where more were found than are listed.
  if (frame.pair.is_convex()) {
    find_close_to_convex(frame, state, band, workspace);
    sort_once(workspace);
  } else if (are_few(frame)) {
    find_close_of_few(frame, state, band, workspace);
  } else {
    of_more = find_close(frame, state, band, most, workspace);
    sort_once(workspace);
  }
  const ContactCount listed = append_contacts(frame, state, most, workspace.close_keys, contacts);
  return of_more.value_or(listed);
}

void collect_contacts_by_front(const ContactFrame& frame, double band, BoxFront& front,
                               WorkspaceData& workspace, std::vector<Contact>& contacts) {
  const RelativeState state = frame.pair.motion().state(frame.t);
  if (!find_close_by_front(frame, state, band, front, workspace)) {
    find_close(frame, state, band, ContactState::all.most, workspace);
  }
  sort_once(workspace);
  append_contacts(frame, state, ContactState::all.most, workspace.close_keys, contacts);
}

}  // namespace firstcontact::detail
