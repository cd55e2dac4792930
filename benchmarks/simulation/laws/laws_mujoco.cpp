// Simulates the scenes of laws.py in MuJoCo with its defaults and one of its integrators.

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <unistd.h>

#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;

// [kg] and [kg m^2]  What a script or a motor without bound moves is so heavy that no contact
// changes its motion.
constexpr double kHeavy = 1e9;

std::string text_of(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

std::string text_of(const Vector3d& v) {
  return text_of(v.x()) + " " + text_of(v.y()) + " " + text_of(v.z());
}

std::string pose_of(const Vector3d& p, const Eigen::Quaterniond& q) {
  return " pos=\"" + text_of(p) + "\" quat=\"" + text_of(q.w()) + " " + text_of(Vector3d(q.vec())) +
         "\"";
}

std::string inertial_of(double mass, const Vector3d& moments, const Vector3d& middle) {
  return "<inertial pos=\"" + text_of(middle) + "\" mass=\"" + text_of(mass) + "\" diaginertia=\"" +
         text_of(moments) + "\"/>";
}

std::string name_of(std::size_t robot, std::size_t link) {
  return "r" + std::to_string(robot) + "_" + std::to_string(link);
}

std::string name_of(const LawTie::End& end) {
  if (end.member < 0) {
    return "world";
  }
  return end.robot < 0
             ? "b" + std::to_string(end.member)
             : name_of(static_cast<std::size_t>(end.robot), static_cast<std::size_t>(end.member));
}

bool is_driven(const LawLink& link) {
  return link.motor.kind == LawMotor::Kind::position || link.motor.kind == LawMotor::Kind::velocity;
}

/// The description of a scene in MuJoCo's format.
class Model {
 public:
  explicit Model(const LawScene& scene) : scene_(scene) {
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      add_body(scene.bodies[k], "b" + std::to_string(k));
    }
    for (std::size_t r = 0; r < scene.robots.size(); ++r) {
      add_link(scene.robots[r], r, 0);
    }
    for (std::size_t k = 0; k < scene.ties.size(); ++k) {
      add_tie(scene.ties[k], k);
    }
  }

  [[nodiscard]] std::string text() const {
    const std::string integrator =
        scene_.integrator.empty() ? "" : "<option integrator=\"" + scene_.integrator + "\"/>";
    return "<mujoco>" + integrator + "<asset>" + meshes_ + "</asset><worldbody>" + bodies_ +
           sites_of("world") + "</worldbody><tendon>" + tendons_ + "</tendon><equality>" + pins_ +
           "</equality></mujoco>";
  }

 private:
  [[nodiscard]] std::string geom_of(const LawShape& shape) {
    const Vector3d& half = shape.half;
    switch (shape.kind) {
      case LawShape::Kind::box:
        return "type=\"box\" size=\"" + text_of(half) + "\"";
      case LawShape::Kind::sphere:
        return "type=\"sphere\" size=\"" + text_of(half.x()) + "\"";
      case LawShape::Kind::ellipsoid:
        return "type=\"ellipsoid\" size=\"" + text_of(half) + "\"";
      case LawShape::Kind::capsule:
        return "type=\"capsule\" size=\"" + text_of(half.x()) + " " + text_of(half.z()) + "\"";
      case LawShape::Kind::cylinder:
        return "type=\"cylinder\" size=\"" + text_of(half.x()) + " " + text_of(half.z()) + "\"";
      case LawShape::Kind::hull:
        break;
    }
    const std::string name = "hull" + std::to_string(hulls_++);
    meshes_ += "<mesh name=\"" + name + "\" vertex=\"";
    for (const Vector3d& corner : shape.corners) {
      meshes_ += text_of(corner) + " ";
    }
    meshes_ += "\"/>";
    return "type=\"mesh\" mesh=\"" + name + "\"";
  }

  void add_geoms(const std::vector<LawShape>& shapes) {
    for (const LawShape& shape : shapes) {
      bodies_ += "<geom " + geom_of(shape) + " pos=\"" + text_of(shape.p_BS) + "\" friction=\"" +
                 text_of(scene_.friction) + " 0 0\"/>";
    }
  }

  void add_body(const LawBody& body, const std::string& name) {
    const LawState& start = body.start;
    bodies_ += "<body name=\"" + name + "\"" + pose_of(start.p_WC, start.q_WB) + ">";
    const auto joint = [&](const char* type, const Vector3d& axis) {
      bodies_ += std::string("<joint type=\"") + type + "\" axis=\"" +
                 text_of(Vector3d(start.q_WB.conjugate() * axis)) + "\"/>";
    };
    switch (body.motion) {
      case LawMotion::rests:
        break;
      case LawMotion::spins:
        joint("hinge", start.w.normalized());
        bodies_ += inertial_of(kHeavy, Vector3d::Constant(kHeavy), Vector3d::Zero());
        break;
      case LawMotion::free:
        bodies_ += "<freejoint/>" + inertial_of(start.mass, start.moments, Vector3d::Zero());
        break;
      case LawMotion::plane:
        joint("slide", Vector3d::UnitX());
        joint("slide", Vector3d::UnitZ());
        joint("hinge", Vector3d::UnitY());
        bodies_ += inertial_of(start.mass, start.moments, Vector3d::Zero());
        break;
    }
    add_geoms(body.shapes);
    bodies_ += sites_of(name) + "</body>";
  }

  void add_link(const LawRobot& robot, std::size_t number, std::size_t k) {
    const LawLink& link = robot.links[k];
    const std::string name = name_of(number, k);
    bodies_ += "<body name=\"" + name + "\"" +
               (k == 0 ? pose_of(robot.p_WL, robot.q_WL)
                       : pose_of(link.p_PJ, Eigen::Quaterniond::Identity())) +
               ">";
    if (k == 0 && robot.is_free) {
      bodies_ += "<freejoint/>";
    }
    if (k > 0) {
      bodies_ += "<joint name=\"" + name + "\" type=\"" + (link.is_slide ? "slide" : "hinge") +
                 "\" axis=\"" + text_of(link.axis) + "\" damping=\"" +
                 text_of(link.damping + (is_driven(link) ? 0.0 : link.motor.damping)) +
                 "\" stiffness=\"" + text_of(is_driven(link) ? 0.0 : link.motor.stiffness) +
                 "\" armature=\"" + text_of(is_driven(link) ? kHeavy : 0.0) + "\" springref=\"" +
                 text_of(spring_reference(link)) + "\"/>";
    }
    if (link.mass > 0.0) {
      bodies_ += inertial_of(link.mass, link.moments, link.p_LC);
    }
    add_geoms(link.shapes);
    for (std::size_t child = k + 1; child < robot.links.size(); ++child) {
      if (robot.links[child].parent == static_cast<int>(k)) {
        add_link(robot, number, child);
      }
    }
    bodies_ += sites_of(name) + "</body>";
  }

  /// In degrees, where the joint is a hinge.
  static double spring_reference(const LawLink& link) {
    if (link.motor.kind != LawMotor::Kind::spring) {
      return 0.0;
    }
    const double target = link.motor.target.front().second;
    return link.is_slide ? target : target * 180.0 / mjPI;
  }

  void add_tie(const LawTie& tie, std::size_t number) {
    if (tie.kind == LawTie::Kind::pin) {
      pins_ += "<connect body1=\"" + name_of(tie.ends[0]) + "\" body2=\"" + name_of(tie.ends[1]) +
               "\" anchor=\"" + text_of(tie.ends[0].point) + "\"/>";
      return;
    }
    tendons_ += "<spatial stiffness=\"" + text_of(tie.stiffness) + "\" springlength=\"" +
                text_of(tie.length) + "\">";
    for (std::size_t e = 0; e < 2; ++e) {
      tendons_ += "<site site=\"" + site_name(number, e) + "\"/>";
    }
    tendons_ += "</spatial>";
  }

  static std::string site_name(std::size_t tie, std::size_t end) {
    return "t" + std::to_string(tie) + "_" + std::to_string(end);
  }

  [[nodiscard]] std::string sites_of(const std::string& body) const {
    std::string sites;
    for (std::size_t k = 0; k < scene_.ties.size(); ++k) {
      for (std::size_t e = 0; e < 2; ++e) {
        const LawTie::End& end = scene_.ties[k].ends[e];
        if (scene_.ties[k].kind == LawTie::Kind::spring && name_of(end) == body) {
          sites += "<site name=\"" + site_name(k, e) + "\" pos=\"" + text_of(end.point) + "\"/>";
        }
      }
    }
    return sites;
  }

  const LawScene& scene_;
  std::string meshes_;
  std::string bodies_;
  std::string tendons_;
  std::string pins_;
  int hulls_ = 0;
};

