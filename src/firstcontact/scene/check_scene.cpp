#include <firstcontact/scene/check_scene.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {

namespace {

using Clock = std::chrono::steady_clock;

WorkBudget budget_of(const Scene& scene, const CheckOptions& options) {
  WorkBudget budget;
  budget.stop = options.stop;
  constexpr double kYear = 3e7;  // [s]  Longer deadlines count as none, and would overflow the
                                 // clock.
  if (scene.options.deadline && *scene.options.deadline <= kYear) {
    budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(*scene.options.deadline));
  }
  return budget;
}

ManyBodiesOptions query_options(const Scene& scene, const CheckOptions& options) {
  return {.pair = {.margin = 0.0,
                   .tolerance = scene.options.tolerance,
                   .start_contacts = scene.options.start_contacts,
                   .contacts = scene.options.contacts,
                   .contact_band = scene.options.contact_band,
                   .budget = budget_of(scene, options)},
          .threads = options.threads,
          .closest = options.closest,
          .all_contacts_in_time = options.all_contacts_in_time,
          .progress = options.progress};
}

/// [m]  The greatest enclosure error of any two bodies that are tested by their triangles.
///
/// Curved bodies are tested by triangles where a partner deforms.
double greatest_enclosure_error(std::span<const Shape* const> shapes) {
  const bool any_deforms = std::any_of(shapes.begin(), shapes.end(), [](const Shape* shape) {
    return shape->hierarchy().deforms();
  });
  double greatest = 0.0;
  double second = 0.0;
  for (const Shape* shape : shapes) {
    const double error = shape->is_curved() && !any_deforms ? 0.0 : shape->enclosure_error();
    second = std::max(second, std::min(error, greatest));
    greatest = std::max(greatest, error);
  }
  return greatest + second;
}

/// The shapes of all bodies and links.
std::vector<const Shape*> shapes_of(const LoadedScene& loaded) {
  std::vector<const Shape*> shapes;
  for (std::size_t k = 0; !loaded.robots && k < loaded.bodies.size(); ++k) {
    shapes.push_back(&loaded.bodies.shape(k));
  }
  for (std::size_t member = 0; loaded.robots && member < loaded.robots->size(); ++member) {
    for (const MemberGeometry& geometry : loaded.robots->geometries(member)) {
      shapes.push_back(&geometry.shape);
    }
  }
  return shapes;
}

SceneResult result_of(std::vector<PairAnswer> pairs, double tolerance) {
  SceneResult result;
  static_cast<Outcome&>(result) = outcome_of_no_pair(tolerance);
  for (const PairAnswer& pair : pairs) {
    merge(pair, result);
    result.work += pair.work;
  }
  result.pairs = std::move(pairs);
  result.first = deciding_pair(result.pairs);
  result.closest = closest_pair(result.pairs);
  return result;
}

SceneResult check_bodies(const LoadedScene& loaded, ManyBodiesWorkspace& workspace,
                         const CheckOptions& options) {
  const ManyBodiesOptions query = query_options(loaded.scene, options);
  return answers_each_pair(loaded, options)
             ? result_of(answer_each_pair(loaded.bodies, workspace, query),
                         loaded.scene.options.tolerance)
             : first_contact(loaded.bodies, workspace, query);
}

SceneResult check_with_robots(const LoadedScene& loaded, const CheckOptions& options) {
  const SceneOptions& asked = loaded.scene.options;
  return check_robots(*loaded.robots, {.tolerance = asked.tolerance,
                                       .start_contacts = asked.start_contacts,
                                       .contacts = asked.contacts,
                                       .contact_band = asked.contact_band,
                                       .budget = budget_of(loaded.scene, options),
                                       .threads = options.threads,
                                       .all_pairs = options.all_pairs,
                                       .all_contacts_in_time = options.all_contacts_in_time,
                                       .closest = options.closest,
                                       .progress = options.progress});
}

}  // namespace

std::vector<std::string> check_warnings(const LoadedScene& loaded) {
  std::vector<std::string> names;
  for (const Body& body : loaded.scene.bodies) {
    if (body.free) {
      names.push_back(body.name);
    }
  }
  for (const SceneRobot& robot : loaded.scene.robots) {
    if (robot.dynamics) {
      names.push_back(robot.name);
    }
  }
  std::vector<std::string> warnings = loaded.warnings;
  if (std::string warning = no_pair_warning(loaded.pair_counts); !warning.empty()) {
    warnings.push_back(std::move(warning));
  }
  if (!names.empty()) {
    warnings.push_back(
        detail::in_quotes(names.front()) +
        (names.size() == 1 ? "" : " and " + std::to_string(names.size() - 1) + " more") +
        " with \"dynamics\": at rest here; \"firstcontact simulate\" moves what has dynamics");
  }
  return warnings;
}

bool answers_each_pair(const LoadedScene& loaded, const CheckOptions& options) {
  return options.all_pairs || options.all_contacts_in_time || (options.closest && !loaded.robots);
}

SceneResult check_scene(const LoadedScene& loaded, ManyBodiesWorkspace& workspace,
                        const CheckOptions& options) {
  SceneResult result =
      loaded.robots ? check_with_robots(loaded, options) : check_bodies(loaded, workspace, options);
  result.enclosure_error = greatest_enclosure_error(shapes_of(loaded));
  return result;
}

}  // namespace firstcontact
