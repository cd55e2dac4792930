#include "print_robot.h"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/robot_check/touching_links.h>

#include "file_text.h"
#include "quantity_text.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

void line(const char* label, const std::string& value) {
  say(fmt::format("  {:<22} {}\n", label, visible(value)));
}

/// The joints as text: "7 revolute, 2 fixed".
std::string joint_counts(const RobotModel& robot) {
  std::map<JointType, std::size_t> counts;
  for (const Joint& joint : robot.joints()) {
    ++counts[joint.type];
  }
  std::string text;
  for (const auto& [type, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(type));
  }
  return text;
}

std::size_t coordinates(const RobotModel& robot) {
  std::size_t count = 0;
  for (const Joint& joint : robot.joints()) {
    count += joint.mimic ? 0 : coordinate_count(joint.type);
  }
  return count;
}

/// The collision geometry as text: "link3.stl (200 triangles), sphere".
std::string collision_text(const Link& link) {
  std::string text;
  for (const LinkGeometry& geometry : link.collision) {
    const auto* mesh = std::get_if<MeshGeometry>(&geometry.source);
    text += text.empty() ? "" : ", ";
    text += mesh == nullptr ? geometry_kind(geometry)
                            : fmt::format("{} ({} triangles)", mesh->path.filename().string(),
                                          geometry.shape.value().mesh().triangles.size());
  }
  return text.empty() ? "no collision geometry" : text;
}

/// A mass as text: "1.5 kg".
std::string mass_text(const Link& link) {
  return link.inertia ? fmt::format("{:.6g} kg", link.inertia->mass) : "no mass";
}

/// The total mass as text: "1.5 kg, of 6 of 7 links".
std::string total_text(const RobotModel& robot) {
  const RobotMass mass = mass_of(robot);
  const std::size_t count = robot.links().size();
  if (mass.missing == count) {
    return "not given of any link";
  }
  return fmt::format("{:.6g} kg", mass.total) +
         (mass.missing == 0 ? "" : fmt::format(", of {} of {} links", count - mass.missing, count));
}

/// The limits as text: ", -2.9 ... 2.9 rad, up to 2.2 rad/s".
std::string limit_text(const Joint& joint) {
  const char* unit = joint.type == JointType::prismatic ? "m" : "rad";
  std::string text;
  if (joint.limits.lower && joint.limits.upper) {
    text += fmt::format(", {:.6g} ... {:.6g} {}", *joint.limits.lower, *joint.limits.upper, unit);
  }
  if (joint.limits.velocity && joint.type != JointType::fixed) {
    text += fmt::format(", up to {:.6g} {}/s", *joint.limits.velocity, unit);
  }
  if (joint.mimic) {
    text += fmt::format(", {:.6g} times {} + {:.6g}", joint.mimic->multiplier, joint.mimic->joint,
                        joint.mimic->offset);
  }
  return text;
}

/// Two blanks for each link above.
///
/// In long chains the number of links above takes their place, as blanks would be most of the text.
std::string indent(std::size_t depth) {
  constexpr std::size_t kMost = 40;
  return depth <= kMost ? std::string(2 * depth, ' ')
                        : std::string(2 * kMost, ' ') + fmt::format("({}) ", depth);
}

void print_links(const RobotModel& robot,
                 const std::vector<std::vector<std::size_t>>& children_joints, std::size_t root) {
  struct Open {
    std::size_t link;
    std::size_t depth;
  };
  std::vector<Open> open = {{root, 0}};  // Not by recursion, as a chain may be long.
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const Link& link = robot.links()[at.link];
    const std::optional<std::size_t> parent = robot.parent_joint(at.link);
    std::string how;
    if (parent) {
      const Joint& joint = robot.joints()[*parent];
      how = fmt::format(" by {}: {}{}", joint.name, to_string(joint.type), limit_text(joint));
    }
    say(visible(fmt::format("    {}{}{}; {}; {}", indent(at.depth), link.name, how, mass_text(link),
                            collision_text(link))) +
        "\n");
    const std::vector<std::size_t>& joints = children_joints[at.link];
    for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) {
      open.push_back({robot.child_link(*joint), at.depth + 1});
    }
  }
}

void print_tree(const RobotModel& robot) {
  std::vector<std::vector<std::size_t>> joints(robot.links().size());
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    joints[robot.parent_link(j)].push_back(j);
  }
  say("  tree\n");
  print_links(robot, joints, robot.root());
}

