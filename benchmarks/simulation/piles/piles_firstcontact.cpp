// Simulates boxes that fall, rest and pile up, in firstcontact.

#include <algorithm>

#include <nlohmann/json.hpp>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation/simulator.h>

#include "benchmarks/simulation/piles/piles.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

json three(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
json box_of(const Eigen::Vector3d& half) { return {{"box", {{"size", three(2.0 * half)}}}}; }

Scene scene_of(const Pile& pile) {
  json bodies = {{{"name", "floor"},
                  {"shape", box_of({kFloorHalf, kFloorHalf, 0.5 * kFloorThick})},
                  {"pose", {{"position", {0, 0, -0.5 * kFloorThick}}}}}};
  for (std::size_t k = 0; k < pile.boxes.size(); ++k) {
    const Eigen::Quaterniond q(pile.boxes[k].linear());
    bodies.push_back(
        {{"name", "box " + std::to_string(k)},
         {"shape", box_of(Eigen::Vector3d::Constant(kBoxHalf))},
         {"pose",
          {{"position", three(pile.boxes[k].translation())},
           {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}}}},
         {"dynamics", {{"mass", kBoxMass}, {"angular_velocity", three(pile.spins[k])}}}});
  }
  const json scene = {{"firstcontact", 1},
                      {"bodies", bodies},
                      {"simulation", {{"step", kStep}, {"friction", kFriction}}}};
  return parse_scene(scene.dump(), "pile.json");
}

class OurPile final : public PileWorld {
 public:
  explicit OurPile(const Pile& pile) : simulator_(load_scene(scene_of(pile), cache_)) {}

  void step() override {
    const RunStep step = simulator_.step().value();
    lost_ += step.time_lost;
    residual_ = std::max(residual_, step.residual);
    contacts_ = step.contacts.size();
  }

  [[nodiscard]] std::vector<std::pair<std::string, double>> remarks() const override {
    return {{"time_lost_s", lost_},
            {"residual_m_per_s", residual_},
            {"contacts", static_cast<double>(contacts_)}};
  }

 private:
  ShapeCache cache_;
  Simulator simulator_;
  double lost_ = 0.0;
  double residual_ = 0.0;
  std::size_t contacts_ = 0;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return measure_piles(argc, argv, "firstcontact",
                       [](const Pile& pile) { return std::make_unique<OurPile>(pile); });
}
