#include "haptic_arguments.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptic_devices/operator_path.h>

#include "command_line_file.h"
#include "command_line_number.h"

namespace firstcontact::app {
namespace {

constexpr double kDuration = 10.0;      // [s]
constexpr double kLiveDuration = 60.0;  // [s]  With a device that a hand moves.

constexpr const char* kFooter = R"(
SCENE is a scene with "haptics" (docs/haptics.md): its tools follow the devices, one --device each.
DEVICE is one of these (docs/haptic_devices.md):
  FILE.csv                    a recording
  simulated                   a hand that moves at random, on a device without weight
  mouse[=PORT]                the mouse, on a page that this command serves to this machine only
  spacemouse[=SOCKET]         a SpaceMouse through spacenavd
  haply[=ws://HOST:PORT]      a Haply Inverse3 through its service; localhost:10001 by default
  plugin=FILE[,SETTINGS]      another device, by a shared library
The last four run on the wall clock, as with --wall; SpaceMouse and Haply were not tried on
hardware. --live shows a session with any of them; the mouse has a live page without it.
In virtual time the same command gives the same files.
RUN, the output file, holds the motion of the tools. `firstcontact verify RUN` proves with other
code that no tool passed through a body, between ticks too. `firstcontact view RUN` plays it.

Exit status: 0 done; 2 bad input; 3 stopped early, or moving bodies had to wait for a tool.)";

}  // namespace

std::vector<OutputFile> outputs_of(const HapticArguments& arguments) {
  std::vector<OutputFile> all{{"-o", arguments.run},          {"--ticks", arguments.ticks},
                              {"--cycles", arguments.cycles}, {"--timing", arguments.timing},
                              {"--plot", arguments.plot},     {"--html", arguments.page}};
  for (const std::string& file : arguments.recordings) {
    all.push_back({"--record", file});
  }
  return all;
}

namespace {

/// The first option of the simulated hand that is given; null for none.
const char* hand_option(const HapticArguments& arguments) {
  const HandArguments& hand = arguments.hand;
  return arguments.radius    ? "--radius"
         : arguments.speed   ? "--speed"
         : arguments.seed    ? "--seed"
         : hand.stiffness    ? "--hand-stiffness"
         : hand.mass         ? "--hand-mass"
         : hand.tremor       ? "--hand-tremor"
         : hand.encoder_step ? "--encoder-step"
                             : nullptr;
}

/// Changes a length and the angle that goes with it.
void set_length(const std::optional<double>& asked, double& length, double& angle) {
  if (asked) {
    angle *= *asked / length;
    length = *asked;
  }
}

std::optional<BrowserDeviceOptions> live_page(const HapticArguments& arguments) {
  if (!arguments.live) {
    return std::nullopt;
  }
  const std::optional<std::uint16_t> port =
      arguments.live->empty() ? std::optional<std::uint16_t>(0) : port_of(*arguments.live);
  if (!port) {
    throw std::invalid_argument(
        fmt::format("--live: expected a port from 1 to 65535, or none for a free one; got \"{}\"",
                    *arguments.live));
  }
  return BrowserDeviceOptions{.port = *port};
}

}  // namespace

NamedDevices read_devices(const HapticArguments& arguments) {
  if (!arguments.recordings.empty() && arguments.recordings.size() != arguments.devices.size()) {
    throw std::invalid_argument(
        fmt::format("--record: expected a file for each --device, {}; got {}",
                    arguments.devices.size(), arguments.recordings.size()));
  }
  NamedDevices named{.choices = {},
                     .live = live_page(arguments),
                     .duration = kDuration,
                     .on_the_wall = arguments.wall || arguments.live};
  double longest = 0.0;
  bool has_mouse = false;
  for (const std::string& word : arguments.devices) {
    const DeviceChoice& choice = named.choices.emplace_back(read_device_choice(word));
    if (const auto* recording = std::get_if<Recording>(&choice)) {
      if (!arguments.duration) {
        longest = std::max(longest, duration_of_recording(word, *recording));
      }
    } else if (is_live(choice)) {
      const bool is_mouse = std::holds_alternative<BrowserDeviceOptions>(choice);
      if (is_mouse && std::exchange(has_mouse, true)) {
        throw std::invalid_argument(
            "--device mouse moves one tool; name another device for the "
            "second tool, such as simulated");
      }
      if (is_mouse && arguments.live) {
        throw std::invalid_argument(
            "--device mouse has a live page of its own; leave --live out, and name a port as in "
            "mouse=8080");
      }
      named.on_the_wall = true;
      named.duration = kLiveDuration;
    }
    if (named.on_the_wall && arguments.latency) {
      throw std::invalid_argument(fmt::format(
          "--latency is for virtual time, but {} runs on the wall clock; leave one of them out",
          is_live(choice)  ? "--device " + word
          : arguments.wall ? "--wall"
                           : "--live"));
    }
  }
  if (!named.on_the_wall && (arguments.empty_loop || !arguments.timing.empty())) {
    throw std::invalid_argument(fmt::format("{} is for the wall clock; add --wall, or leave it out",
                                            arguments.empty_loop ? "--empty-loop" : "--timing"));
  }
  if (arguments.force && arguments.run.empty() && arguments.recordings.empty()) {
    throw std::invalid_argument("--force replaces the file of -o or --record; name one of them");
  }
  const bool is_simulated = std::ranges::any_of(named.choices, [](const DeviceChoice& choice) {
    return std::holds_alternative<SimulatedChoice>(choice);
  });
  if (const char* option = hand_option(arguments); option != nullptr && !is_simulated) {
    throw std::invalid_argument(
        fmt::format("{} is for --device simulated; leave it out, or name this device", option));
  }
  named.duration = arguments.duration.value_or(longest > 0.0 ? longest : named.duration);
  return named;
}

SimulatedOperatorOptions simulated_hand(const HapticArguments& arguments, const HapticTool& tool,
                                        const DeviceMapping& mapping, double duration,
                                        std::size_t number) {
  RandomPathOptions path;
  path.seed = arguments.seed.value_or(1) + 1000 * number;
  const double reach = tool.shape.bounds().reach + tool.shape.radius();
  path.radius = radius_of_hand(arguments.radius.value_or(2.0 * reach), mapping.scale);
  path.fastest = arguments.speed.value_or(1.0);
  path.slowest = std::min(path.slowest, path.fastest);
  path.centre = mapping.X_DH;
  path.count = static_cast<std::size_t>(std::clamp(20.0 * duration, 10.0, 1e6));
  SimulatedOperatorOptions options;
  options.path = random_via_points(path);
  options.seed = path.seed;
  options.hand.stiffness = arguments.hand.stiffness.value_or(options.hand.stiffness);
  options.hand.mass = arguments.hand.mass.value_or(options.hand.mass);
  set_length(arguments.hand.tremor, options.hand.tremor, options.hand.angular_tremor);
  set_length(arguments.hand.encoder_step, options.channel.resolution,
             options.channel.angular_resolution);
  options.fingers.grips = grips_of_device(mapping);
  return options;
}

void add_haptic_options(CLI::App& command, HapticArguments& arguments) {
  command.add_option("SCENE", arguments.scene, "The scene, .json; - for standard input")
      ->required();
  command
      .add_option(
          "--device", arguments.devices,
          "A recording (.csv), simulated, mouse, spacemouse, haply or plugin=FILE; one per tool")
      ->required()
      ->expected(1)
      ->type_name("DEVICE")
      ->take_all();
  add_file(command, "-o,--output", arguments.run,
           "Records the motion of the tools: JSON Lines, one line per cycle");
  add_file(command, "--ticks", arguments.ticks,
           "Writes each tick: device, target, force, faults (.csv)");
  add_file(command, "--cycles", arguments.cycles, "Writes each cycle of the contact loop (.csv)");
  add_files(command, "--record", arguments.recordings,
            "Records the hand, so that --device plays it again (.csv); one per device");
  add_file(command, "--plot", arguments.plot, "Draws forces over time (.svg)");
  add_file(command, "--html", arguments.page, "Makes a page that plays the run");
  add_number(command, "--duration", arguments.duration, Range::positive,
             "[s] Time to run. Default: 0.1 more than the longest recording, whose last sample is "
             "held. 60 with a device in a user's hand; 10 with a simulated one");
  add_number_between(command, "--latency", arguments.latency, 0.0, 10.0,
                     "[s] Time of one cycle of the contact loop, in virtual time, 0 to 10");
  add_number(command, "--radius", arguments.radius, Range::positive,
             "[m] Reach of the simulated hand from the start. Default: twice the distance from the "
             "middle of the tool to its farthest point");
  add_number_between(command, "--speed", arguments.speed, 1e-6, 1000.0,
                     "[m/s] Greatest mean speed of a stroke of the simulated hand, 1e-6 to 1000; 1 "
                     "by default");
  add_number_between(command, "--hand-stiffness", arguments.hand.stiffness, 0.0, 1500.0,
                     "[N/m] Stiffness of the simulated hand, 0 to 1500; 400 by default");
  add_number_between(command, "--hand-mass", arguments.hand.mass, 0.05, 1.0,
                     "[kg] Mass of the simulated hand, 0.05 to 1; 0.25 by default");
  add_number_between(command, "--hand-tremor", arguments.hand.tremor, 0.0, 0.01,
                     "[m] Tremor of the simulated hand, root mean square, 0 to 0.01; 5e-5 by "
                     "default. Angles tremble in proportion, by 5e-4 rad");
  add_number_between(command, "--encoder-step", arguments.hand.encoder_step, 0.0, 0.01,
                     "[m] Step of the encoders of the simulated device, 0 to 0.01; 1e-5 by "
                     "default. Angles have steps in proportion, of 5e-5 rad");
  add_count(command, "--seed", arguments.seed, "Seed of the motion of the simulated hand");
  command.add_flag("--wall", arguments.wall,
                   "Runs both loops as threads on the wall clock, not in virtual time");
  command
      .add_option_function<std::string>(
          "--live", [&arguments](const std::string& port) { arguments.live = port; },
          "Shows the session on a live page, to this machine only; on the wall clock, as with "
          "--wall")
      ->expected(0, 1)
      ->type_name("[PORT]");
  add_file(command, "--timing", arguments.timing,
           "Writes histograms of all ticks (.csv); on the wall clock");
  add_number(
      command, "--empty-loop", arguments.empty_loop, Range::not_negative,
      "[s] Time for which a loop that does nothing runs first, to compare its late ticks. 0.2 "
      "by default; at most the duration; on the wall clock");
  command.add_flag("--force", arguments.force, "Replaces the files of -o and --record");
  command.footer(kFooter);
}

}  // namespace firstcontact::app
