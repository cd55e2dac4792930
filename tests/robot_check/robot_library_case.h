/// @file
/// Asks the library a question about links that the oracle answered, and judges its answer.

#pragma once

#include <string>

#include <firstcontact/robot_check/link_contact.h>

#include "support/first_contact_oracle.h"
#include "support/robot_input.h"

namespace firstcontact::oracle {

/// The library's answer to a case; with A and B swapped where asked for.
FirstContactResult ask_library(const RobotCase& c, bool swapped, Workspace& workspace);

/// What is wrong with an answer; empty where it keeps every promise: no missed contact, none too
/// late, none farther than margin + tolerance, decided, as precisely as asked.
std::string complaint(const RobotCase& c, const FirstContactResult& answer, const Truth& truth);

}  // namespace firstcontact::oracle
