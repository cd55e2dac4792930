/// @file
/// The options of the command line that ask the same of every scene.

#pragma once

#include <CLI/CLI.hpp>

#include "scene_answer.h"

namespace firstcontact::app {

/// Adds --margin, --tolerance, --deadline, --lenient, --closest and --all-pairs.
void add_question_options(CLI::App& command, Question& question);

}  // namespace firstcontact::app
