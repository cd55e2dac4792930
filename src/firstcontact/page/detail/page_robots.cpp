#include <firstcontact/page/detail/page_robots.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using detail::to_json;

JsonValue to_json(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q = rotation.normalized();
  return {.value = JsonArray{to_json(q.w()), to_json(q.x()), to_json(q.y()), to_json(q.z())}};
}

JsonValue to_json(const Pose& pose) {
  return {.value = JsonObject{{"position", to_json(pose.position)},
                              {"quaternion_wxyz", to_json(pose.rotation)}}};
}

JsonValue to_json(const CoordinateSegment& segment) {
  JsonArray a;
  for (std::size_t j = 0; j < segment.count; ++j) {
    a.push_back(to_json(segment.a[j].hi));
  }
  return {.value = JsonObject{{"until", to_json(segment.t_end)}, {"a", {.value = std::move(a)}}}};
}

/// Writes a path: the pivot moves on a line, the child's origin turns about it.
JsonValue to_json(const ConstantRatePath& path) {
  const ConstantRatePath::State begin = path.state(path.t_begin());
  return {.value = JsonObject{{"until", to_json(path.t_end())},
                              {"pivot", to_json(path.pivot_begin().value())},
                              {"velocity", to_json(path.pivot_velocity().value())},
                              {"axis", to_json(path.axis())},
                              {"rate", to_json(path.rate())},
                              {"lever", to_json(begin.p_QC_W)},
                              {"quaternion_wxyz", to_json(Eigen::Quaterniond(begin.R_WB))}}};
}

JsonValue to_json(const Motion& motion) {
  JsonArray pieces;
  for (std::size_t k = 0; k + 1 < motion.breaks().size(); ++k) {
    pieces.push_back(to_json(motion.path(k, Eigen::Vector3d::Zero())));
  }
  return {.value = std::move(pieces)};
}

JsonValue to_json(std::span<const CoordinateSegment> segments) {
  JsonArray array;
  for (const CoordinateSegment& segment : segments) {
    array.push_back(to_json(segment));
  }
  return {.value = std::move(array)};
}

JsonValue to_json(const JointLimits& limits) {
  JsonObject object;
  const auto add = [&object](const char* name, const std::optional<double>& value) {
    if (value) {
      object.push_back({name, to_json(*value)});
    }
  };
  add("lower", limits.lower);
  add("upper", limits.upper);
  add("velocity", limits.velocity);
  return {.value = std::move(object)};
}

class RobotPage {
  using Color = UrdfColors::mapped_type::value_type;

 public:
  RobotPage(const RobotMotion& motion, const UrdfColors& colors, PageMeshes& meshes,
            std::vector<std::string>& warnings)
      : motion_(motion),
        model_(motion.model()),
        colors_(colors),
        meshes_(meshes),
        warnings_(warnings) {}

  [[nodiscard]] JsonValue write(const std::string& name) {
    JsonArray links;
    for (const Link& link : model_.links()) {
      links.push_back(write(link));
    }
    JsonArray joints;
    for (std::size_t k = 0; k < model_.joints().size(); ++k) {
      joints.push_back(write(k));
    }
    return {.value = JsonObject{{"name", to_json(name)},
                                {"base", to_json(motion_.base())},
                                {"links", {.value = std::move(links)}},
                                {"joints", {.value = std::move(joints)}}}};
  }

 private:
  /// Writes a link, with its looks where they differ from its collision geometry.
  ///
  /// Where they do not differ, their colours stand with the collision geometry.
  JsonValue write(const Link& link) {
    JsonValue collision{.value = write(link.collision, link.name, {})};
    const JsonArray coloured = write(link.visual, link.name, colors_of(link));
    JsonValue visual{.value = coloured};
    const bool differ = write_json(collision) != write_json({.value = without_colors(coloured)});
    JsonObject object{{"name", to_json(link.name)},
                      {"collision", differ ? std::move(collision) : visual}};
    if (differ) {
      object.push_back({"visual", std::move(visual)});
    }
    return {.value = std::move(object)};
  }

  static JsonArray without_colors(JsonArray geometries) {
    for (JsonValue& geometry : geometries) {
      auto& members = std::get<JsonObject>(geometry.value);
      if (!members.empty() && members.back().key == "color") {
        members.pop_back();
      }
    }
    return geometries;
  }

  /// The colour of each visual; empty where the file has other visuals than the model.
  [[nodiscard]] std::vector<Color> colors_of(const Link& link) const {
    const auto found = colors_.find(link.name);
    return found == colors_.end() || found->second.size() != link.visual.size()
               ? std::vector<Color>{}
               : found->second;
  }

  JsonArray write(std::span<const LinkGeometry> geometries, const std::string& link,
                  std::span<const Color> colors) {
    JsonArray array;
    for (std::size_t k = 0; k < geometries.size(); ++k) {
      try {
        array.push_back(write(geometries[k], colors.empty() ? std::nullopt : colors[k]));
      } catch (const std::exception& error) {  // No shape can be made of this file, or with this
                                               // size.
        warnings_.push_back("link " + in_quotes(link) + " is drawn in part: " + error.what());
      }
    }
    return array;
  }

