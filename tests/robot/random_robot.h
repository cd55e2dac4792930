/// @file
/// Robots of random joints, links and motors, as URDF and in scenes.

#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "support/random.h"

namespace firstcontact::test {

/// Robot whose arms leave a root along different axes, link after link.
///
/// No link touches another one while every coordinate is 0.
class RandomRobot {
 public:
  /// [m]  Greatest distance of a link from the root's origin while every coordinate is 0.
  static constexpr double kReach = 1.1;

  /// @param driven  whether joints have motors
  RandomRobot(Random& random, bool driven) : random_(random), driven_(driven) {
    has_free_base_ = random.chance(0.4);
    add_link("root", Eigen::Vector3d::Zero());
    const auto arms = 1 + static_cast<std::size_t>(random.uniform(0.0, 3.0));
    for (std::size_t arm = 0; arm < arms; ++arm) {
      const Eigen::Vector3d along = kArms[arm];
      const Eigen::Vector3d half = 0.5 * kSpacing * along;
      std::string parent = "root";
      const auto links = 1 + static_cast<std::size_t>(random.uniform(0.0, 3.0));
      for (std::size_t k = 0; k < links; ++k) {
        const std::string name = "l" + std::to_string(arm) + std::to_string(k);
        add_link(name, half);
        add_joint("j" + name.substr(1), parent, name, k == 0 ? half : 2.0 * half);
        parent = name;
      }
    }
  }

  [[nodiscard]] std::string urdf() const { return "<robot name=\"r\">" + parts_ + "</robot>"; }

  /// Writes the robot of a scene.
  ///
  /// @param velocity  [m/s]  velocity of a free base
  [[nodiscard]] std::string text(const std::string& urdf_path, const Eigen::Vector3d& at,
                                 const Eigen::Vector3d& velocity) const {
    return R"({"name": "r", "urdf": ")" + urdf_path + R"(", "base": {"position": )" + row(at) +
           R"(}, "dynamics": {"density": 800, "friction": 0.5, )" +
           (has_free_base_ ? R"("base": "free", "linear_velocity": )" + row(velocity) + ", " : "") +
           R"("velocities": {)" + velocities_ + R"(}, "motors": {)" + motors_ + "}}}";
  }

 private:
  static constexpr double kSpacing = 0.3;  // [m]  Spacing of the centres of links.
  static constexpr double kSize = 0.11;    // [m]  Greatest distance from a link's centre.
  static inline const std::array<Eigen::Vector3d, 3> kArms{
      Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()};

  static std::string number(double value) {
    std::array<char, 32> buffer{};
    (void)std::snprintf(buffer.data(), buffer.size(), "%.17g", value);
    return buffer.data();
  }
  static std::string triple(const Eigen::Vector3d& v) {
    return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
  }
  static std::string row(const Eigen::Vector3d& v) {
    return "[" + number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + "]";
  }
  static void append(std::string& list, const std::string& element) {
    list += (list.empty() ? "" : ", ") + element;
  }

  /// Adds a link, heavy or light; the mass of some follows from their density.
  ///
  /// @param centre  [m]  in the frame of its joint
  void add_link(const std::string& name, const Eigen::Vector3d& centre) {
    parts_ += "<link name=\"" + name + "\">";
    if (random_.chance(0.7)) {
      const double mass = random_.logarithmic(0.1, 5.0);
      const Eigen::Vector3d off = random_.vector(0.0, 0.03);
      const std::string moment = number(mass * random_.uniform(0.001, 0.01));
      parts_ += "<inertial><origin xyz=\"" + triple(centre + off) + "\"/><mass value=\"" +
                number(mass) + "\"/><inertia ixx=\"" + moment + "\" iyy=\"" + moment + "\" izz=\"" +
                moment + "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
    }
    parts_ += "<collision><origin xyz=\"" + triple(centre) + "\"/><geometry>" + geometry() +
              "</geometry></collision></link>";
  }

