#include <firstcontact/robot_files/read_urdf.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/robot_files/detail/read_joint.h>
#include <firstcontact/robot_files/detail/read_link.h>
#include <firstcontact/robot_files/detail/urdf_context.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>

namespace firstcontact {
namespace {

using detail::XmlElement;

/// Walks one document.
class UrdfReader {
 public:
  UrdfReader(std::string_view text, const std::filesystem::path& source, const UrdfOptions& options)
      : xml_(text, source.string()),
        log_(source.string(), "URDF", options.reading),
        names_(xml_, log_, detail::urdf_names().telling),
        context_{xml_, names_, log_, source, options},
        link_reader_(context_) {}

  RobotReading read() {
    const XmlElement& root = xml_.root("robot");
    names_.check(root, detail::urdf_names().robot);
    context_.attempt([&] { read_name(root); });
    check_gazebo(root);
    for (const XmlElement* element : xml_.children(root, "link")) {
      robot_.links.push_back(link_reader_.read(*element, robot_.links.size()));
      links_.push_back(element);
    }
    bool all_joints = true;
    for (const XmlElement* element : xml_.children(root, "joint")) {
      if (std::optional<Joint> joint = detail::read_joint(*element, context_)) {
        robot_.joints.push_back(std::move(*joint));
        joints_.push_back(element);
      } else {
        all_joints = false;
      }
    }
    if (all_joints) {  // Otherwise the elements that hang on a broken joint would report it again.
      find_defects(root);
    }
    log_.throw_errors();
    link_reader_.make_shapes(robot_.links);
    return finish();
  }

 private:
  void read_name(const XmlElement& root) {
    const char* name = root.Attribute("name");
    if (name != nullptr && *name == '\0') {
      log_.warn(xml_.error(root, "the robot's name is empty"));
    } else {
      robot_.name = xml_.text(root, "name");
    }
  }

  /// Checks <gazebo> elements: without a reference Gazebo takes elements of SDF there as parts of
  /// the model.
  void check_gazebo(const XmlElement& root) {
    constexpr std::array<std::string_view, 4> kParts = {"link", "joint", "model", "include"};
    for (const XmlElement* gazebo : xml_.children(root, "gazebo")) {
      for (const XmlElement* part = gazebo->FirstChildElement(); part != nullptr;
           part = part->NextSiblingElement()) {
        if (gazebo->Attribute("reference") == nullptr &&
            std::find(kParts.begin(), kParts.end(), part->Name()) != kParts.end()) {
          log_.refuse(xml_.error(*part, "a part of the robot that only Gazebo knows"));
        }
      }
      log_.leave_out("<gazebo>", "settings of a simulator");
    }
  }

  void find_defects(const XmlElement& root) {
    for (const RobotDefect& defect : firstcontact::find_defects(robot_)) {
      const XmlElement& where = defect.joint  ? *joints_[*defect.joint]
                                : defect.link ? *links_[*defect.link]
                                              : root;
      log_.add_error(xml_.error(where, defect.message));
    }
  }

  RobotReading finish() {
    link_reader_.warn_of_links_that_cannot_touch(robot_.links);
    log_.add_content("links", robot_.links.size());
    log_.add_content("joints", robot_.joints.size());
    std::size_t pieces = 0;
    for (const Link& link : robot_.links) {
      pieces += link.collision.size();
    }
    log_.add_content("geometries that can touch", pieces);
    std::vector<FileReport> files = {log_.finish()};
    const std::vector<FileReport>& meshes = link_reader_.mesh_files();
    files.insert(files.end(), meshes.begin(), meshes.end());
    return {RobotModel(std::move(robot_)), std::move(files)};
  }

  detail::XmlReader xml_;
  detail::ReadingLog log_;
  detail::XmlNameCheck names_;
  detail::UrdfContext context_;
  detail::LinkReader link_reader_;
  RobotDescription robot_;
  std::vector<const XmlElement*> links_;   // Element of each link.
  std::vector<const XmlElement*> joints_;  // Element of each joint.
};

}  // namespace

RobotReading read_robot(const std::filesystem::path& path, const UrdfOptions& options) {
  return parse_robot(detail::read_file(path, "a URDF file"), path, options);
}

RobotReading parse_robot(std::string_view text, const std::filesystem::path& source,
                         const UrdfOptions& options) {
  return UrdfReader(text, source, options).read();
}

RobotModel read_urdf(const std::filesystem::path& path, const UrdfOptions& options) {
  return read_robot(path, options).model;
}

RobotModel parse_urdf(std::string_view text, const std::filesystem::path& source,
                      const UrdfOptions& options) {
  return parse_robot(text, source, options).model;
}

}  // namespace firstcontact
