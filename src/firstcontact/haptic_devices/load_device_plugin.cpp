#include <firstcontact/haptic_devices/load_device_plugin.h>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptic_devices/device_plugin.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

using Functions = firstcontact_device_plugin_functions;
using Abilities = firstcontact_device_abilities;
using Sample = firstcontact_device_sample;

constexpr const char* kEntry = "firstcontact_device_plugin";

struct CloseLibrary {
  void operator()(void* library) const { ::dlclose(library); }
};
using Library = std::unique_ptr<void, CloseLibrary>;

std::string last_error_of_loader() {
  const char* error = ::dlerror();
  return error != nullptr ? error : "unknown error";
}

Library load_library(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw ParseError(path.string(), "expected a plug-in for a haptic device, found no file");
  }
  // An absolute path: without a folder in its name the loader would search the system.
  Library library(::dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL));
  if (library == nullptr) {
    throw ParseError(path.string(), "expected a shared library: " + last_error_of_loader());
  }
  return library;
}

const Functions& functions_of(const Library& library, const std::string& path) {
  void* entry = ::dlsym(library.get(), kEntry);
  if (entry == nullptr) {
    throw ParseError(path, std::string("is no plug-in for a haptic device: it exports no ") +
                               kEntry + "(); see docs/haptic_devices.md");
  }
  const Functions* functions = reinterpret_cast<const Functions* (*)()>(entry)();
  if (functions == nullptr) {
    throw ParseError(path, std::string(kEntry) + "() gave no functions");
  }
  if (functions->abi != FIRSTCONTACT_DEVICE_PLUGIN_ABI) {
    throw ParseError(path, "was made for version " + std::to_string(functions->abi) +
                               " of the plug-in interface, this is version " +
                               std::to_string(FIRSTCONTACT_DEVICE_PLUGIN_ABI) +
                               "; compile it with the device_plugin.h of this version");
  }
  if (functions->sample_size != sizeof(Sample) || functions->abilities_size != sizeof(Abilities)) {
    throw ParseError(path,
                     "its structures have other sizes than those of device_plugin.h; set "
                     "sample_size and abilities_size by sizeof");
  }
  if (functions->open == nullptr || functions->describe == nullptr || functions->read == nullptr ||
      functions->command == nullptr || functions->close == nullptr) {
    throw ParseError(path, "one of its functions open, describe, read, command, close is missing");
  }
  return *functions;
}

using GripFunctions = firstcontact_device_grip_functions;
using GripAbilities = firstcontact_device_grip_abilities;

constexpr const char* kGripEntry = "firstcontact_device_plugin_grips";
static_assert(kMostGrips == FIRSTCONTACT_DEVICE_MOST_GRIPS);

/// Finds the functions of grips; null where the plug-in has none.
const GripFunctions* grip_functions_of(const Library& library, const std::string& path) {
  void* entry = ::dlsym(library.get(), kGripEntry);
  if (entry == nullptr) {
    return nullptr;
  }
  const GripFunctions* functions = reinterpret_cast<const GripFunctions* (*)()>(entry)();
  if (functions == nullptr || functions->abi != FIRSTCONTACT_DEVICE_PLUGIN_ABI ||
      functions->abilities_size != sizeof(GripAbilities) || functions->describe == nullptr ||
      functions->read == nullptr) {
    throw ParseError(path, std::string(kGripEntry) +
                               "() gave functions of another version or size, or describe and "
                               "read are missing; compile it with the device_plugin.h of this "
                               "version");
  }
  return functions;
}

void take_grips(const GripAbilities& abilities, bool has_command, const std::string& path,
                DeviceCapabilities& capabilities) {
  if (abilities.grips < 0 || abilities.grips > static_cast<int>(kMostGrips)) {
    throw ParseError(path, "its device has " + std::to_string(abilities.grips) +
                               " grips; expected 0 to " + std::to_string(kMostGrips));
  }
  if (!(abilities.max_grip_effort >= 0.0)) {
    throw ParseError(path, "its device has a max_grip_effort that is negative or no number");
  }
  capabilities.grips = abilities.grips;
  capabilities.max_grip_effort = has_command ? abilities.max_grip_effort : 0.0;
}

