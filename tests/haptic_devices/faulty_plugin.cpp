// Plug-ins that are wrong in one way each, for the tests of the loader.
#include <firstcontact/haptic_devices/device_plugin.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifndef FAULT_NO_ENTRY
namespace {

void* open(const char* /*settings*/, char* problem, std::size_t problem_size) {
#ifdef FAULT_NO_OPEN
  std::strncpy(problem, "the arm is switched off", problem_size);
  return nullptr;
#else
  static int device = 0;
  (void)problem;
  (void)problem_size;
  return &device;
#endif
}

void describe(void*, firstcontact_device_abilities* abilities) {
  std::strncpy(abilities->name, "faulty", sizeof abilities->name);
  abilities->max_force = 3.0;
  for (int i = 0; i < 3; ++i) {
    abilities->sensed[i] = 1;
    abilities->driven[i] = 1;
  }
#ifdef FAULT_BAD_ABILITIES
  abilities->max_torque = std::nan("");
#endif
}

std::int64_t samples = 0;
double last_force = 0.0;

void read(void*, std::int64_t now_ns, firstcontact_device_sample* sample) {
  ++samples;
  sample->quaternion_wxyz[0] = 1.0;
  sample->position[0] = last_force;
  sample->position[1] = 0.25;
  sample->time_ns = now_ns;
  sample->sequence = static_cast<std::uint64_t>(samples);
  sample->buttons = 1;
  sample->status = FIRSTCONTACT_DEVICE_LIVE;
#ifdef FAULT_BAD_SAMPLES
  if (samples % 3 == 2) {
    sample->position[0] = samples % 2 == 0 ? std::nan("") : 1e70;
  } else if (samples % 3 == 0) {
    sample->quaternion_wxyz[0] = 0.0;
  }
#endif
}

void command(void*, std::int64_t, const double force[3], const double torque[3]) {
  last_force = force[0] + torque[0];
}

void close(void*) {}

}  // namespace

extern "C" const firstcontact_device_plugin_functions* firstcontact_device_plugin(void) {
  static firstcontact_device_plugin_functions functions = {};
  functions.abi = FIRSTCONTACT_DEVICE_PLUGIN_ABI;
  functions.sample_size = sizeof(firstcontact_device_sample);
  functions.abilities_size = sizeof(firstcontact_device_abilities);
  functions.open = open;
  functions.describe = describe;
  functions.read = read;
  functions.command = command;
  functions.close = close;
#ifdef FAULT_OTHER_VERSION
  functions.abi = 999;
#endif
#ifdef FAULT_OTHER_SIZE
  functions.sample_size = 8;
#endif
#ifdef FAULT_NO_READ
  functions.read = nullptr;
#endif
  return &functions;
}

#if defined(FAULT_GRIPS) || defined(FAULT_BAD_GRIPS)
namespace {

double last_effort = 0.0;

void describe_grips(void*, firstcontact_device_grip_abilities* abilities) {
#ifdef FAULT_BAD_GRIPS
  abilities->grips = 17;
#else
  abilities->grips = 2;
#endif
  abilities->max_grip_effort = 0.5;
}

void read_grips(void*, double values[FIRSTCONTACT_DEVICE_MOST_GRIPS]) {
  values[0] = samples % 4 == 3 ? std::nan("") : 0.25;
  values[1] = last_effort;
  values[2] = 9.0;  // Not one of its grips.
}

void command_grips(void*, std::int64_t, const double efforts[FIRSTCONTACT_DEVICE_MOST_GRIPS]) {
  last_effort = efforts[0] + efforts[2];
}

}  // namespace

extern "C" const firstcontact_device_grip_functions* firstcontact_device_plugin_grips(void) {
  static const firstcontact_device_grip_functions functions = {
      FIRSTCONTACT_DEVICE_PLUGIN_ABI, sizeof(firstcontact_device_grip_abilities), describe_grips,
      read_grips, command_grips};
  return &functions;
}
#endif
#endif
