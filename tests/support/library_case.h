/// @file
/// Asks the library a question of the oracle, and judges its answer.

#pragma once

#include <string>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/query/first_contact.h>

#include "support/first_contact_oracle.h"
#include "support/generated_case.h"

namespace firstcontact::oracle {

Shape to_shape(const MovingSoup& soup);
Motion to_motion(const MotionInput& input);
/// Rigid or deforming, as the soup is.
DeformingBody to_body(const MovingSoup& soup);

/// The library's answer to a case; without the contact state.
FirstContactResult ask_library(const GeneratedCase& c, Workspace& workspace);

/// What is wrong, with the answer and the truth.
std::string describe(const char* what, const FirstContactResult& answer, const Truth& truth);

/// What is wrong with an answer's verdict and time, whatever was asked: a missed contact, one too
/// late, nothing decided. Empty where nothing is.
std::string verdict_complaint(const FirstContactResult& answer, const Truth& truth);

/// What is wrong with an answer; empty where it keeps every promise:
/// no missed contact, none too late, none farther than margin + tolerance, decided, as asked.
std::string complaint(const GeneratedCase& c, const FirstContactResult& answer, const Truth& truth);

/// The same, and what differs when A and B are swapped.
std::string complaint_either_way(const GeneratedCase& c, const FirstContactResult& answer,
                                 const Truth& truth, Workspace& workspace);

}  // namespace firstcontact::oracle
