#include <firstcontact/simulation_model/detail/meeting.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/detail/overlap_tree.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/manifold.h>
#include <firstcontact/simulation_model/detail/move.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

/// Whether two bodies are proven to be farther apart than a margin.
///
/// The lower bound of the distance of a curved body is that of triangles around it. A first contact
/// takes the body exactly.
///
/// @param margin  [m]
bool are_apart(const SimulationModel& model, const BodyPair& pair,
               const std::vector<RigidState>& states, double margin, Workspace& workspace) {
  const Motion motion_A = Motion::fixed(states[pair[0]].X_WB);
  const Motion motion_B = Motion::fixed(states[pair[1]].X_WB);
  const MovingShape A{model.bodies[pair[0]].shape, motion_A};
  const MovingShape B{model.bodies[pair[1]].shape, motion_B};
  if (!are_curved(model, pair)) {
    return distance(A, B, 0.0, workspace).lower_bound > margin;
  }
  FirstContactOptions options;
  options.margin = margin;
  options.tolerance = kNearOfMeeting * model.distances.least;
  options.contacts = ContactState::none;
  return first_contact(A, B, workspace, options).verdict == Verdict::free;
}

}  // namespace

std::optional<BodyPair> find_meeting(const SimulationModel& model,
                                     const std::vector<RigidState>& states,
                                     const std::function<bool(std::size_t)>& concerns,
                                     Workspace& workspace) {
  std::vector<Eigen::AlignedBox3d> boxes;
  const auto slack = Eigen::Vector3d::Constant(0.5 * model.laws.greatest_margin());
  for (std::size_t b = 0; b < states.size(); ++b) {
    const Eigen::AlignedBox3d box = swept_box(model.bodies[b], states[b].X_WB, {});
    boxes.emplace_back(box.min() - slack, box.max() + slack);
  }
  for (const auto& [a, b] : overlapping_pairs(boxes)) {
    const bool is_held =
        model.bodies[a].kind != BodyKind::free && model.bodies[b].kind != BodyKind::free;
    const std::optional<double> margin = model.laws.margin({a, b});
    if (is_held || !margin || !(concerns(a) || concerns(b))) {
      continue;
    }
    if (!are_apart(model, {a, b}, states, *margin, workspace)) {
      return BodyPair{a, b};
    }
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
