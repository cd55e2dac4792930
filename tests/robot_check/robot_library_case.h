/// @file
/// Passes a question about links to the library, and checks its answer by that of the oracle.

#pragma once

#include <string>

#include <firstcontact/robot_check/link_contact.h>

#include "support/first_contact_oracle.h"
#include "support/robot_input.h"

namespace firstcontact::oracle {

/// Returns the library's answer to a case; with A and B swapped where `swapped`.
FirstContactResult ask_library(const RobotCase& c, bool swapped, Workspace& workspace);

/// Returns the error of an answer; empty where it keeps every promise.
///
/// The promises: no missed contact, none too late, none farther than margin + tolerance, a decided
/// verdict, and the requested precision.
std::string complaint(const RobotCase& c, const FirstContactResult& answer, const Truth& truth);

}  // namespace firstcontact::oracle
