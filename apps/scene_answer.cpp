#include "scene_answer.h"

#include <utility>

#include <fmt/core.h>

#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/gap_curve.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/parallel_sampling.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/shape_cache.h>

namespace firstcontact::app {
namespace {

CheckOptions check_options(const LoadedScene& loaded, const Question& question) {
  CheckOptions options{.all_pairs = question.all_pairs,
                       .closest = question.closest,
                       .all_contacts_in_time = question.all_contacts_in_time,
                       .threads = question.threads,
                       .stop = question.stop,
                       .progress = {}};
  options.progress = [&loaded, &question, each = answers_each_pair(loaded, options)](double done) {
    const double duration = loaded.scene.duration;
    question.doing(each ? fmt::format("{}: {:.0f} % of the pairs", loaded.scene.id, 100.0 * done)
                        : fmt::format("{}: free until {:.4f} s of {:.4f} s", loaded.scene.id,
                                      done * duration, duration));
  };
  return options;
}

}  // namespace

void override_options(const Question& question, SceneOptions& options) {
  options.margin = question.margin.value_or(options.margin);
  options.tolerance = question.tolerance.value_or(options.tolerance);
  options.deadline = question.deadline ? question.deadline : options.deadline;
  options.contacts = question.contacts.value_or(options.contacts);
}

SceneAnswer answer_scene(Scene scene, const Question& question, ShapeCache& cache,
                         ManyBodiesWorkspace& workspace) {
  override_options(question, scene.options);
  question.doing("loading " + scene.id);
  SceneAnswer answer;
  answer.loaded = load_scene(std::move(scene), cache);
  if (question.strict) {
    require_within_limits(answer.loaded);
  }
  answer.result = check_scene(answer.loaded, workspace, check_options(answer.loaded, question));
  if (question.sample_rate) {
    question.doing("sampling " + answer.loaded.scene.id);
    const auto times = times_at_rate(*question.sample_rate, answer.loaded.scene.duration);
    answer.samples = sample_in_parallel(answer.loaded, times, question.stop);
    answer.sampling = report_sampling(*question.sample_rate, answer.samples);
  }
  if (question.gap_curve) {
    question.doing("plotting " + answer.loaded.scene.id);
    answer.curve = gap_curve(answer.loaded, time_of_interest(answer.result), question.stop);
  }
  return answer;
}

}  // namespace firstcontact::app
