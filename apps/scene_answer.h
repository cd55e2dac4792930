/// @file
/// A scene with the answers to all questions about it.

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

/// The question of a command line about every scene.
struct Question {
  std::optional<double> margin;          ///< [m]    In place of the scene's.
  std::optional<double> tolerance;       ///< [m]    In place of the scene's.
  std::optional<double> deadline;        ///< [s]    In place of the scene's.
  std::optional<ContactState> contacts;  ///< In place of the scene's.
  std::optional<double> sample_rate;     ///< [1/s]  Rate of sampling, to compare with the proof.
  bool all_pairs = false;
  bool closest = false;
  bool all_contacts_in_time = false;
  bool strict = false;   ///< Motions beyond joint limits are errors.
  bool lenient = false;  ///< As ReadingOptions::lenient.
  int threads = 0;       ///< 0 for one on each core.
  bool gap_curve = false;
  std::stop_token stop;
  std::function<void(std::string)> doing;  ///< Called with the name of the present work.

  [[nodiscard]] ReadingOptions reading() const { return {.lenient = lenient}; }
  /// Whether the result as JSON has every pair, as intervals of contact are written with their
  /// pairs.
  [[nodiscard]] bool writes_pairs() const { return all_pairs || all_contacts_in_time; }
};

/// Replaces options of the scene by those of the command line.
void override_options(const Question& question, SceneOptions& options);

struct SceneAnswer {
  LoadedScene loaded;
  SceneResult result;
  std::vector<GapSample> samples;  ///< Samples at the sample rate; empty without a rate.
  std::vector<GapSample> curve;    ///< Samples of the gap; empty where they were not asked for.
  std::optional<SamplingReport> sampling;
};

/// Answers a scene.
///
/// @throws ParseError, std::invalid_argument as load_scene, times_at_rate; for a motion beyond
///         joint limits where that is an error
[[nodiscard]] SceneAnswer answer_scene(Scene scene, const Question& question, ShapeCache& cache,
                                       ManyBodiesWorkspace& workspace);

}  // namespace firstcontact::app
