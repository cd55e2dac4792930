// Simulates boxes shot at a thin plate, in MuJoCo: with its defaults, and with contacts that act at
// a distance.

#include <cstdio>
#include <sstream>
#include <stdexcept>

#include <mujoco/mujoco.h>

#include "benchmarks/simulation/tunnelling/shots.h"

namespace firstcontact::benchmarks {
namespace {

/// Writes the model of the two boxes; the free box gets its pose later.
///
/// @param margin  [m]  contacts act from this distance on
std::string model_text(double margin) {
  std::ostringstream text;
  text.precision(17);
  text << R"(<mujoco><option timestep=")" << kStep << R"(" gravity="0 0 0"/>)"
       << R"(<default><geom type="box" condim="1" margin=")" << margin << R"("/></default>)"
       << R"(<worldbody><geom name="plate" size=")" << kPlateHalfThick << ' ' << kPlateHalf << ' '
       << kPlateHalf << R"("/><body name="box"><freejoint/><geom size=")" << kBoxHalf << ' '
       << kBoxHalf << ' ' << kBoxHalf << R"(" mass=")" << kBoxMass
       << R"("/></body></worldbody></mujoco>)";
  return text.str();
}

/// Reads a model from memory, as MuJoCo reads only files.
std::shared_ptr<mjModel> read_model(const std::string& text) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "shot.xml", static_cast<int>(text.size()));
  std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
  char error[500] = "";
  mjModel* model = mj_loadXML("shot.xml", files.get(), error, sizeof(error));
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    throw std::runtime_error(error);
  }
  return {model, mj_deleteModel};
}

class MujocoFlight final : public Flight {
 public:
  MujocoFlight(std::shared_ptr<mjModel> model, const Shot& shot)
      : model_(std::move(model)), data_(mj_makeData(model_.get()), mj_deleteData) {
    const Eigen::Quaterniond q(shot.X_WB.linear());
    const Eigen::Vector3d spin_B = q.conjugate() * shot.spin;
    Eigen::Map<Eigen::Vector3d>(data_->qpos) = shot.X_WB.translation();
    Eigen::Map<Eigen::Vector4d>(data_->qpos + 3) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
    Eigen::Map<Eigen::Vector3d>(data_->qvel) = Eigen::Vector3d(shot.speed, 0, 0);
    Eigen::Map<Eigen::Vector3d>(data_->qvel + 3) = spin_B;  // The angular velocity of a free joint
                                                            // is in body axes.
  }

  void step() override { mj_step(model_.get(), data_.get()); }

  [[nodiscard]] Eigen::Isometry3d box() const override {
    const double* q = data_->qpos + 3;
    return Eigen::Translation3d(data_->qpos[0], data_->qpos[1], data_->qpos[2]) *
           Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  }

 private:
  std::shared_ptr<mjModel> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
};

Contender contender(const char* name, double margin) {
  return {name, [model = read_model(model_text(margin))](const Shot& shot) {
            return std::make_unique<MujocoFlight>(model, shot);
          }};
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return shoot(argc, argv,
               {contender("MuJoCo", 0.0), contender("MuJoCo, contacts from 1 cm on", 0.01)});
}