  std::string geometry() {
    const auto kind = static_cast<int>(random_.uniform(0.0, 3.0));
    if (kind == 0) {
      const double x = random_.uniform(0.02, 0.12);
      const double y = random_.uniform(0.02, 0.12);
      const double z = random_.uniform(0.02, 0.12);
      return "<box size=\"" + triple({x, y, z}) + "\"/>";
    }
    const std::string radius = number(random_.uniform(0.02, 0.7 * kSize));
    return kind == 1 ? "<sphere radius=\"" + radius + "\"/>"
                     : "<cylinder radius=\"" + radius + "\" length=\"" +
                           number(random_.uniform(0.02, kSize)) + "\"/>";
  }

  /// Adds a joint.
  ///
  /// Each draw stands in its own statement, because the compiler chooses the order in a sum.
  ///
  /// @param at  [m]  in the frame of the parent's joint
  void add_joint(const std::string& name, const std::string& parent, const std::string& child,
                 const Eigen::Vector3d& at) {
    const std::string type = joint_type();
    parts_ += "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
              "\"/><child link=\"" + child + "\"/><origin xyz=\"" + triple(at) +
              "\"/><axis xyz=\"" + triple(random_.direction()) + "\"/>";
    const bool slides = type == "prismatic";
    const bool is_single = slides || type == "revolute" || type == "continuous";
    if (slides || type == "revolute") {
      const std::string reach = slides ? "0.05" : number(random_.uniform(0.2, 2.0));
      const std::string effort = random_.chance(0.5) ? "0" : "20";
      parts_ += "<limit lower=\"-" + reach + "\" upper=\"" + reach + "\" effort=\"" + effort +
                "\" velocity=\"9\"/>";
    }
    if (random_.chance(0.5)) {
      const std::string friction = random_.chance(0.5) ? "0" : "0.1";
      parts_ += "<dynamics damping=\"" + number(random_.logarithmic(1e-3, 1.0)) + "\" friction=\"" +
                friction + "\"/>";
    }
    const bool follows = is_single && !slides && !leader_.empty() && random_.chance(0.3);
    if (follows) {
      parts_ += "<mimic joint=\"" + leader_ + "\" multiplier=\"" +
                number(random_.uniform(-1.0, 1.0)) + "\"/>";
    }
    parts_ += "</joint>";
    if (!is_single || follows) {
      return;
    }
    leader_ = slides ? leader_ : name;
    append(velocities_,
           "\"" + name + "\": " + number(random_.uniform(-3.0, 3.0) * (slides ? 0.1 : 1.0)));
    if (driven_ && random_.chance(0.7)) {
      append(motors_, "\"" + name + "\": " + motor(slides));
    }
  }

  std::string joint_type() {
    static constexpr std::array kTypes{"revolute", "revolute", "continuous", "prismatic",
                                       "planar",   "floating", "ball"};
    return kTypes.at(static_cast<std::size_t>(random_.uniform(0.0, 7.0)));
  }

  std::string motor(bool slides) {
    const double size = slides ? 0.05 : 1.0;
    const std::string target = "[[0, 0], [0.3, " + number(random_.uniform(-size, size)) + "]]";
    const std::string effort = R"(, "effort": )" + number(random_.logarithmic(1.0, 50.0)) + "}";
    const std::string stiffness = number(random_.logarithmic(10.0, 1e4));
    const std::string damping = number(random_.uniform(0.0, 20.0));
    switch (static_cast<int>(random_.uniform(0.0, 4.0))) {
      case 0:
        return R"({"position": )" + target + R"(, "stiffness": )" + stiffness + R"(, "damping": )" +
               damping + effort;
      case 1:
        return R"({"position": )" + target + effort;
      case 2:
        return R"({"velocity": )" + target + effort;
      default:
        return R"({"torque": )" + target + effort;
    }
  }

  Random& random_;
  bool driven_;
  bool has_free_base_ = false;
  std::string parts_;
  std::string leader_;  // The last joint that another one may mimic.
  std::string velocities_;
  std::string motors_;
};

}  // namespace firstcontact::test
