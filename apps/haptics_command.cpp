#include "haptics_command.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <firstcontact/haptic_devices/browser_device.h>
#include <firstcontact/haptic_sessions/wall_session.h>
#include <firstcontact/haptics_files/haptic_log.h>
#include <firstcontact/haptics_files/haptic_run.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/run_page/write_run_page.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "begun_file.h"
#include "device_recordings.h"
#include "haptic_arguments.h"
#include "haptic_device_choice.h"
#include "haptic_live.h"
#include "haptic_plot.h"
#include "haptic_report.h"
#include "haptic_warnings.h"
#include "interrupt.h"
#include "output_files.h"
#include "progress.h"
#include "run_file.h"
#include "standard_streams.h"
#include "step_devices.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

class HapticsRun {
 public:
  explicit HapticsRun(const HapticArguments& arguments)
      : arguments_(arguments),
        named_(read_devices(arguments)),
        loaded_(load()),
        setup_(haptic_setup_of()),
        plot_(setup_.scene.tools.size()) {
    if (arguments.devices.size() != setup_.scene.tools.size()) {
      throw std::invalid_argument(
          fmt::format("{}: expected a --device for each tool, {} of them; got {}", arguments.scene,
                      setup_.scene.tools.size(), arguments.devices.size()));
    }
    const double tick = 1.0 / setup_.options.force_rate;
    if (named_.duration < tick) {
      throw std::invalid_argument(fmt::format(
          "--duration: expected at least {:.4g} s, a tick of the force loop; got {:.4g}", tick,
          named_.duration));
    }
    open_devices();
    if (named_.live) {
      viewing_.emplace(*named_.live);
      server_ = &*viewing_;
      live_.emplace(setup_, std::nullopt);
    }
    if (!arguments.page.empty() || live_) {
      template_ = viewer_page();  // A missing viewer is reported before the work.
    }
  }

  ExitStatus run() {
    begin_files();
    if (named_.on_the_wall) {
      run_on_the_wall();
    } else {
      run_virtually();
    }
    end_files();
    print();
    return is_stopped_ || report_.time_lost() > 0.0 ? ExitStatus::undecided : ExitStatus::free;
  }