template <std::size_t n>
std::string text_of(const char (&text)[n]) {
  return {text, ::strnlen(text, n)};
}

DegreesOfFreedom degrees_of(const std::uint8_t (&flags)[6]) {
  DegreesOfFreedom degrees;
  for (std::size_t i = 0; i < 3; ++i) {
    degrees.linear[i] = flags[i] != 0;
    degrees.angular[i] = flags[i + 3] != 0;
  }
  return degrees;
}

DeviceCapabilities plugin_capabilities(const Abilities& abilities, const std::string& path) {
  const auto fail = [&](const std::string& what) { throw ParseError(path, "its device " + what); };
  if (abilities.kind != FIRSTCONTACT_DEVICE_POSE && abilities.kind != FIRSTCONTACT_DEVICE_RATE) {
    fail("is of the unknown kind " + std::to_string(abilities.kind));
  }
  if (abilities.buttons < 0 || abilities.buttons > 32) {
    fail("has " + std::to_string(abilities.buttons) + " buttons; expected 0 to 32");
  }
  DeviceCapabilities result;
  const std::array<std::pair<const char*, std::pair<double, double*>>, 14> numbers{{
      {"max_force", {abilities.max_force, &result.max_force}},
      {"max_torque", {abilities.max_torque, &result.max_torque}},
      {"max_stiffness", {abilities.max_stiffness, &result.max_stiffness}},
      {"max_angular_stiffness", {abilities.max_angular_stiffness, &result.max_angular_stiffness}},
      {"max_damping", {abilities.max_damping, &result.max_damping}},
      {"max_angular_damping", {abilities.max_angular_damping, &result.max_angular_damping}},
      {"workspace_radius", {abilities.workspace_radius, &result.workspace_radius}},
      {"damping", {abilities.damping, &result.damping}},
      {"angular_damping", {abilities.angular_damping, &result.angular_damping}},
      {"friction", {abilities.friction, &result.friction}},
      {"angular_friction", {abilities.angular_friction, &result.angular_friction}},
      {"resolution", {abilities.resolution, &result.resolution}},
      {"angular_resolution", {abilities.angular_resolution, &result.angular_resolution}},
      {"sample_rate", {abilities.sample_rate, &result.sample_rate}},
  }};
  for (const auto& [name, number] : numbers) {
    if (!(number.first >= 0.0)) {
      fail(std::string("has a ") + name + " that is negative or no number");
    }
    *number.second = number.first;
  }
  if (result.workspace_radius == 0.0) {
    result.workspace_radius = std::numeric_limits<double>::infinity();
  }
  result.name = text_of(abilities.name);
  result.id = text_of(abilities.id);
  result.kind = static_cast<DeviceKind>(abilities.kind);
  result.buttons = abilities.buttons;
  result.sensed = degrees_of(abilities.sensed);
  result.driven = degrees_of(abilities.driven);
  return result;
}

/// Makes the state of a sample. An invalid sample becomes `lost`, with a quaternion of 0.
DeviceState plugin_state(const Sample& sample) {
  DeviceState state;
  const auto& q = sample.quaternion_wxyz;
  state.X_DH.position = Eigen::Map<const Eigen::Vector3d>(sample.position);
  state.X_DH.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  state.linear_rate = Eigen::Map<const Eigen::Vector3d>(sample.linear_rate);
  state.angular_rate = Eigen::Map<const Eigen::Vector3d>(sample.angular_rate);
  state.time_ns = sample.time_ns;
  state.sequence = sample.sequence;
  state.buttons = sample.buttons;
  state.status =
      sample.status >= FIRSTCONTACT_DEVICE_WAITING && sample.status <= FIRSTCONTACT_DEVICE_LOST
          ? static_cast<DeviceStatus>(sample.status)
          : DeviceStatus::lost;
  return state;
}

