#include <firstcontact/simulation_model/detail/obstacles.h>

#include <firstcontact/simulation_model/detail/sim_body.h>

#include <firstcontact/simulation_model/detail/step_start.h>

#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

std::vector<std::size_t> bodies_that_are_not_free(const SimulationModel& model) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].kind != BodyKind::free) {
      bodies.push_back(b);
    }
  }
  return bodies;
}

std::vector<Eigen::AlignedBox3d> boxes_over_step(const SimulationModel& model,
                                                 const StepStart& start,
                                                 const std::vector<std::size_t>& bodies) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(bodies.size());
  for (const std::size_t b : bodies) {
    boxes.push_back(swept_box(model.bodies[b], start.states[b].X_WB, start.scripted[b]));
  }
  return boxes;
}

}  // namespace

Obstacles::Obstacles(const SimulationModel& model, const StepStart& start)
    : bodies_(bodies_that_are_not_free(model)), tree_(boxes_over_step(model, start, bodies_)) {}

}  // namespace firstcontact::detail
