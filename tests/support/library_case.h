/// @file
/// Passes a question of the oracle to the library, and checks its answer.

#pragma once

#include <string>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/query/first_contact.h>

#include "support/first_contact_oracle.h"
#include "support/generated_case.h"

namespace firstcontact::oracle {

Shape to_shape(const MovingSoup& soup);
Motion to_motion(const MotionInput& input);
/// Makes a rigid or deforming body, as the soup is.
DeformingBody to_body(const MovingSoup& soup);

/// Returns the library's answer to a case, without the contact state.
FirstContactResult ask_library(const GeneratedCase& c, Workspace& workspace);

/// Describes an error, with the answer and the truth.
std::string describe(const char* what, const FirstContactResult& answer, const Truth& truth);

/// Returns the error of an answer's verdict and time, for any options; empty where it is correct.
///
/// Errors are a missed contact, one too late, and an open verdict.
std::string verdict_complaint(const FirstContactResult& answer, const Truth& truth);

/// Returns the error of an answer; empty where it keeps every promise.
///
/// The promises: no missed contact, none too late, none farther than margin + tolerance, a decided
/// verdict, and the parts that the options request.
std::string complaint(const GeneratedCase& c, const FirstContactResult& answer, const Truth& truth);

/// Returns the same, or the difference when A and B are swapped.
std::string complaint_either_way(const GeneratedCase& c, const FirstContactResult& answer,
                                 const Truth& truth, Workspace& workspace);

}  // namespace firstcontact::oracle
