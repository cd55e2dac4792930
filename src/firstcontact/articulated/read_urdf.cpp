#include <firstcontact/articulated/read_urdf.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/articulated/detail/mesh_uri.h>
#include <firstcontact/motion/rotation_forms.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_text_file.h>
#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact {
namespace {

using detail::XmlElement;
using detail::XmlReader;

struct TypeWord {
  const char* word;
  JointType type;
};
constexpr std::array<TypeWord, 9> kTypes = {{{"fixed", JointType::fixed},
                                             {"revolute", JointType::revolute},
                                             {"continuous", JointType::continuous},
                                             {"prismatic", JointType::prismatic},
                                             {"planar", JointType::planar},
                                             {"floating", JointType::floating},
                                             {"screw", JointType::screw},
                                             {"ball", JointType::ball},
                                             {"spherical", JointType::ball}}};

/// Walks one document.
class UrdfReader {
 public:
  UrdfReader(std::string_view text, const std::filesystem::path& source, const UrdfOptions& options)
      : xml_(text, source.string()),
        source_(source),
        options_(options),
        log_(source.string(), "URDF", options.reading) {}

  RobotReading robot() {
    const XmlElement& root = xml_.root("robot");
    RobotDescription robot;
    robot.name = xml_.text(root, "name");
    const std::vector<const XmlElement*> links = xml_.children(root, "link");
    const std::vector<const XmlElement*> joints = xml_.children(root, "joint");
    for (const XmlElement* element : links) {
      robot.links.push_back(link(*element));
    }
    for (const XmlElement* element : joints) {
      robot.joints.push_back(joint(*element));
    }
    if (const std::optional<RobotDefect> defect = find_defect(robot)) {
      const XmlElement& where = defect->joint  ? *joints[*defect->joint]
                                : defect->link ? *links[*defect->link]
                                               : root;
      xml_.fail(where, defect->message);
    }
    log_.add_content("links", robot.links.size());
    log_.add_content("joints", robot.joints.size());
    std::vector<FileReport> files = {log_.finish()};
    files.insert(files.end(), mesh_files_.begin(), mesh_files_.end());
    return {RobotModel(std::move(robot)), std::move(files)};
  }

 private:
  Link link(const XmlElement& element) {
    xml_.expect_only(element, {"name", "type"},
                     {"inertial", "visual", "collision", "material", "verbose", "contact", "sensor",
                      "collision_checking", "self_collision_checking"});
    Link link;
    link.name = xml_.text(element, "name");
    for (const XmlElement* piece : xml_.children(element, "visual")) {
      xml_.expect_only(*piece, {"name"}, {"origin", "geometry", "material"});
      link.visual.push_back(geometry(*piece, options_.shapes == LoadShapes::all));
    }
    for (const XmlElement* piece : xml_.children(element, "collision")) {
      xml_.expect_only(*piece, {"name", "group", "concave"},
                       {"origin", "geometry", "verbose", "contact_coefficients"});
      link.collision.push_back(geometry(*piece, options_.shapes != LoadShapes::none));
    }
    if (const XmlElement* inertial = xml_.child(element, "inertial")) {
      link.inertia = inertia(*inertial);
    }
    return link;
  }

  LinkInertia inertia(const XmlElement& element) {
    const Pose X_LC = origin(element);
    LinkInertia inertia{.p_LC = X_LC.position};
    if (const XmlElement* mass = xml_.child(element, "mass")) {
      inertia.mass = xml_.number(*mass, "value");
    }
    if (const XmlElement* moments = xml_.child(element, "inertia")) {
      const auto moment = [&](const char* name) {
        return xml_.optional_number(*moments, name).value_or(0.0);
      };
      Eigen::Matrix3d about_C;
      about_C << moment("ixx"), moment("ixy"), moment("ixz"),  //
          moment("ixy"), moment("iyy"), moment("iyz"),         //
          moment("ixz"), moment("iyz"), moment("izz");
      const Eigen::Matrix3d R_LC = X_LC.rotation.toRotationMatrix();
      inertia.about_C_L = R_LC * about_C * R_LC.transpose();
    }
    return inertia;
  }

