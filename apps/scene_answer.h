/// @file
/// A scene with all that was asked about it.

#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/sample_gap.h>
#include <firstcontact/scene_files/write_result.h>

namespace firstcontact::app {

/// What a command line asks of every scene.
struct Question {
  std::optional<double> margin;          ///< [m]    In place of the scene's.
  std::optional<double> tolerance;       ///< [m]    In place of the scene's.
  std::optional<double> deadline;        ///< [s]    In place of the scene's.
  std::optional<ContactState> contacts;  ///< In place of the scene's.
  std::optional<double> sample_rate;     ///< [1/s]  Also what sampling would have seen.
  bool all_pairs = false;
  bool closest = false;
  bool all_contacts_in_time = false;
  bool strict = false;   ///< Motions beyond joint limits are errors.
  bool lenient = false;  ///< As ReadingOptions::lenient.
  int threads = 0;       ///< 0 for one on each core.
  bool gap_curve = false;
  std::stop_token stop;
  std::function<void(std::string)> doing;  ///< Called with what is being done.

  [[nodiscard]] ReadingOptions reading() const { return {.lenient = lenient}; }
  /// Whether the result as JSON has every pair: intervals of contact are with their pairs.
  [[nodiscard]] bool writes_pairs() const { return all_pairs || all_contacts_in_time; }
};

/// Puts what the command line says in the place of what the scene says.
void override_options(const Question& question, SceneOptions& options);

struct SceneAnswer {
  LoadedScene loaded;
  SceneResult result;
  std::vector<GapSample> samples;  ///< At the sample rate; empty where none was asked.
  std::vector<GapSample> curve;    ///< Of the gap; empty where none was asked.
  std::optional<SamplingReport> sampling;
};

/// @throws ParseError, std::invalid_argument as load_scene, times_at_rate; of a motion beyond joint
///         limits where that is an error
[[nodiscard]] SceneAnswer answer_scene(Scene scene, const Question& question, ShapeCache& cache,
                                       ManyBodiesWorkspace& workspace);

}  // namespace firstcontact::app
