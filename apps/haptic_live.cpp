#include "haptic_live.h"

#include <variant>

#include <fmt/core.h>
#include <fmt/format.h>

#include <firstcontact/run_page/write_run_page.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>

namespace firstcontact::app {
namespace {

constexpr std::int64_t kPictureNs = 16'000'000;  // Time between pictures: 60 a second.
constexpr double kStill = 1.0;                   // [s]  Time of the page in which nothing moves.

std::string numbers(const Pose& pose) {
  const auto& [p, q] = pose;
  return fmt::format("{},{},{},{},{},{},{}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
}

std::string numbers(const Eigen::Vector3d& v) {
  return fmt::format("{},{},{}", v.x(), v.y(), v.z());
}

/// The links of a tool where its device leads them: the number of the body, then its pose.
std::string links_json(const std::vector<RunDevice>& devices, std::size_t tool) {
  std::string text;
  for (const RunDevice& device : devices) {
    for (std::size_t k = 0; device.body == tool && k < device.links.size(); ++k) {
      text += fmt::format("{}[{},{}]", k == 0 ? "" : ",", device.links[k].body,
                          numbers(device.links[k].X_WB));
    }
  }
  return text;
}

}  // namespace

HapticLive::HapticLive(const HapticSetup& setup, std::optional<std::size_t> mouse)
    : setup_(setup), mouse_(mouse) {
  for (const HapticTool& each : setup.scene.tools) {
    poses_.emplace_back(each.X_WB);
  }
  for (const HapticBody& body : setup.scene.bodies) {
    poses_.push_back(body.course ? std::optional(body.course->pose(0.0)) : std::nullopt);
  }
  first_link_ = poses_.size();
  poses_.resize(setup.bodies.size());
}

std::string HapticLive::page(const RunHeader& header, std::string_view page_template) const {
  RunPage still(header);
  RunStep step{.index = 1, .time = kStill, .lasted = kStill};
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    std::optional<Pose> pose = poses_[k];
    if (k >= first_link_) {  // A link begins at its body.
      pose = std::get<FixedMotion>(header.scene.bodies[setup_.bodies[k]].motion).pose;
    }
    if (pose) {
      step.bodies.push_back(
          {.body = setup_.bodies[k], .pieces = {{.to = kStill, .X_WB = *pose}}, .X_WB = *pose});
    }
  }
  still.add(step);
  ShapeCache cache;
  std::string text = still.write(page_template, load_scene(header.scene, cache));
  const std::string mouse = mouse_ ? fmt::format(",\"mouse\":{},\"grips\":{}", *mouse_,
                                                 setup_.options.mappings[*mouse_].grips.size())
                                   : std::string();
  text.insert(text.rfind("</body>"),
              fmt::format("<script id=\"firstcontact-live\" type=\"application/json\">"
                          "{{\"tools\":[{}]{}}}</script>\n",
                          tools_json(), mouse));
  return text;
}

/// The tools: their bodies, and the bodies that hang on them.
std::string HapticLive::tools_json() const {
  std::string text;
  for (std::size_t k = 0; k < setup_.scene.tools.size(); ++k) {
    text += fmt::format("{}{{\"body\":{},\"links\":[{}]}}", k == 0 ? "" : ",", setup_.bodies[k],
                        fmt::join(links(k), ","));
  }
  return text;
}

/// The bodies that hang on a tool.
std::vector<std::size_t> HapticLive::links(std::size_t tool) const {
  std::vector<std::size_t> found;
  std::size_t next = first_link_;
  for (std::size_t k = 0; k < setup_.scene.tools.size(); ++k) {
    for (const HapticLink& link : setup_.scene.tools[k].links) {
      if (link.shape) {
        if (k == tool) {
          found.push_back(setup_.bodies[next]);
        }
        ++next;
      }
    }
  }
  return found;
}

void HapticLive::take(const HapticCycle& cycle) {
  for (const HapticMemberMotion& motion : cycle.members) {
    poses_[motion.member] = motion.X_WB;
  }
  touches_ = cycle.touches;
}

bool HapticLive::is_due(const ForceTick& tick) const {
  return shown_ns_ == 0 || tick.time_ns - shown_ns_ >= kPictureNs;
}

/// The handle that the mouse moves; nothing without the mouse.
std::string HapticLive::mouse_json(const ForceTick& tick) const {
  if (!mouse_) {
    return {};
  }
  const DeviceState& device = tick.tools[*mouse_].device;
  // The mapping has the handle at this pose before the page sends its first one.
  const Pose& X_DH =
      device.status == DeviceStatus::waiting ? setup_.options.mappings[*mouse_].X_DH : device.X_DH;
  return fmt::format(R"("handle":[{}],"grip":{},)", numbers(X_DH), device.grips[0]);
}

std::string HapticLive::picture(const ForceTick& tick, const std::vector<RunDevice>& devices) {
  shown_ns_ = tick.time_ns;
  std::string text = "{\"tools\":[";
  for (std::size_t k = 0; k < setup_.scene.tools.size(); ++k) {
    const ToolTick& tool = tick.tools[k];
    text += fmt::format(R"({}{{"target":[{}],"force":[{}],"torque":[{}],"links":[{}]}})",
                        k == 0 ? "" : ",", numbers(tool.target), numbers(tool.device_force_W()),
                        numbers(tool.torque_W), links_json(devices, setup_.bodies[k]));
  }
  text += "]," + mouse_json(tick);
  text += "\"bodies\":[";
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (poses_[k]) {  // The first tool always has one.
      text += fmt::format("{}[{},{}]", k == 0 ? "" : ",", setup_.bodies[k], numbers(*poses_[k]));
    }
  }
  text += "],\"contacts\":[";
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    text += fmt::format("{}[{}]", k == 0 ? "" : ",", numbers(touches_[k].contact.point));
  }
  return text + "]}";
}

}  // namespace firstcontact::app
