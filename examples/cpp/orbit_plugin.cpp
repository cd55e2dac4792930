// A plug-in for a haptic device, to begin a driver of your own with.
//
// Its device is imagined: a handle that goes round a circle once a second, on a soft spring. Put
// the calls of your vendor's library in the place of the formulas. To build it nothing is needed
// but this file and device_plugin.h:
//
//   c++ -shared -fPIC -o orbit_plugin.so orbit_plugin.cpp

#include <firstcontact/haptic_devices/device_plugin.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

namespace {

constexpr double kStiffness = 500.0;                        // [N/m]
constexpr double kTurnRate = 2.0 * 3.14159265358979323846;  // [rad/s]
constexpr std::int64_t kLifetimeNs = 100'000'000;           // How long a command lasts.

struct Orbit {
  double radius = 0.04;  // [m]
  double force[3] = {0.0, 0.0, 0.0};
  std::int64_t commanded_ns = std::numeric_limits<std::int64_t>::min();
  std::uint64_t sequence = 0;
};

// Opens the device. The settings are "radius=0.04", or nothing.
void* open_device(const char* settings, char* problem, std::size_t problem_size) {
  double radius = 0.04;
  if (*settings != '\0') {
    constexpr const char* kKey = "radius=";
    char* end = nullptr;
    const bool known = std::strncmp(settings, kKey, std::strlen(kKey)) == 0;
    radius = known ? std::strtod(settings + std::strlen(kKey), &end) : 0.0;
    if (!known || *end != '\0' || !(radius > 0.0 && radius < 1.0)) {
      std::snprintf(problem, problem_size, "settings: expected radius=NUMBER in metres");
      return nullptr;
    }
  }
  auto* orbit = new (std::nothrow) Orbit;
  if (orbit != nullptr) {
    orbit->radius = radius;
  }
  return orbit;
}

void describe(void* device, firstcontact_device_abilities* abilities) {
  std::snprintf(abilities->name, sizeof abilities->name, "orbit");
  abilities->kind = FIRSTCONTACT_DEVICE_POSE;
  for (int axis = 0; axis < 3; ++axis) {
    abilities->sensed[axis] = 1;
    abilities->driven[axis] = 1;
  }
  abilities->max_force = 4.0;
  abilities->max_stiffness = 2000.0;
  abilities->max_damping = 5.0;
  abilities->workspace_radius = 2.0 * static_cast<Orbit*>(device)->radius;
}

void read_sample(void* device, std::int64_t now_ns, firstcontact_device_sample* sample) {
  Orbit& orbit = *static_cast<Orbit*>(device);
  const double angle = kTurnRate * static_cast<double>(now_ns % 1'000'000'000) * 1e-9;
  sample->position[0] = orbit.radius * std::cos(angle);
  sample->position[1] = orbit.radius * std::sin(angle);
  const bool commanded = orbit.commanded_ns >= 0 && now_ns - orbit.commanded_ns < kLifetimeNs;
  for (int axis = 0; axis < 3; ++axis) {
    sample->position[axis] += commanded ? orbit.force[axis] / kStiffness : 0.0;
  }
  sample->quaternion_wxyz[0] = 1.0;
  sample->time_ns = now_ns;
  sample->sequence = ++orbit.sequence;
  sample->status = FIRSTCONTACT_DEVICE_LIVE;
}

void command_force(void* device, std::int64_t now_ns, const double force[3], const double*) {
  Orbit& orbit = *static_cast<Orbit*>(device);
  std::memcpy(orbit.force, force, sizeof orbit.force);
  orbit.commanded_ns = now_ns;
}

void close_device(void* device) { delete static_cast<Orbit*>(device); }

}  // namespace

extern "C" const firstcontact_device_plugin_functions* firstcontact_device_plugin(void) {
  static const firstcontact_device_plugin_functions functions = {
      FIRSTCONTACT_DEVICE_PLUGIN_ABI,
      sizeof(firstcontact_device_sample),
      sizeof(firstcontact_device_abilities),
      0,
      open_device,
      describe,
      read_sample,
      command_force,
      close_device};
  return &functions;
}
