/// @file
/// The names of URDF: which are read, which say nothing of contacts, which tell of geometry.

#pragma once

#include <firstcontact/text/xml_names.h>

namespace firstcontact::detail {

/// The names that each element may hold.
struct UrdfNames {
  XmlContents robot;
  XmlContents link;
  XmlContents inertial;
  XmlContents mass;
  XmlContents inertia;
  XmlContents collision;
  XmlContents visual;
  XmlContents geometry;
  XmlContents mesh;
  XmlContents box;
  XmlContents sphere;
  XmlContents round;  ///< Cylinders and capsules.
  XmlContents origin;
  XmlContents joint;
  XmlContents link_name;  ///< Parent and child.
  XmlContents axis;
  XmlContents limit;
  XmlContents mimic;
  XmlContents dynamics;
  TellingNames telling;
};

/// URDF 1.2 with what Gazebo, Drake, MuJoCo, Bullet and ROS write into it.
[[nodiscard]] const UrdfNames& urdf_names();

}  // namespace firstcontact::detail