class MujocoLaw final : public LawEngine {
 public:
  explicit MujocoLaw(const LawScene& scene) : scene_(scene) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("law_" + std::to_string(getpid()) + ".xml");
    std::ofstream(path) << Model(scene).text();
    char message[1000] = "";
    model_.reset(mj_loadXML(path.c_str(), nullptr, message, sizeof message));
    std::filesystem::remove(path);
    if (!model_) {
      throw std::runtime_error(message);
    }
    model_->opt.timestep = scene_.step;
    model_->opt.gravity[2] = -scene_.gravity;
    data_.reset(mj_makeData(model_.get()));
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      start(scene.bodies[k], body_number("b" + std::to_string(k)));
    }
    for (std::size_t r = 0; r < scene.robots.size(); ++r) {
      start_robot(scene.robots[r], r);
    }
    place_pins();
    update();
  }

  void step() override {
    for (std::size_t r = 0; r < scene_.robots.size(); ++r) {
      for (std::size_t k = 1; k < scene_.robots[r].links.size(); ++k) {
        drive(scene_.robots[r].links[k].motor, joint_of(r, k));
      }
    }
    mj_step(model_.get(), data_.get());
    ++steps_;
    update();
  }

  [[nodiscard]] LawState body(std::size_t k) override {
    return state_of(scene_.bodies[k].start, body_number("b" + std::to_string(k)));
  }

  [[nodiscard]] LawState link(std::size_t robot, std::size_t k) override {
    const LawLink& link = scene_.robots[robot].links[k];
    return state_of({.mass = link.mass, .moments = link.moments}, body_number(name_of(robot, k)));
  }

  [[nodiscard]] double position(std::size_t robot, std::size_t k) override {
    return data_->qpos[model_->jnt_qposadr[joint_of(robot, k)]];
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  [[nodiscard]] int body_number(const std::string& name) const {
    return mj_name2id(model_.get(), mjOBJ_BODY, name.c_str());
  }

  [[nodiscard]] int joint_of(std::size_t robot, std::size_t link) const {
    return mj_name2id(model_.get(), mjOBJ_JOINT, name_of(robot, link).c_str());
  }

  /// Computes poses and velocities of bodies, which a step leaves where it began.
  void update() {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
  }

  [[nodiscard]] LawState state_of(const LawState& start, int number) const {
    LawState now{.mass = start.mass, .moments = start.moments};
    now.p_WC = Vector3d(data_->xipos + 3 * number);
    const double* q = data_->xquat + 4 * number;
    now.q_WB = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    std::array<double, 6> velocities{};
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, number, velocities.data(), 0);
    now.w = Vector3d(velocities.data());
    now.v = Vector3d(velocities.data() + 3);
    return now;
  }

  void start_free(const Vector3d& v, const Vector3d& w_B, int joint) {
    double* velocities = data_->qvel + model_->jnt_dofadr[joint];
    for (int k = 0; k < 3; ++k) {
      velocities[k] = v[k];
      velocities[3 + k] = w_B[k];
    }
  }

  void start(const LawBody& body, int number) {
    const LawState& start = body.start;
    const int joint = model_->body_jntadr[number];
    if (body.motion == LawMotion::spins) {
      data_->qvel[model_->jnt_dofadr[joint]] = start.w.norm();
    } else if (body.motion == LawMotion::free) {
      start_free(start.v, start.q_WB.conjugate() * start.w, joint);
    }
  }

  void start_robot(const LawRobot& robot, std::size_t number) {
    if (robot.is_free) {
      start_free(robot.v, robot.q_WL.conjugate() * robot.w,
                 model_->body_jntadr[body_number(name_of(number, 0))]);
    }
    for (std::size_t k = 1; k < robot.links.size(); ++k) {
      const int joint = joint_of(number, k);
      data_->qpos[model_->jnt_qposadr[joint]] = robot.links[k].position;
      data_->qvel[model_->jnt_dofadr[joint]] = robot.links[k].velocity;
    }
  }

  /// Places the points of pins: the compiler takes those where all coordinates are 0.
  void place_pins() {
    int number = 0;
    for (const LawTie& tie : scene_.ties) {
      if (tie.kind == LawTie::Kind::pin) {
        for (int e = 0; e < 2; ++e) {
          for (int k = 0; k < 3; ++k) {
            model_->eq_data[number * mjNEQDATA + 3 * e + k] =
                tie.ends[static_cast<std::size_t>(e)].point[k];
          }
        }
        ++number;
      }
    }
  }

  /// Lets a joint follow its rows: the velocity at the end of the step, or the position there.
  void drive(const LawMotor& motor, int joint) {
    const double h = scene_.step;
    const double time = steps_ * h;
    const int dof = model_->jnt_dofadr[joint];
    if (motor.kind == LawMotor::Kind::velocity) {
      data_->qfrc_applied[dof] =
          kHeavy * (value_at(motor.target, time + h) - value_at(motor.target, time)) / h;
    } else if (motor.kind == LawMotor::Kind::position) {
      data_->qvel[dof] =
          (value_at(motor.target, time + h) - data_->qpos[model_->jnt_qposadr[joint]]) / h;
    }
  }

  LawScene scene_;
  int steps_ = 0;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  return simulate_law(argc, argv,
                      [](const LawScene& scene) { return std::make_unique<MujocoLaw>(scene); });
}
