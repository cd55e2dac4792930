/// @file
/// Motions of Python.

#pragma once

#include <pybind11/pybind11.h>
#include <Eigen/Geometry>

#include <firstcontact/motion/motion.h>

namespace firstcontact::python {

/// A motion and the call that made it, by which it is pickled.
struct RecordedMotion {
  Motion motion;
  const char* factory;
  pybind11::tuple arguments;
};

/// Four numbers w, x, y, z; of any length.
///
/// @throws pybind11::type_error, pybind11::value_error
Eigen::Quaterniond quaternion_from(pybind11::handle value);

}  // namespace firstcontact::python
