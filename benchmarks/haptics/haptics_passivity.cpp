// Finds the largest stiffness of a wall that does not give energy to a hand, and prints the bound
// of theory.
//
//     haptics_passivity [SECONDS [HAND]]
//
// The handle has a mass, damping b, friction f_c, an encoder of step D and a delay. A hand of
// stiffness HAND [N/m] presses the handle on a floor and holds it from then on. The command is held
// between ticks; the dynamics between them is continuous. The hand has no damping, so the mechanism
// dissipates all energy that the hand and the spring lose. A stiffness counts as active where the
// handle swings farther at the end than in the middle.
//
// Theory: J. J. Abbott, A. M. Okamura, "Effects of position quantization and sampling rate on
// virtual-wall passivity", IEEE Transactions on Robotics 21 (2005): K <= min(2 b / T, 2 f_c / D)
// for a wall without delay. With a delay d the linear bound is b / (T / 2 + d): J. J. Gil,
// E. Sanchez, T. Hulin, C. Preusche, G. Hirzinger, "Stability boundary for haptic rendering:
// influence of damping and delay", Journal of Computing and Information Science in Engineering 9
// (2009). For d the greatest delay is taken: that of the sensor and the jitter.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/haptic_session.h>

namespace firstcontact {
namespace {

struct DeviceClass {
  double damping = 0.1;       // [N s/m]
  double friction = 0.0;      // [N]
  double resolution = 0.0;    // [m]
  std::int64_t delay_ns = 0;  // Delay of the sensor.
  std::int64_t jitter_ns = 0;
  double rate = 4000.0;  // [Hz]
};

/// Swing of the handle, peak to peak.
struct Swing {
  double early = 0.0;  // [m]  Between 0.3 and 0.5 of the duration.
  double late = 0.0;   // [m]  From 0.8 of the duration on.
};

/// Range of the values that were added, peak to peak.
class Extent {
 public:
  void add(double x) {
    least_ = std::min(least_, x);
    greatest_ = std::max(greatest_, x);
  }
  [[nodiscard]] double size() const { return std::max(0.0, greatest_ - least_); }

 private:
  double least_ = 1e9;
  double greatest_ = -1e9;
};

Swing swing_of(const DeviceClass& device, double stiffness, double seconds, double hand) {
  HapticScene scene;
  HapticTool tool{.name = "ball", .shape = make_sphere(0.005)};
  tool.X_WB.position = {0.0, 0.0, 0.006};
  tool.coupling.stiffness = stiffness;
  tool.coupling.angular_stiffness = 1e-4 * stiffness;
  scene.tools.push_back(tool);
  HapticBody floor{.name = "floor", .shape = make_box({0.2, 0.2, 0.02})};
  floor.X_WB.position = {0.0, 0.0, -0.01};
  scene.bodies.push_back(floor);
  HapticSessionOptions options{.force_rate = device.rate,
                               .contact_rate = std::min(1000.0, device.rate)};
  options.forces.limits.force = 1e6;
  options.forces.limits.torque = 1e6;
  options.forces.limits.force_slew = 1e12;
  options.forces.limits.torque_slew = 1e12;
  options.forces.limits.ramp_ns = 1'000'000;
  SimulatedOperatorOptions operator_options;
  operator_options.hand.stiffness = hand;
  operator_options.hand.tremor = 0.0;
  operator_options.hand.angular_tremor = 0.0;
  operator_options.mechanism.damping = device.damping;
  operator_options.mechanism.friction = device.friction;
  operator_options.mechanism.max_force = 1e6;
  operator_options.channel.resolution = device.resolution;
  operator_options.channel.sensor_delay_ns = device.delay_ns;
  operator_options.channel.jitter_ns = device.jitter_ns;
  ViaPoint begin;
  ViaPoint pressed;
  pressed.time = 0.1;
  pressed.X_DH.position = {0.0, 0.0, -0.004};
  operator_options.path = {begin, pressed};
  operator_options.hand.damping = 0.0;  // The worst hand dissipates no energy.
  SimulatedOperator handle(operator_options);
  options.mappings = {{.device = handle.capabilities()}};
  HapticSession session(scene, options);
  const auto count = static_cast<std::int64_t>(seconds * device.rate);
  Extent early;
  Extent late;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t now = session.time_ns();
    const std::array states{handle.read(now)};
    const double part = static_cast<double>(k) / static_cast<double>(count);
    if (part >= 0.8) {
      late.add(handle.truth().X_DH.position.z());
    } else if (part >= 0.3 && part < 0.5) {
      early.add(handle.truth().X_DH.position.z());
    }
    handle.command(session.step(states).tools[0].command, now);
  }
  return {early.size(), late.size()};
}

double bound_of(const DeviceClass& device) {
  const double period = 1.0 / device.rate;
  const double linear =
      device.damping /
      (0.5 * period + 1e-9 * static_cast<double>(device.delay_ns + device.jitter_ns));
  const double by_friction = device.resolution > 0.0 && device.friction > 0.0
                                 ? 2.0 * device.friction / device.resolution
                                 : linear;
  return std::min(linear, by_friction);
}

bool is_active(const DeviceClass& device, double stiffness, double seconds, double hand) {
  const Swing swing = swing_of(device, stiffness, seconds, hand);
  const double still = std::max(2e-6, 2.0 * device.resolution);
  return swing.late > std::max(still, 1.02 * swing.early);
}

/// [N/m]  Finds the largest stiffness that is not active, by bisection between 1 and 1e6.
double largest_passive(const DeviceClass& device, double seconds, double hand) {
  double low = 1.0;
  double high = 1e6;
  while (high / low > 1.03) {
    const double middle = std::sqrt(low * high);
    (is_active(device, middle, seconds, hand) ? high : low) = middle;
  }
  return low;
}

}  // namespace

int sweep(double seconds, double hand) {
  std::printf(
      "b [N s/m], f_c [N], step [um], delay [us], jitter [us], rate [Hz]: largest K, bound\n");
  const std::vector<DeviceClass> classes{
      {.damping = 0.1},
      {.damping = 0.5},
      {.damping = 2.0},
      {.damping = 0.5, .rate = 1000.0},
      {.damping = 0.5, .rate = 10'000.0},
      {.damping = 0.5, .delay_ns = 250'000},
      {.damping = 0.5, .delay_ns = 500'000},
      {.damping = 0.5, .delay_ns = 250'000, .jitter_ns = 100'000},
      {.damping = 0.5, .friction = 0.05, .resolution = 1e-5},
      {.damping = 0.5, .friction = 0.01, .resolution = 1e-5},
  };
  for (const DeviceClass& device : classes) {
    const double bound = bound_of(device);
    const double found = largest_passive(device, seconds, hand);
    std::printf(
        "%5.2f %5.2f %5.1f %6.0f %6.0f %7.0f: %8.0f N/m, %8.0f N/m (%.0f %%); 3 x bound is %s\n",
        device.damping, device.friction, 1e6 * device.resolution,
        1e-3 * static_cast<double>(device.delay_ns), 1e-3 * static_cast<double>(device.jitter_ns),
        device.rate, found, bound, 100.0 * found / bound,
        is_active(device, 3.0 * bound, seconds, hand) ? "active" : "passive");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace firstcontact

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 2.0;
  const double hand = argc > 2 ? std::atof(argv[2]) : 200.0;
  return firstcontact::sweep(seconds, hand);
}
