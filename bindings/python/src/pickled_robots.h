/// @file
/// States of what a check of robots answered, for pickling.

#pragma once

#include <pybind11/pybind11.h>

#include <firstcontact/robot_check/check_robots.h>

namespace firstcontact::python {

pybind11::tuple state_of(const RobotCheckResult& result);
RobotCheckResult robot_check_result_from(const pybind11::tuple& state);

}  // namespace firstcontact::python