  LinkGeometry geometry(const XmlElement& element, bool load) {
    LinkGeometry result;
    if (const char* name = element.Attribute("name")) {
      result.name = name;
    }
    result.X_LG = origin(element);
    const XmlElement& holder = xml_.required_child(element, "geometry");
    xml_.expect_only(holder, {}, {"mesh", "box", "sphere", "cylinder", "capsule"});
    const XmlElement* source = holder.FirstChildElement();
    if (source == nullptr || source->NextSiblingElement() != nullptr) {
      xml_.fail(holder, "expected one of mesh, box, sphere, cylinder, capsule inside");
    }
    result.source = geometry_source(*source);
    if (load) {
      result.shape = shape(*source, result.source);
    }
    return result;
  }

  GeometrySource geometry_source(const XmlElement& element) const {
    const std::string_view kind = element.Name();
    if (kind == "mesh") {
      return mesh(element);
    }
    if (kind == "box") {
      xml_.expect_only(element, {"size"}, {});
      const Eigen::Vector3d size = xml_.vector3(element, "size");
      if (!(size.minCoeff() > 0.0)) {
        xml_.fail(element, "expected three numbers > 0 in 'size'");
      }
      return BoxGeometry{size};
    }
    if (kind == "sphere") {
      xml_.expect_only(element, {"radius"}, {});
      return SphereGeometry{xml_.positive(element, "radius")};
    }
    xml_.expect_only(element, {"radius", "length"}, {});
    const double radius = xml_.positive(element, "radius");
    const double length = xml_.positive(element, "length");
    return kind == "cylinder" ? GeometrySource(CylinderGeometry{radius, length})
                              : GeometrySource(CapsuleGeometry{radius, length});
  }

  MeshGeometry mesh(const XmlElement& element) const {
    xml_.expect_only(element, {"filename", "scale"}, {});
    MeshGeometry mesh;
    try {
      mesh.path =
          detail::resolve_mesh(xml_.text(element, "filename"), source_, options_.package_roots);
    } catch (const std::invalid_argument& error) {
      xml_.fail(element, error.what());
    }
    if (element.Attribute("scale") != nullptr) {
      mesh.scale = xml_.vector3(element, "scale");
      if ((mesh.scale.array() == 0.0).any()) {
        xml_.fail(element, "expected no 0 in 'scale': it flattens the mesh");
      }
    }
    return mesh;
  }

  /// Errors in a mesh file keep their own place; all others get that of the element.
  Shape shape(const XmlElement& element, const GeometrySource& source) {
    const auto* mesh = std::get_if<MeshGeometry>(&source);
    try {
      if (mesh == nullptr) {
        return make_shape(source);
      }
      const Eigen::Vector3d& s = mesh->scale;
      const MeshKey key{mesh->path, {s.x(), s.y(), s.z()}};
      const auto known = meshes_.find(key);
      return known != meshes_.end() ? known->second
                                    : meshes_.emplace(key, read_mesh_shape(source)).first->second;
    } catch (const std::invalid_argument& error) {
      xml_.fail(element, error.what());
    } catch (const ParseError& error) {
      if (std::filesystem::exists(mesh->path)) {
        throw;
      }
      xml_.fail(element, "mesh file " + mesh->path.string() + " does not exist");
    }
  }

  /// Notes the report of a file that is read for the first time, at whatever scale.
  Shape read_mesh_shape(const GeometrySource& source) {
    ShapeReading reading = read_shape(source, options_.reading);
    const auto is_same = [&](const FileReport& file) { return file.path == reading.report->path; };
    if (std::none_of(mesh_files_.begin(), mesh_files_.end(), is_same)) {
      mesh_files_.push_back(std::move(*reading.report));
    }
    return std::move(reading.shape);
  }

  Pose origin(const XmlElement& element) const {
    Pose pose;
    const XmlElement* origin = xml_.child(element, "origin");
    if (origin == nullptr) {
      return pose;
    }
    xml_.expect_only(*origin, {"xyz", "rpy"}, {});
    if (origin->Attribute("xyz") != nullptr) {
      pose.position = xml_.vector3(*origin, "xyz");
    }
    if (origin->Attribute("rpy") != nullptr) {
      pose.rotation = rotation_from_rpy(xml_.vector3(*origin, "rpy"));
    }
    return pose;
  }

