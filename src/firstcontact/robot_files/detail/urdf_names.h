/// @file
/// The names of URDF: those that are read, those without geometry, and those that report geometry.

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

/// The names of URDF 1.2, with those of Gazebo, Drake, MuJoCo, Bullet and ROS.
[[nodiscard]] const UrdfNames& urdf_names();

}  // namespace firstcontact::detail
