// Tops on the tray of a robot, on springs and of two bodies that are welded: the second order of
// their precession does not end beside robots and ties.

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "simulation/simulated_run.h"
#include "simulation/top.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::kArm;
using test::kMassOfTop;
using test::numbers;
using test::right_axis;
using test::run;
using test::settings;
using test::simulator;
using test::Top;

constexpr double kNear = 1e-5;  // [m]  Contact distance.
constexpr double kTime = 0.5;   // [s]

/// [-]  From the right axis, at the end of the run. It is proven, too.
double error_of(Simulator s, double step, const Vector3d& right) {
  const std::vector<RunStep> steps = run(s, static_cast<std::size_t>(std::lround(kTime / step)));
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << step;
  return (steps.back().bodies[0].X_WB.rotation * Vector3d::UnitZ() - right).norm();
}

/// An error of second order at these steps, that is small at the first one.
///
/// @param most  [-]  by the square of the turn in a step
void expect_second_order(const std::function<Simulator(double)>& made, double spin,
                         const Vector3d& right, double most) {
  for (const double step : {0.005, 0.0025, 0.00125}) {
    const double turned = spin * step;
    EXPECT_LT(error_of(made(step), step, right), most * turned * turned) << step;
  }
}

/// A tray that a motor holds, as the one link of a robot that moves.
class TrayOfRobot {
 public:
  TrayOfRobot() : folder_(std::filesystem::temp_directory_path() / "firstcontact_tray") {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "robot.urdf") << R"(<robot name="r"><link name="base"/>
      <link name="tray"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0"
        ixz="0" iyz="0"/></inertial><collision><origin xyz="0 0 -0.05"/><geometry>
        <box size="2 2 0.1"/></geometry></collision></link>
      <joint name="lift" type="prismatic"><parent link="base"/><child link="tray"/>
        <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="0" velocity="100"/></joint>
      </robot>)";
  }
  TrayOfRobot(const TrayOfRobot&) = delete;
  TrayOfRobot& operator=(const TrayOfRobot&) = delete;
  ~TrayOfRobot() { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Simulator with(const Top& top, const std::string& motor, double step) const {
    ShapeCache cache;
    return Simulator(load_scene(
        parse_scene(R"({"firstcontact": 1, "bodies": [)" + test::top_body(top, kNear) +
                        R"(], "robots": [{"name": "r", "urdf": ")" +
                        (folder_ / "robot.urdf").string() +
                        R"(", "dynamics": {"base": "fixed", "motors": {"lift": )" + motor +
                        R"(}}}], "simulation": {)" + settings(step, top.friction, kNear) + "}}",
                    "test.json"),
        cache));
  }

 private:
  std::filesystem::path folder_;
};

TEST(TiedTops, PrecessOnTheTrayOfARobot) {
  const TrayOfRobot tray;
  const Top top;
  for (const std::string motor :
       {R"({"position": 0})", R"({"velocity": 0})", R"({"position": 0, "effort": 1000})"}) {
    expect_second_order([&](double step) { return tray.with(top, motor, step); }, top.spin,
                        right_axis(top, kTime), 0.07);
  }
}

// A spring that is above the centre of mass takes a part of the weight.
TEST(TiedTops, PrecessOnASpring) {
  const Top top;
  constexpr double kStiffness = 10.0;  // [N/m]
  constexpr double kAnchor = 0.2;      // [m]
  const std::string tie = R"(, "ties": [{"type": "spring", "bodies": [null, "top"], "points": [)" +
                          numbers({kArm * std::sin(top.lean), 0.0, kAnchor}) + ", " +
                          numbers({0.0, 0.0, kArm}) + R"(], "length": 0, "stiffness": )" +
                          std::to_string(kStiffness) + "}]";
  expect_second_order(
      [&](double step) {
        return simulator(test::kFloor + ", " + test::top_body(top, kNear),
                         settings(step, top.friction, kNear) + tie);
      },
      top.spin, right_axis(top, kTime, kStiffness, kAnchor), 0.07);
}

TEST(TiedTops, PrecessBesideASlackCable) {
  const Top top;
  expect_second_order(
      [&](double step) {
        return simulator(test::kFloor + ", " + test::top_body(top, kNear),
                         settings(step, top.friction, kNear) +
                             R"(, "ties": [{"type": "cable", "bodies": [null, "top"],
                                 "points": [[0, 0, 5], [0, 0, 0.1]], "length": 6}])");
      },
      top.spin, right_axis(top, kTime), 0.07);
}

/// A part of a top about its axis.
struct PartOfTop {
  std::string name;
  std::string shape;
  double mass = 0.0;                // [kg]
  double at = 0.0;                  // [m]  Its origin along the axis, from the centre of the tip,
  double centre = 0.0;              // [m]  and its centre of mass from there.
  std::array<double, 2> moments{};  // [kg m^2]  Across the axis and about it.
};

std::string text_of(const PartOfTop& part, const Top& top) {
  const Vector3d axis(std::sin(top.lean), 0.0, std::cos(top.lean));
  const Vector3d from = part.at * axis + Vector3d(0.0, 0.0, 0.02 + kNear);
  return R"({"name": ")" + part.name + R"(", "shape": )" + part.shape +
         R"(, "pose": {"position": )" + numbers({from.x(), from.y(), from.z()}) + R"(, "rpy": )" +
         numbers({0.0, top.lean, 0.0}) + R"(}, "dynamics": {"mass": )" + std::to_string(part.mass) +
         R"(, "centre_of_mass": )" + numbers({0.0, 0.0, part.centre}) + R"(, "inertia": [)" +
         numbers({part.moments[0], 0.0, 0.0}) + ", " + numbers({0.0, part.moments[0], 0.0}) + ", " +
         numbers({0.0, 0.0, part.moments[1]}) + R"(], "angular_velocity": )" +
         numbers({top.spin * axis.x(), 0.0, top.spin * axis.z()}) + "}}";
}

// Two bodies that are welded together have the mass, the centre of mass and the moments of one top.
// Most of it is in the part that touches.
TEST(TiedTops, AreOneBodyWhereTheirPartsAreWelded) {
  const Top top;
  constexpr double kCentreOfTip = 0.09;  // [m]
  PartOfTop tip{"top", test::ball("0.02"), 0.25, 0.0, kCentreOfTip, {2.5e-4, 4.5e-4}};
  PartOfTop rotor{"rotor", test::box("[0.02, 0.02, 0.02]")};
  rotor.mass = kMassOfTop - tip.mass;
  rotor.at = (kMassOfTop * kArm - tip.mass * kCentreOfTip) / rotor.mass;
  const auto shifted = [](double mass, double from) {
    return mass * (from - kArm) * (from - kArm);
  };
  rotor.moments = {top.moments[0] - tip.moments[0] - shifted(tip.mass, kCentreOfTip) -
                       shifted(rotor.mass, rotor.at),
                   top.moments[2] - tip.moments[1]};
  expect_second_order(
      [&](double step) {
        return simulator(test::kFloor + ", " + text_of(tip, top) + ", " + text_of(rotor, top),
                         settings(step, top.friction, kNear) +
                             R"(, "ties": [{"type": "weld", "bodies": ["top", "rotor"]}])");
      },
      top.spin, right_axis(top, kTime), 0.12);
}

}  // namespace
}  // namespace firstcontact
