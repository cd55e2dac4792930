/// @file
/// The parts of the module, one for each module of the library.
///
/// Their order is such that each names only known classes.

#pragma once

#include <pybind11/pybind11.h>

namespace firstcontact::python {

void bind_errors(pybind11::module_& m);
void bind_motion(pybind11::module_& m);
void bind_geometry(pybind11::module_& m);
void bind_narrowphase(pybind11::module_& m);
void bind_query(pybind11::module_& m);
void bind_scene(pybind11::module_& m);
void bind_result(pybind11::module_& m);
void bind_check_jobs(pybind11::module_& m);
void bind_robot_model(pybind11::module_& m);
void bind_trajectory(pybind11::module_& m);
void bind_robot_scene(pybind11::module_& m);
void bind_run(pybind11::module_& m);
void bind_simulator(pybind11::module_& m);
void bind_haptics(pybind11::module_& m);
void bind_verification(pybind11::module_& m);
void bind_planning(pybind11::module_& m);
void bind_retiming(pybind11::module_& m);

/// Lets functions refuse objects that `__new__` alone has made. Call it after all classes.
void refuse_unmade_objects(pybind11::module_& m);

}  // namespace firstcontact::python
