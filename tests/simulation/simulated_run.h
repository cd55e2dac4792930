/// @file
/// Simulations of scenes written in tests.

#pragma once

#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation/simulator.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact::test {

inline Simulator simulator(const std::string& bodies, const std::string& simulation) {
  ShapeCache cache;
  return Simulator(load_scene(parse_scene(R"({"firstcontact": 1, "bodies": [)" + bodies +
                                              R"(], "simulation": {)" + simulation + "}}",
                                          "test.json"),
                              cache));
}

/// Writes a body of a scene; `more` begins with a comma.
inline std::string body(const std::string& name, const std::string& shape,
                        const std::string& position, const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "shape": )" + shape + R"(, "pose": {"position": )" +
         position + "}" + more + "}";
}

inline std::string box(const std::string& size) { return R"({"box": {"size": )" + size + "}}"; }
inline std::string ball(const std::string& radius) {
  return R"({"sphere": {"radius": )" + radius + "}}";
}

/// Floor whose top is at z = 0.
inline const std::string kFloor = body("floor", box("[9, 9, 1]"), "[0, 0, -0.5]");

/// Writes a number that reads back bit for bit.
inline std::string number_text(double number) {
  std::ostringstream out;
  out.precision(17);
  out << number;
  return out.str();
}

/// Writes a row of numbers of a scene.
inline std::string numbers(const std::vector<double>& values) {
  std::ostringstream out;
  out.precision(17);
  for (std::size_t k = 0; k < values.size(); ++k) {
    out << (k == 0 ? "[" : ", ") << values[k];
  }
  out << "]";
  return out.str();
}

/// Writes the settings of a scene whose bodies rest at this distance [m].
inline std::string settings(double step, double friction, double contact_distance) {
  std::ostringstream out;
  out.precision(17);
  out << R"("step": )" << step << R"(, "friction": )" << friction << R"(, "contact_distance": )"
      << contact_distance;
  return out.str();
}

inline std::vector<RunStep> run(Simulator& simulator, std::size_t steps) {
  std::vector<RunStep> run;
  for (std::size_t k = 0; k < steps; ++k) {
    run.push_back(simulator.step().value());
  }
  return run;
}

inline RunVerification verify(const RunHeader& header, const std::vector<RunStep>& steps) {
  std::size_t next = 0;
  return verify_run(header,
                    [&]() -> std::optional<RunStep> {
                      return next < steps.size() ? std::optional(steps[next++]) : std::nullopt;
                    },
                    {});
}

}  // namespace firstcontact::test