/// The remarks on a mesh: "open edges 12, degenerate triangles 3"; empty for a sound mesh.
std::string mesh_remarks(const Mesh& mesh) {
  const MeshDefects found = inspect(mesh);
  std::string text;
  const auto remark = [&](const char* label, std::size_t count) {
    if (count > 0) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label, count);
    }
  };
  remark("open edges", found.open_edges);
  remark("non-manifold edges", found.nonmanifold_edges);
  remark("degenerate triangles", found.degenerate_triangles);
  remark("doubled triangles", found.doubled_triangles);
  return text;
}

void add_joint_remarks(const Joint& joint, std::vector<std::string>& remarks) {
  const auto remark = [&](const char* what) {
    remarks.push_back(fmt::format("joint {}: {}", joint.name, what));
  };
  if (joint.type == JointType::fixed) {
    return;
  }
  if (joint.limits.velocity == 0.0) {
    remark("velocity limit 0: taken for none");
  }
  if (joint.limits.lower && joint.limits.lower == joint.limits.upper) {
    remark("lower and upper limit are the same: it cannot move");
  }
}

void add_link_remarks(const Link& link, std::set<std::string>& seen,
                      std::vector<std::string>& remarks) {
  constexpr double kImplausible = 100.0;  // [m]
  if (link.collision.empty() && !link.visual.empty()) {
    remarks.push_back(fmt::format("link {}: is seen, but has no collision geometry", link.name));
  }
  for (const LinkGeometry& geometry : link.collision) {
    const Shape& shape = geometry.shape.value();
    const double size = 2.0 * (shape.hierarchy().radius + shape.radius());
    if (size > kImplausible) {
      remarks.push_back(
          fmt::format("link {}: {} across; is its unit right?", link.name, length_text(size)));
    }
    const auto* mesh = std::get_if<MeshGeometry>(&geometry.source);
    if (mesh != nullptr && seen.insert(mesh->path.string()).second) {
      if (const std::string found = mesh_remarks(shape.mesh()); !found.empty()) {
        remarks.push_back(fmt::format("{}: {}", mesh->path.filename().string(), found));
      }
    }
  }
}

}  // namespace

RobotMass mass_of(const RobotModel& robot) {
  RobotMass mass;
  for (const Link& link : robot.links()) {
    mass.total += link.inertia ? link.inertia->mass : 0.0;
    mass.missing += link.inertia ? 0 : 1;
  }
  return mass;
}

const char* geometry_kind(const LinkGeometry& geometry) {
  constexpr std::array<const char*, 5> kKinds = {"mesh", "box", "sphere", "cylinder", "capsule"};
  return kKinds[geometry.source.index()];
}

std::vector<std::string> robot_remarks(const RobotModel& robot) {
  std::vector<std::string> remarks;
  std::set<std::string> seen;
  for (const Link& link : robot.links()) {
    add_link_remarks(link, seen, remarks);
  }
  for (const Joint& joint : robot.joints()) {
    add_joint_remarks(joint, remarks);
  }
  return remarks;
}

void print_robot(const std::string& name, const RobotReading& reading) {
  const RobotModel& robot = reading.model;
  std::size_t colliding = 0;
  for (const Link& link : robot.links()) {
    colliding += link.collision.empty() ? 0 : 1;
  }
  const std::vector<std::string> remarks = robot_remarks(robot);
  say(visible(name) + "\n");
  line("robot", robot.name());
  line("links", fmt::format("{}, {} with collision geometry", robot.links().size(), colliding));
  line("joints", joint_counts(robot));
  line("coordinates", fmt::format("{}", coordinates(robot)));
  line("mass", total_text(robot));
  print_tree(robot);
  if (!remarks.empty()) {
    say("  remarks\n");
    for (const std::string& remark : remarks) {
      say("    " + visible(remark) + "\n");
    }
  }
  say("  files\n" + describe_files(reading.files));
  for (const FileReport& report : reading.files) {
    for (const std::string& warning : report.warnings) {
      line("warning", warning);
    }
  }
}

void print_always_in_contact(const RobotModel& robot) {
  for (const LinkPairIndex& pair : touching_links(at_rest(robot))) {
    const char* reason = robot.are_adjacent(pair.link, pair.other) ? "Adjacent" : "Default";
    say(visible(fmt::format("<disable_collisions link1=\"{}\" link2=\"{}\" reason=\"{}\"/>",
                            robot.links()[pair.link].name, robot.links()[pair.other].name,
                            reason)) +
        "\n");
  }
}

}  // namespace firstcontact::app