  Joint joint(const XmlElement& element) const {
    xml_.expect_only(element, {"name", "type", "pitch"},
                     {"origin", "parent", "child", "axis", "calibration", "dynamics", "limit",
                      "mimic", "safety_controller", "hardwareInterface"});
    Joint joint;
    joint.name = xml_.text(element, "name");
    joint.type = type(element);
    joint.parent = link_name(element, "parent");
    joint.child = link_name(element, "child");
    joint.X_PJ = origin(element);
    if (const XmlElement* axis = xml_.child(element, "axis")) {
      xml_.expect_only(*axis, {"xyz"}, {});
      joint.axis = xml_.vector3(*axis, "xyz");
      // Tools write a zero axis for joints that have none.
      if (joint.axis.isZero(0.0) &&
          (joint.type == JointType::fixed || joint.type == JointType::floating ||
           joint.type == JointType::ball)) {
        joint.axis = Eigen::Vector3d::UnitX();
      }
    }
    if (joint.type == JointType::screw) {
      joint.pitch = xml_.number(element, "pitch");
    } else if (element.Attribute("pitch") != nullptr) {
      xml_.fail(element, "'pitch' belongs to joints of type screw");
    }
    joint.limits = limits(element, joint.type);
    joint.mimic = mimic(element);
    if (const XmlElement* dynamics = xml_.child(element, "dynamics")) {
      joint.damping = xml_.optional_number(*dynamics, "damping").value_or(0.0);
      joint.friction = xml_.optional_number(*dynamics, "friction").value_or(0.0);
    }
    return joint;
  }

  JointType type(const XmlElement& element) const {
    const std::string word = xml_.text(element, "type");
    std::string known;
    for (const TypeWord& entry : kTypes) {
      if (word == entry.word) {
        return entry.type;
      }
      known += (known.empty() ? "" : ", ") + std::string(entry.word);
    }
    xml_.fail(element, "unknown joint type '" + word + "'; known are: " + known);
  }

  std::string link_name(const XmlElement& joint, const char* role) const {
    const XmlElement& element = xml_.required_child(joint, role);
    xml_.expect_only(element, {"link"}, {});
    return xml_.text(element, "link");
  }

  JointLimits limits(const XmlElement& joint, JointType type) const {
    const bool bounded = type == JointType::revolute || type == JointType::prismatic;
    const XmlElement* element = xml_.child(joint, "limit");
    if (element == nullptr) {
      if (bounded) {
        xml_.fail(joint, "expected an element <limit> inside: the joint is " +
                             std::string(to_string(type)));
      }
      return {};
    }
    xml_.expect_only(*element, {"lower", "upper", "velocity", "effort"}, {});
    JointLimits limits;
    limits.lower = xml_.optional_number(*element, "lower");
    limits.upper = xml_.optional_number(*element, "upper");
    limits.velocity = xml_.optional_number(*element, "velocity");
    limits.effort = xml_.optional_number(*element, "effort");
    if (bounded) {  // Both are 0 where they are left out.
      limits.lower = limits.lower.value_or(0.0);
      limits.upper = limits.upper.value_or(0.0);
    } else if (type == JointType::continuous) {  // They have no meaning there.
      limits.lower.reset();
      limits.upper.reset();
    }
    return limits;
  }

  std::optional<Mimic> mimic(const XmlElement& joint) const {
    const XmlElement* element = xml_.child(joint, "mimic");
    if (element == nullptr) {
      return {};
    }
    xml_.expect_only(*element, {"joint", "multiplier", "offset"}, {});
    return Mimic{.joint = xml_.text(*element, "joint"),
                 .multiplier = xml_.optional_number(*element, "multiplier").value_or(1.0),
                 .offset = xml_.optional_number(*element, "offset").value_or(0.0)};
  }

  using MeshKey = std::pair<std::filesystem::path, std::array<double, 3>>;

  XmlReader xml_;
  const std::filesystem::path& source_;
  const UrdfOptions& options_;
  detail::ReadingLog log_;
  std::map<MeshKey, Shape> meshes_;
  std::vector<FileReport> mesh_files_;
};

}  // namespace

RobotReading read_robot(const std::filesystem::path& path, const UrdfOptions& options) {
  return parse_robot(detail::read_text_file(path), path, options);
}

RobotReading parse_robot(std::string_view text, const std::filesystem::path& source,
                         const UrdfOptions& options) {
  return UrdfReader(text, source, options).robot();
}

RobotModel read_urdf(const std::filesystem::path& path, const UrdfOptions& options) {
  return read_robot(path, options).model;
}

RobotModel parse_urdf(std::string_view text, const std::filesystem::path& source,
                      const UrdfOptions& options) {
  return parse_robot(text, source, options).model;
}

}  // namespace firstcontact
