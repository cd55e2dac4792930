/// @file
/// The command line of `firstcontact haptics`.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <firstcontact/haptics/haptic_scene.h>

#include "haptic_device_choice.h"
#include "output_files.h"

namespace firstcontact::app {

/// The simulated hand and its device, where they differ from the default.
struct HandArguments {
  std::optional<double> stiffness;     // [N/m]
  std::optional<double> mass;          // [kg]
  std::optional<double> tremor;        // [m]
  std::optional<double> encoder_step;  // [m]
};

struct HapticArguments {
  std::string scene;
  std::vector<std::string> devices;
  std::string run;
  std::string ticks;
  std::string cycles;
  std::string timing;
  std::string plot;
  std::string page;
  std::vector<std::string> recordings;  // One for each device, or none.
  std::optional<double> duration;       // [s]
  std::optional<double> latency;        // [s]
  std::optional<double> radius;         // [m]
  std::optional<double> speed;          // [m/s]
  std::optional<double> empty_loop;     // [s]
  std::optional<std::size_t> seed;
  HandArguments hand;
  std::optional<std::string> live;  // Port of the live page; "" for a free one.
  bool wall = false;
  bool force = false;
};

/// The devices before they are opened.
struct NamedDevices {
  std::vector<DeviceChoice> choices;
  std::optional<BrowserDeviceOptions> live;  // Of a page that only shows the session.
  double duration = 0.0;                     // [s]  Of the session.
  bool on_the_wall = false;                  // By request, or because a hand moves one of them.
};

/// Adds the options and the footer of the command.
void add_haptic_options(CLI::App& command, HapticArguments& arguments);

[[nodiscard]] std::vector<OutputFile> outputs_of(const HapticArguments& arguments);

/// Reads the words of `--device`.
///
/// @throws std::invalid_argument  where options contradict each other
/// @throws ParseError  where a recording is none
[[nodiscard]] NamedDevices read_devices(const HapticArguments& arguments);

/// The options of a hand that knows nothing of the scene: it goes anywhere around the tool.
///
/// @param duration  [s]  of the session
/// @param number    of the tool
[[nodiscard]] SimulatedOperatorOptions simulated_hand(const HapticArguments& arguments,
                                                      const HapticTool& tool,
                                                      const DeviceMapping& mapping, double duration,
                                                      std::size_t number);

}  // namespace firstcontact::app
