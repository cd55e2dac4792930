/// @file
/// Runs of Python.

#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include <firstcontact/record/run.h>

namespace firstcontact::python {

/// The names of the bodies of a run, in order.
pybind11::tuple names_of(const RunHeader& header);

/// The line of a run's header or step, without its line feed.
std::string without_line_feed(std::string line);

}  // namespace firstcontact::python
