/// @file
/// The names of SRDF: those that are read, and those that belong to other tools.

#pragma once

#include <firstcontact/text/xml_names.h>

namespace firstcontact::detail {

/// The names that each element may hold.
struct SrdfNames {
  XmlContents robot;
  XmlContents pair;  ///< Disabled and enabled collisions.
  XmlContents link;  ///< Links that are disabled by default.
  XmlContents group;
  XmlContents member;  ///< Links, joints and groups of a group.
  XmlContents chain;
  XmlContents state;
  XmlContents value;  ///< Value of a joint in a state.
  XmlContents effector;
  TellingNames telling;
};

[[nodiscard]] const SrdfNames& srdf_names();

}  // namespace firstcontact::detail
