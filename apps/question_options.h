/// @file
/// The options of the command line for the question about every scene.

#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <firstcontact/query/first_contact.h>

#include "scene_answer.h"

namespace firstcontact::app {

/// Adds --margin, --tolerance, --deadline, --lenient, --contacts, --closest, --all-pairs and
/// --all-contacts-in-time.
void add_question_options(CLI::App& command, Question& question);

/// A choice of contacts as on the command line: "none", "first", "all" or a number.
[[nodiscard]] std::string contacts_text(const ContactState& contacts);

}  // namespace firstcontact::app
