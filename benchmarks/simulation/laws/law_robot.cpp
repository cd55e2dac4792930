#include "benchmarks/simulation/laws/law_robot.h"

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>

#include <tinyxml2.h>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using tinyxml2::XMLElement;

Vector3d three(const XMLElement* element, const char* key, const Vector3d& absent) {
  const char* text = element == nullptr ? nullptr : element->Attribute(key);
  if (text == nullptr) {
    return absent;
  }
  Vector3d v;
  std::istringstream(text) >> v.x() >> v.y() >> v.z();
  return v;
}

Vector3d origin_of(const XMLElement& element) {
  const XMLElement* origin = element.FirstChildElement("origin");
  if (!three(origin, "rpy", Vector3d::Zero()).isZero()) {
    throw NotForPeer();
  }
  return three(origin, "xyz", Vector3d::Zero());
}

LawShape shape_of(const XMLElement& collision) {
  const XMLElement* geometry = collision.FirstChildElement("geometry");
  LawShape shape{.p_BS = origin_of(collision)};
  if (const XMLElement* box = geometry->FirstChildElement("box")) {
    shape.half = 0.5 * three(box, "size", Vector3d::Zero());
    return shape;
  }
  if (const XMLElement* sphere = geometry->FirstChildElement("sphere")) {
    shape.kind = LawShape::Kind::sphere;
    shape.half.setConstant(sphere->DoubleAttribute("radius"));
    return shape;
  }
  const XMLElement* cylinder = geometry->FirstChildElement("cylinder");
  if (cylinder == nullptr) {
    throw NotForPeer();
  }
  shape.kind = LawShape::Kind::cylinder;
  const double radius = cylinder->DoubleAttribute("radius");
  shape.half = {radius, radius, 0.5 * cylinder->DoubleAttribute("length")};
  return shape;
}

LawLink link_of(const XMLElement& element) {
  LawLink link{.name = element.Attribute("name")};
  if (const XMLElement* inertial = element.FirstChildElement("inertial")) {
    link.p_LC = origin_of(*inertial);
    link.mass = inertial->FirstChildElement("mass")->DoubleAttribute("value");
    const XMLElement* inertia = inertial->FirstChildElement("inertia");
    link.moments = {inertia->DoubleAttribute("ixx"), inertia->DoubleAttribute("iyy"),
                    inertia->DoubleAttribute("izz")};
  }
  for (const XMLElement* c = element.FirstChildElement("collision"); c != nullptr;
       c = c->NextSiblingElement("collision")) {
    link.shapes.push_back(shape_of(*c));
  }
  return link;
}

void set_joint(const XMLElement& joint, LawLink& link) {
  link.joint = joint.Attribute("name");
  const std::string type = joint.Attribute("type");
  if (type != "continuous" && type != "revolute" && type != "prismatic") {
    throw NotForPeer();
  }
  link.is_slide = type == "prismatic";
  link.p_PJ = origin_of(joint);
  link.axis = three(joint.FirstChildElement("axis"), "xyz", Vector3d::UnitX()).normalized();
  if (const XMLElement* dynamics = joint.FirstChildElement("dynamics")) {
    link.damping = dynamics->DoubleAttribute("damping");
  }
}

/// Appends the links on a link, and those on them.
void append_children(const XMLElement& robot, std::size_t parent, std::vector<LawLink>& links) {
  for (const XMLElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    if (links[parent].name != joint->FirstChildElement("parent")->Attribute("link")) {
      continue;
    }
    const std::string child = joint->FirstChildElement("child")->Attribute("link");
    for (const XMLElement* link = robot.FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      if (child == link->Attribute("name")) {
        links.push_back(link_of(*link));
        links.back().parent = static_cast<int>(parent);
        set_joint(*joint, links.back());
        append_children(robot, links.size() - 1, links);
      }
    }
  }
}

}  // namespace

std::vector<LawLink> read_links(const std::filesystem::path& urdf) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(urdf.c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error("cannot read " + urdf.string());
  }
  const XMLElement& robot = *document.RootElement();
  // The scenes name the root link first.
  std::vector<LawLink> links{link_of(*robot.FirstChildElement("link"))};
  append_children(robot, 0, links);
  return links;
}

}  // namespace firstcontact::benchmarks
