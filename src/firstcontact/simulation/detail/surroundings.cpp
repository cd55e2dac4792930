#include <firstcontact/simulation/detail/surroundings.h>

#include <firstcontact/simulation/detail/sim_body.h>

#include <firstcontact/simulation/detail/step_start.h>

#include <firstcontact/simulation/detail/world.h>

namespace firstcontact::detail {
namespace {

std::vector<std::size_t> bodies_that_are_not_free(const World& world) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < world.bodies.size(); ++b) {
    if (world.bodies[b].kind != BodyKind::free) {
      bodies.push_back(b);
    }
  }
  return bodies;
}

std::vector<Eigen::AlignedBox3d> boxes_over_step(const World& world, const StepStart& start,
                                                 const std::vector<std::size_t>& bodies) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(bodies.size());
  for (const std::size_t b : bodies) {
    boxes.push_back(swept_box(world.bodies[b], start.states[b].X_WB, start.scripted[b]));
  }
  return boxes;
}

}  // namespace

Surroundings::Surroundings(const World& world, const StepStart& start)
    : bodies_(bodies_that_are_not_free(world)), tree_(boxes_over_step(world, start, bodies_)) {}

}  // namespace firstcontact::detail