 private:
  LoadedScene load() const {
    require_named(outputs_of(arguments_));
    require_different(outputs_of(arguments_));
    require_no_input(outputs_of(arguments_), {arguments_.scene});
    for (const std::string& word : arguments_.devices) {
      if (const auto file = file_of_device(word)) {
        require_no_input(outputs_of(arguments_), {*file});
      }
    }
    Scene scene = arguments_.scene == kStdin
                      ? parse_scene(read_stdin(), std::filesystem::path(kStdinName))
                      : read_scene(arguments_.scene);
    require_no_input(outputs_of(arguments_), files_of(scene));
    try {
      ShapeCache cache;
      prepare_haptics(scene, cache, named_.duration, arguments_.latency.value_or(0.0));
      return load_scene(std::move(scene), cache);
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments_.scene, error.what());
    }
  }

  HapticSetup haptic_setup_of() const {
    try {
      HapticSetup setup = haptic_setup(loaded_);
      setup.options.contact_latency_ns = std::llround(1e9 * arguments_.latency.value_or(0.0));
      // Refuses what both loops would refuse, before anything is written.
      distance_of(setup);
      return setup;
    } catch (const std::invalid_argument& error) {
      throw ParseError(arguments_.scene, error.what());
    }
  }

  static double distance_of(const HapticSetup& setup) {
    return HapticSession(setup.scene, setup.options).contacts().contact_distance();
  }

  void open_devices() {
    setup_.options.mappings = complete_mappings(setup_.scene, setup_.options.mappings);
    for (std::size_t k = 0; k < named_.choices.size(); ++k) {
      const bool is_simulated = std::holds_alternative<SimulatedChoice>(named_.choices[k]);
      devices_.push_back(open_device(
          named_.choices[k], is_simulated
                                 ? simulated_hand(arguments_, setup_.scene.tools[k],
                                                  setup_.options.mappings[k], named_.duration, k)
                                 : SimulatedOperatorOptions{}));
      setup_.options.mappings[k].kind = devices_[k]->capabilities().kind;
      setup_.options.mappings[k].device = devices_[k]->capabilities();
      require_buttons(k);
      require_grips(k);
      add_warnings(k);
      pointers_.push_back(devices_[k].get());
      if (auto* mouse = dynamic_cast<BrowserDevice*>(devices_[k].get())) {
        server_ = mouse;
        live_.emplace(setup_, k);
      }
    }
  }

  /// Requires that the device has the buttons of the tool, which would otherwise never be pressed.
  void require_buttons(std::size_t tool) const {
    const DeviceMapping& mapping = setup_.options.mappings[tool];
    const DeviceCapabilities& device = devices_[tool]->capabilities();
    std::vector<std::pair<const char*, int>> buttons{{"dead_man_button", mapping.dead_man_button},
                                                     {"clutch_button", mapping.clutch_button}};
    for (const GripMapping& grip : mapping.grips) {
      buttons.emplace_back("button of a grip", grip.button);
    }
    for (const auto& [key, button] : buttons) {
      if (button >= static_cast<int>(device.buttons)) {
        throw ParseError(arguments_.scene,
                         fmt::format("haptics: {} is {}, but {} has {} buttons; choose "
                                     "one of them from 0, or leave the key out",
                                     key, button, device.name.empty() ? "the device" : device.name,
                                     device.buttons));
      }
    }
  }

  /// Requires that the device senses the grips of the tool, which would otherwise never close.
  void require_grips(std::size_t tool) const {
    const int needed = grips_of_device(setup_.options.mappings[tool]);
    const DeviceCapabilities& device = devices_[tool]->capabilities();
    if (needed > device.grips) {
      throw ParseError(arguments_.scene,
                       fmt::format("haptics: the grips of \"{}\" follow {} values of the device, "
                                   "but {} senses {}; give grips a \"button\", or leave them out",
                                   setup_.scene.tools[tool].name, needed,
                                   device.name.empty() ? "it" : device.name, device.grips));
    }
  }

  void add_warnings(std::size_t tool) {
    std::vector<std::string> all =
        device_warnings(setup_.scene.tools[tool], setup_.options.mappings[tool].scale,
                        devices_[tool]->capabilities());
    if (const auto* recording = std::get_if<Recording>(&named_.choices[tool])) {
      const std::string speeds = recording_warning(arguments_.devices[tool], *recording);
      all.insert(all.end(), speeds.empty() ? 0 : 1, speeds);
    }
    warnings_.insert(warnings_.end(), all.begin(), all.end());
  }

  void begin_files() {
    const double distance = distance_of(setup_);
    record_.emplace(loaded_, setup_, distance);
    if (!arguments_.page.empty()) {
      page_.emplace(record_->header());
    }
    ticks_.emplace(arguments_.ticks, haptic_tick_header(columns()));
    cycles_.emplace(arguments_.cycles, haptic_cycle_header(columns()));
    drawing_.emplace(arguments_.plot);
    timing_.emplace(arguments_.timing);
    page_file_.emplace(arguments_.page);
    // Last: if another output cannot be written, no run is left behind.
    require_writable(outputs_of(arguments_));
    recordings_.begin(arguments_.recordings, pointers_, arguments_.force);
    if (!arguments_.run.empty()) {
      run_file_.emplace(RunFile::begin(arguments_.run, record_->header(),
                                       arguments_.force ? HeldRun::replaced : HeldRun::kept));
    }
    if (live_) {
      server_->serve(live_->page(record_->header(), template_));
      say(fmt::format("http://127.0.0.1:{}/ {}; Ctrl-C ends\n", server_->port(),
                      !viewing_          ? "has the page: drag the tool there"
                      : waits_for_page() ? "shows the session, which begins when the page is open"
                                         : "shows the session"));
      flush_stdout();
    }
    for (std::size_t k = 0; k < setup_.scene.tools.size(); ++k) {
      god_objects_[k] = setup_.scene.tools[k].X_WB;
    }
  }

  GripColumns columns() const { return grip_columns(setup_.scene, setup_.options); }

  void take(const ForceTick& tick) {
    begin_ns_ = report_.ticks() == 0 ? tick.time_ns : begin_ns_;
    report_.add(tick, setup_.scene.tools.size());
    if (run_file_ || page_) {
      step_devices_.add(tick.time_ns, record_->devices(tick));
    }
    if (live_ && live_->is_due(tick)) {
      server_->show(live_->picture(tick, record_->devices(tick)));
    }
    recordings_.add(tick);
    if (ticks_->is_open()) {
      ticks_->write(haptic_tick_lines(tick, setup_.scene.tools.size(), columns()));
    }
    if (!arguments_.plot.empty()) {
      plot_.add(tick, begin_ns_, god_objects_);
    }
  }

  void take(const HapticCycle& cycle, std::int64_t time_ns) {
    report_.add(cycle);
    if (live_) {
      live_->take(cycle);
    }
    for (const HapticMemberMotion& motion : cycle.members) {
      if (motion.member < setup_.scene.tools.size()) {
        god_objects_[motion.member] = motion.X_WB;
      }
    }
    if (cycles_->is_open()) {
      cycles_->write(haptic_cycle_line(cycle, time_ns));
    }
    if (run_file_ || page_) {
      const RunStep step = record_->step(cycle, step_devices_.at(time_ns));
      if (run_file_) {
        run_file_->write(step);
      }
      if (page_) {
        page_->add(step);
      }
    }
  }

  void run_virtually() {
    HapticSession session(setup_.scene, setup_.options);
    const auto count = static_cast<std::uint64_t>(
        std::ceil(1e9 * named_.duration / static_cast<double>(session.force_period_ns()) - 1e-6));
    std::vector<DeviceState> states(devices_.size());
    for (std::uint64_t k = 0; k < count && !is_stopped_; ++k) {
      const std::int64_t now = session.time_ns();
      for (std::size_t d = 0; d < devices_.size(); ++d) {
        states[d] = devices_[d]->read(now);
      }
      const ForceTick& tick = session.step(states);
      for (std::size_t d = 0; d < devices_.size(); ++d) {
        devices_[d]->command(tick.tools[d].command, now);
      }
      take(tick);
      if (session.cycle() != nullptr) {
        take(*session.cycle(), now);
      }
      if (k % 1024 == 0) {
        is_stopped_ = interrupt_.token().stop_requested();
        progress_.doing(
            fmt::format("{:.3g} of {:.3g} s", 1e-9 * static_cast<double>(now), named_.duration));
      }
    }
  }

  /// Whether the session would be over before a user can open the page.
  [[nodiscard]] bool waits_for_page() const {
    return viewing_ && std::ranges::none_of(named_.choices, is_live);
  }

  void wait_for_page() const {
    constexpr std::chrono::milliseconds kPause(20);
    while (viewing_->counts().connections == 0 && !interrupt_.token().stop_requested()) {
      std::this_thread::sleep_for(kPause);
    }
  }

  [[nodiscard]] WallSessionOptions wall_options() const {
    WallSessionOptions options{.duration = named_.duration};
    options.empty_duration = arguments_.empty_loop.value_or(options.empty_duration);
    return options;
  }

  void run_on_the_wall() {
    if (waits_for_page()) {
      wait_for_page();
    }
    wall_ = run_wall_session(
        setup_.scene, setup_.options, pointers_, wall_options(),
        [this](const ForceTick& tick) { take(tick); },
        [this](const HapticCycle& cycle, std::int64_t time_ns) { take(cycle, time_ns); },
        interrupt_.token());
    is_stopped_ = interrupt_.token().stop_requested();
  }

  void end_files() {
    ticks_->commit();
    cycles_->commit();
    is_recorded_ = recordings_.end();
    if (drawing_->is_open()) {
      drawing_->write(plot_.draw(arguments_.scene, undriven()));
      drawing_->commit();
    }
    if (wall_) {
      timing_->write(haptic_timing_csv(*wall_));
      timing_->commit();
    }
    if (page_ && page_->time() > 0.0) {
      ShapeCache cache;
      const LoadedScene loaded = load_scene(record_->header().scene, cache);
      page_file_->write(page_->write(template_, loaded));
      page_file_->commit();
    }
  }

  /// The efforts that devices in a hand do not drive.
  [[nodiscard]] std::string undriven() const {
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      const std::string text =
          is_live(named_.choices[k]) ? undriven_text(*devices_[k]) : std::string();
      if (!text.empty() && std::ranges::find(texts, text) == texts.end()) {
        texts.push_back(text);
      }
    }
    return fmt::format("{}", fmt::join(texts, ", "));
  }

  void print() const {
    const std::string scene =
        arguments_.scene == kStdin ? std::string(kStdinName) : arguments_.scene;
    say(report_.text(scene, is_stopped_, undriven(), wall_));
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      if (is_live(named_.choices[k])) {
        say(answer_line("device", device_text(*devices_[k])));
      }
    }
    for (const std::string& warning : loaded_.warnings) {
      say(answer_line("warning", warning));
    }
    for (const std::string& warning : warnings_) {
      say(answer_line("warning", warning));
    }
    if (run_file_) {
      say(answer_line("run", arguments_.run + "; `firstcontact verify` proves it again"));
    }
    if (page_) {
      say(answer_line("page",
                      page_->time() > 0.0 ? arguments_.page : "none: there is nothing to play"));
    }
    if (!arguments_.plot.empty()) {
      say(answer_line("plot", arguments_.plot));
    }
    for (const std::string& file : arguments_.recordings) {
      say(answer_line("hand", is_recorded_ ? file + "; --device plays it again"
                                           : "not recorded: the session had no tick"));
    }
    flush_stdout();
  }

  const Interrupt interrupt_;  // First, as other threads inherit its block of signals.
  Progress progress_;
  const HapticArguments& arguments_;
  NamedDevices named_;
  LoadedScene loaded_;
  HapticSetup setup_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<Device*> pointers_;
  std::vector<std::string> warnings_;  // About devices.
  std::array<Pose, kMostTools> god_objects_ = {};
  std::optional<HapticRun> record_;
  StepDevices step_devices_;
  std::optional<RunPage> page_;
  std::string template_;  // Template of the page.
  std::optional<RunFile> run_file_;
  std::optional<BegunFile> ticks_;
  std::optional<BegunFile> cycles_;
  DeviceRecordings recordings_;
  bool is_recorded_ = false;
  // These are written at the end; errors of writing are reported before the session.
  std::optional<BegunFile> drawing_;
  std::optional<BegunFile> timing_;
  std::optional<BegunFile> page_file_;
  HapticPlot plot_;
  std::int64_t begin_ns_ = 0;
  HapticReport report_;
  std::optional<WallSessionReport> wall_;
  std::optional<BrowserDevice> viewing_;  // Serves a page that moves no tool.
  BrowserDevice* server_ = nullptr;       // Of the live page: it, or the mouse among the devices.
  std::optional<HapticLive> live_;
  bool is_stopped_ = false;
};

}  // namespace

void add_haptics_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "haptics", "Moves tools by haptic devices, with forces; no tool passes through a body");
  auto arguments = std::make_shared<HapticArguments>();
  add_haptic_options(*command, *arguments);
  command->callback([arguments, &status] { status = HapticsRun(*arguments).run(); });
}

}  // namespace firstcontact::app
