#include "pair_view.h"

#include <utility>

namespace firstcontact::python {
namespace {

std::array<std::string, 2> member_names(const HeldResult& result, const BodyPair& members) {
  const Scene& scene = result.scene->scene();
  return {member_name(scene, members[0]), member_name(scene, members[1])};
}

SceneContact told(const HeldResult& result, const Contact& found, const BodyPair& members) {
  SceneContact contact{found, member_names(result, members)};
  contact.normal_velocity = found.normal_velocity / result.scene->scene().duration;
  return contact;
}

PairView view(const HeldResult& result, const PairAnswer& pair) {
  const FirstContactResult& found = pair.first_contact;
  PairView view{.names = member_names(result, pair.bodies),
                .margin = pair.margin,
                .verdict = found.verdict,
                .reason = found.reason,
                .t = found.t,
                .t_upper = found.t_upper,
                .contact_count = found.contact_count,
                .clearance = found.clearance,
                .tolerance_used = found.tolerance_used};
  if (pair.closest_approach) {
    const ClosestApproachResult& closest = *pair.closest_approach;
    view.closest = ClosestView{closest.distance, closest.lower_bound, closest.t, closest.reason,
                               closest.closest};
  }
  return view;
}

PairView view(const HeldResult& result, const RobotPairAnswer& pair) {
  PairView view{.names = member_names(result, pair.members),
                .margin = pair.threshold,
                .verdict = pair.verdict,
                .reason = pair.reason,
                .t = pair.t,
                .t_upper = pair.t_upper,
                .contact_count = pair.contact_count,
                .clearance = proven_clearance(pair),
                .tolerance_used = pair.tolerance_used,
                .intervals = pair.intervals};
  if (pair.least_clearance) {
    const LeastClearance& least = *pair.least_clearance;
    view.closest =
        ClosestView{least.distance, least.lower_bound, least.t, least.reason, least.closest};
  }
  return view;
}

}  // namespace

std::size_t pair_count(const HeldResult& result) {
  const SceneResult& answer = result.answer;
  return answer.robots ? answer.robots->pairs.size() : answer.pairs.size();
}

PairView view_pair(const HeldResult& result, std::size_t index) {
  const SceneResult& answer = result.answer;
  return answer.robots ? view(result, answer.robots->pairs[index])
                       : view(result, answer.pairs[index]);
}

std::optional<std::size_t> first_pair(const SceneResult& answer) {
  return answer.robots ? answer.robots->first : answer.first;
}

std::optional<std::size_t> closest_pair(const SceneResult& answer) {
  return answer.robots ? answer.robots->closest : answer.closest;
}

std::vector<SceneContact> contacts_of_pair(const HeldResult& result, std::size_t index) {
  const SceneResult& answer = result.answer;
  std::vector<SceneContact> contacts;
  if (answer.robots) {
    for (const RobotContact& found : answer.robots->pairs[index].contacts) {
      contacts.push_back(told(result, found.contact, found.members));
      contacts.back().geometries = found.geometries;
    }
  } else {
    const PairAnswer& pair = answer.pairs[index];
    for (const Contact& found : pair.first_contact.contacts) {
      contacts.push_back(told(result, found, pair.bodies));
    }
  }
  return contacts;
}

}  // namespace firstcontact::python
