// Simulates the scenes of laws.py in MuJoCo with its defaults.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <mujoco/mujoco.h>
#include <unistd.h>

#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

// [kg] and [kg m^2]  A body of a spinning joint is so heavy that no contact changes its motion.
constexpr double kHeavy = 1e9;

std::string three(const Vector3d& v) {
  std::ostringstream text;
  text.precision(17);
  text << v.x() << " " << v.y() << " " << v.z();
  return text.str();
}

std::string geom_of(const LawShape& shape) {
  switch (shape.kind) {
    case LawShape::Kind::box:
      return "type=\"box\" size=\"" + three(shape.half) + "\"";
    case LawShape::Kind::sphere:
      return "type=\"sphere\" size=\"" + std::to_string(shape.half.x()) + "\"";
    case LawShape::Kind::ellipsoid:
      return "type=\"ellipsoid\" size=\"" + three(shape.half) + "\"";
    case LawShape::Kind::capsule:
    case LawShape::Kind::cylinder:
      return std::string("type=\"") +
             (shape.kind == LawShape::Kind::capsule ? "capsule" : "cylinder") + "\" size=\"" +
             std::to_string(shape.half.x()) + " " + std::to_string(shape.half.z()) + "\"";
  }
  return {};
}

std::string model_of(const LawScene& scene) {
  std::ostringstream xml;
  xml.precision(17);
  xml << "<mujoco><worldbody>";
  for (const LawBody& body : scene.bodies) {
    const Eigen::Quaterniond& q = body.q_WB;
    xml << "<body pos=\"" << three(body.p_WB) << "\" quat=\"" << q.w() << " " << q.x() << " "
        << q.y() << " " << q.z() << "\">";
    if (body.motion == LawMotion::free) {
      xml << "<freejoint/><inertial pos=\"0 0 0\" mass=\"" << body.mass << "\" diaginertia=\""
          << three(body.moments) << "\"/>";
    } else if (body.motion == LawMotion::spins) {
      xml << "<joint type=\"hinge\" axis=\"" << three(body.w.normalized())
          << "\"/><inertial pos=\"0 0 0\" mass=\"" << kHeavy << "\" diaginertia=\""
          << three(Vector3d::Constant(kHeavy)) << "\"/>";
    }
    xml << "<geom " << geom_of(body.shape) << " pos=\"" << three(body.p_CS) << "\" friction=\""
        << scene.friction << " 0 0\"/></body>";
  }
  xml << "</worldbody></mujoco>";
  return xml.str();
}

class MujocoLaw final : public LawEngine {
 public:
  explicit MujocoLaw(const LawScene& scene) : scene_(scene) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("law_" + std::to_string(getpid()) + ".xml");
    std::ofstream(path) << model_of(scene);
    load(scene.robots.empty() ? path : file_of(scene.robots[0]));
    std::filesystem::remove(path);
    if (!scene.robots.empty()) {
      start_robot(scene.robots[0]);
      return;
    }
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      start(scene.bodies[k], static_cast<int>(k) + 1);
    }
  }

  void step() override { mj_step(model_.get(), data_.get()); }

  [[nodiscard]] LawBody body(std::size_t k) const override {
    LawBody now = scene_.bodies[k];
    const int joint = model_->body_jntadr[k + 1];
    const double* q = data_->qpos + model_->jnt_qposadr[joint];
    const double* v = data_->qvel + model_->jnt_dofadr[joint];
    now.p_WB = {q[0], q[1], q[2]};
    now.q_WB = Eigen::Quaterniond(q[3], q[4], q[5], q[6]);
    now.v = {v[0], v[1], v[2]};
    now.w = now.q_WB * Vector3d(v[3], v[4], v[5]);
    return now;
  }

  [[nodiscard]] std::vector<double> positions(std::size_t /*robot*/) const override {
    return {data_->qpos, data_->qpos + model_->nq};
  }

  [[nodiscard]] LawTotals robots() override {
    if (scene_.robots.empty()) {
      return {};
    }
    mj_forward(model_.get(), data_.get());
    mj_subtreeVel(model_.get(), data_.get());
    mj_energyVel(model_.get(), data_.get());
    const Vector3d momentum = model_->body_subtreemass[0] * Vector3d(data_->subtree_linvel);
    return {momentum,
            Vector3d(data_->subtree_angmom) + Vector3d(data_->subtree_com).cross(momentum),
            data_->energy[1]};
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  void load(const std::filesystem::path& path) {
    char message[1000] = "";
    model_.reset(mj_loadXML(path.c_str(), nullptr, message, sizeof message));
    if (!model_) {
      throw std::runtime_error(message);
    }
    model_->opt.timestep = scene_.step;
    model_->opt.gravity[2] = -scene_.gravity;
    data_.reset(mj_makeData(model_.get()));
  }

  void start(const LawBody& body, int number) {
    if (body.motion == LawMotion::rests) {
      return;
    }
    double* v = data_->qvel + model_->jnt_dofadr[model_->body_jntadr[number]];
    if (body.motion == LawMotion::spins) {
      v[0] = body.w.norm();
      return;
    }
    const Vector3d w_B = body.q_WB.conjugate() * body.w;
    for (int k = 0; k < 3; ++k) {
      v[k] = body.v[k];
      v[3 + k] = w_B[k];
    }
  }

  static std::filesystem::path file_of(const LawRobot& robot) {
    std::filesystem::path file = robot.urdf;
    return robot.is_free ? file.replace_extension(".xml") : file;
  }

  void start_robot(const LawRobot& robot) {
    const int base = robot.is_free ? 1 : 0;  // A free base counts as one joint.
    for (int k = 0; k < 3 * base; ++k) {
      data_->qvel[k] = robot.v[k];
      data_->qvel[3 + k] = robot.w[k];
    }
    for (std::size_t k = 0; k < robot.positions.size(); ++k) {
      const int joint = base + static_cast<int>(k);
      data_->qpos[model_->jnt_qposadr[joint]] = robot.positions[k];
      data_->qvel[model_->jnt_dofadr[joint]] = robot.velocities[k];
      model_->jnt_stiffness[joint] = robot.stiffnesses[k];
    }
  }

  LawScene scene_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return simulate_law(argc, argv, true,
                      [](const LawScene& scene) { return std::make_unique<MujocoLaw>(scene); });
}