  JsonValue write(const LinkGeometry& geometry, const Color& color) {
    JsonObject object{{"mesh", to_json(meshes_.add(geometry))}, {"pose", to_json(geometry.X_LG)}};
    const double radius = radius_of(geometry);
    if (radius > 0.0) {
      object.push_back({"radius", to_json(radius)});
    }
    if (color) {
      object.push_back({"color", to_json(*color)});
    }
    return {.value = std::move(object)};
  }

  static double radius_of(const LinkGeometry& geometry) {
    if (geometry.shape) {
      return geometry.shape->radius();
    }
    if (const auto* sphere = std::get_if<SphereGeometry>(&geometry.source)) {
      return sphere->radius;
    }
    const auto* capsule = std::get_if<CapsuleGeometry>(&geometry.source);
    return capsule != nullptr ? capsule->radius : 0.0;
  }

  [[nodiscard]] JsonValue write(std::size_t index) const {
    const Joint& joint = model_.joints()[index];
    JsonObject object{{"name", to_json(joint.name)},
                      {"type", to_json(to_string(joint.type))},
                      {"parent", to_json(model_.parent_link(index))},
                      {"child", to_json(model_.child_link(index))},
                      {"pose", to_json(joint.X_PJ)},
                      {"axis", to_json(precise_direction(joint.axis).value())},
                      {"limits", to_json(joint.limits)}};
    if (joint.type == JointType::screw) {
      object.push_back({"pitch", to_json(joint.pitch)});
    }
    if (joint.mimic) {
      object.push_back({"mimics", to_json(joint.mimic->joint)});
    }
    JsonArray coordinates = coordinates_of(index);
    if (!coordinates.empty()) {
      object.push_back({"coordinates", {.value = std::move(coordinates)}});
    }
    const std::optional<JointMotion> given = motion_.given(index);
    if (const auto* motion = given ? std::get_if<Motion>(&*given) : nullptr) {
      object.push_back({"motion", to_json(*motion)});
    }
    return {.value = std::move(object)};
  }

  [[nodiscard]] JsonArray coordinates_of(std::size_t joint) const {
    std::vector<std::vector<CoordinateSegment>> all;
    const std::optional<JointMotion> given = motion_.given(joint);
    if (const auto* planar = given ? std::get_if<PlanarPath>(&*given) : nullptr) {
      for (const CoordinatePath& path : *planar) {
        all.emplace_back(path.segments().begin(), path.segments().end());
      }
    } else if (coordinate_count(model_.joints()[joint].type) == 1) {
      all.push_back(motion_.coordinate(joint));
    }
    JsonArray array;
    for (std::size_t k = 0; k < all.size(); ++k) {
      array.push_back({.value = JsonObject{{"name", to_json(coordinate_name(model_, {joint, k}))},
                                           {"segments", to_json(all[k])}}});
    }
    return array;
  }

  const RobotMotion& motion_;
  const RobotModel& model_;
  const UrdfColors& colors_;
  PageMeshes& meshes_;
  std::vector<std::string>& warnings_;
};

bool is_carried(std::span<const BodyStretch> stretches) {
  return std::any_of(stretches.begin(), stretches.end(), [](const BodyStretch& stretch) {
    return std::holds_alternative<BodyStretch::Carried>(stretch.how);
  });
}

JsonValue to_json(const BodyStretch& stretch, const RobotScene& scene) {
  JsonObject object{{"until", to_json(stretch.t_end)}};
  if (const auto* carried = std::get_if<BodyStretch::Carried>(&stretch.how)) {
    const std::size_t first = scene.first_member(carried->link.robot);
    object.push_back({"link", to_json(first + carried->link.link)});
    object.push_back({"pose", to_json(carried->X_LB)});
  } else if (const auto* resting = std::get_if<BodyStretch::Resting>(&stretch.how)) {
    object.push_back({"pose", to_json(resting->X_WB)});
  }
  return {.value = std::move(object)};
}

}  // namespace

JsonArray robots_of_page(const RobotScene& scene, std::span<const UrdfColors> colors,
                         PageMeshes& meshes, std::vector<std::string>& warnings) {
  JsonArray robots;
  for (std::size_t k = 0; k < scene.robot_count(); ++k) {
    robots.push_back(
        RobotPage(scene.robot_motion(k), colors[k], meshes, warnings).write(scene.robot_name(k)));
  }
  return robots;
}

JsonArray carried_of_page(const RobotScene& scene) {
  JsonArray bodies;
  for (std::size_t member = 0; member < scene.size(); ++member) {
    if (scene.robot_link(member) || !is_carried(scene.stretches(member))) {
      continue;
    }
    JsonArray stretches;
    for (const BodyStretch& stretch : scene.stretches(member)) {
      stretches.push_back(to_json(stretch, scene));
    }
    bodies.push_back({.value = JsonObject{{"body", to_json(member)},
                                          {"stretches", {.value = std::move(stretches)}}}});
  }
  return bodies;
}

}  // namespace firstcontact::detail
