#include "gap_table.h"

#include <fmt/core.h>

#include <firstcontact/scene/gap_bound.h>

namespace firstcontact::app {

std::string gap_table(const SceneAnswer& answer) {
  const double duration = answer.loaded.scene.duration;
  std::string text = "t,time,distance,lower_bound\n";
  auto sample = answer.curve.begin();
  for (const GapPoint& point : gap_lower_bound(answer.loaded, answer.result, answer.curve)) {
    const bool is_sample = sample != answer.curve.end() && sample->t == point.t;
    text += fmt::format("{},{},{},{}\n", point.t, point.t * duration,
                        is_sample ? fmt::format("{}", sample->distance) : "", point.distance);
    sample += is_sample ? 1 : 0;
  }
  return text;
}

}  // namespace firstcontact::app