class PluginDevice : public Device {
 public:
  PluginDevice(Library library, const Functions& functions, const GripFunctions* grips,
               const std::string& path, const std::string& settings)
      : library_(std::move(library)), functions_(functions), grips_(grips) {
    std::array<char, 512> problem{};
    device_ = functions_.open(settings.c_str(), problem.data(), problem.size());
    problem.back() = '\0';
    if (device_ == nullptr) {
      throw ParseError(path, "cannot open its device: " +
                                 (problem[0] != '\0' ? std::string(problem.data())
                                                     : std::string("it gives no reason")));
    }
    try {
      Abilities abilities{};
      functions_.describe(device_, &abilities);
      capabilities_ = plugin_capabilities(abilities, path);
      if (grips_ != nullptr) {
        GripAbilities of_grips{};
        grips_->describe(device_, &of_grips);
        take_grips(of_grips, grips_->command != nullptr, path, capabilities_);
      }
    } catch (...) {
      functions_.close(device_);
      throw;
    }
  }

  ~PluginDevice() override { functions_.close(device_); }

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }

  [[nodiscard]] DeviceState read(std::int64_t now_ns) noexcept override {
    Sample sample{};
    functions_.read(device_, now_ns, &sample);
    DeviceState state = plugin_state(sample);
    read_grips(state);
    newest_status_.store(state.status, std::memory_order_relaxed);
    if (state.status != DeviceStatus::live) {
      return detail::quiet(last_, state.status);
    }
    if (!sensible(state)) {
      newest_status_.store(DeviceStatus::silent, std::memory_order_relaxed);
      malformed_.fetch_add(1, std::memory_order_relaxed);
      return detail::quiet(last_, DeviceStatus::lost);
    }
    if (state.sequence != last_.sequence || last_.status != DeviceStatus::live) {
      samples_.fetch_add(1, std::memory_order_relaxed);
    }
    last_ = state;
    if (capabilities_.kind == DeviceKind::rate) {
      last_.X_DH = Pose{};
    } else {
      last_.X_DH.rotation.normalize();
    }
    return last_;
  }

  void command(const ForceCommand& command, std::int64_t now_ns) noexcept override {
    const ForceCommand allowed = limited(command, capabilities_);
    functions_.command(device_, now_ns, allowed.force_D.data(), allowed.torque_D.data());
    if (grips_ != nullptr && grips_->command != nullptr) {
      grips_->command(device_, now_ns, allowed.grips.data());
    }
  }

  [[nodiscard]] DeviceCounts counts() const override {
    return {samples_.load(), 0, malformed_.load(), 1};
  }

  [[nodiscard]] std::string problem() const override {
    switch (newest_status_.load()) {
      case DeviceStatus::live:
        return {};
      case DeviceStatus::silent:
        return "the plug-in gives samples that make no sense";
      default:
        return "the plug-in reports that its device is not there";
    }
  }

 private:
  void read_grips(DeviceState& state) const noexcept {
    if (grips_ == nullptr) {
      return;
    }
    std::array<double, kMostGrips> values{};
    grips_->read(device_, values.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(capabilities_.grips); ++k) {
      state.grips[k] = values[k];
    }
  }

  /// Whether a state is valid. Rate devices need give no pose.
  [[nodiscard]] bool sensible(const DeviceState& state) const noexcept {
    DeviceState checked = state;
    if (capabilities_.kind == DeviceKind::rate) {
      checked.X_DH = Pose{};
    }
    return detail::makes_sense(checked);
  }

  Library library_;
  const Functions& functions_;
  const GripFunctions* grips_;  // Null for a plug-in without grips.
  void* device_ = nullptr;
  DeviceCapabilities capabilities_;
  DeviceState last_;
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<std::uint64_t> malformed_{0};
  /// The status that the plug-in gave; silent where its sample was invalid.
  std::atomic<DeviceStatus> newest_status_{DeviceStatus::live};
};

}  // namespace

std::unique_ptr<Device> load_device_plugin(const std::filesystem::path& path,
                                           const std::string& settings) {
  Library library = load_library(path);
  const Functions& functions = functions_of(library, path.string());
  const GripFunctions* grips = grip_functions_of(library, path.string());
  return std::make_unique<PluginDevice>(std::move(library), functions, grips, path.string(),
                                        settings);
}

}  // namespace firstcontact
