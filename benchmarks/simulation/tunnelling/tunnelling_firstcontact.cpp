// Simulates boxes shot at a thin plate, in firstcontact; verify_run proves every run.

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation/simulator.h>
#include <firstcontact/verification/verify_run.h>

#include "benchmarks/simulation/tunnelling/shots.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

json three(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Scene scene_of(const Shot& shot) {
  const Eigen::Quaterniond rotation(shot.X_WB.linear());
  const json plate = {
      {"name", "plate"},
      {"shape",
       {{"box",
         {{"size", three(2.0 * Eigen::Vector3d(kPlateHalfThick, kPlateHalf, kPlateHalf))}}}}}};
  const json box = {
      {"name", "box"},
      {"shape", {{"box", {{"size", three(Eigen::Vector3d::Constant(2.0 * kBoxHalf))}}}}},
      {"pose",
       {{"position", three(shot.X_WB.translation())},
        {"quaternion_wxyz", {rotation.w(), rotation.x(), rotation.y(), rotation.z()}}}},
      {"dynamics",
       {{"mass", kBoxMass},
        {"linear_velocity", {shot.speed, 0, 0}},
        {"angular_velocity", three(shot.spin)}}}};
  const json scene = {{"firstcontact", 1},
                      {"bodies", {plate, box}},
                      {"simulation", {{"step", kStep}, {"gravity", {0, 0, 0}}, {"friction", 0}}}};
  return parse_scene(scene.dump(), "shot.json");
}

class OurFlight final : public Flight {
 public:
  explicit OurFlight(const Shot& shot) : simulator_(load_scene(scene_of(shot), cache_)) {}

  void step() override { steps_.push_back(simulator_.step().value()); }

  [[nodiscard]] Eigen::Isometry3d box() const override {
    const Pose& pose = simulator_.states()[1].X_WB;
    return Eigen::Translation3d(pose.position) * pose.rotation.normalized();
  }

  [[nodiscard]] bool proven() const override {
    std::size_t next = 0;
    const auto steps = [&] {
      return next < steps_.size() ? std::optional(steps_[next++]) : std::nullopt;
    };
    const RunVerification found = verify_run(simulator_.header(), steps);
    return found.verdict == ProofVerdict::proven && found.time_lost == 0.0;
  }

 private:
  ShapeCache cache_;
  Simulator simulator_;
  std::vector<RunStep> steps_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return shoot(
      argc, argv,
      {{"firstcontact", [](const Shot& shot) { return std::make_unique<OurFlight>(shot); }}});
}
