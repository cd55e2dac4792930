/// @file
/// Motions of Python.

#pragma once

#include <pybind11/pybind11.h>

#include <firstcontact/motion/motion.h>

namespace firstcontact::python {

/// A motion and the call that made it, by which it is pickled.
struct RecordedMotion {
  Motion motion;
  const char* factory;
  pybind11::tuple arguments;
};

}  // namespace firstcontact::python
