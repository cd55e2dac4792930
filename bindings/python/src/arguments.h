/// @file
/// Arguments of any type, converted to the expected type or refused by their name.

#pragma once

#include <filesystem>
#include <string>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace firstcontact::python {

/// @throws pybind11::type_error  "name: expected `what`, got TYPE"
[[noreturn]] inline void refuse_type(pybind11::handle value, const std::string& name,
                                     const std::string& what) {
  const auto type = pybind11::str(pybind11::type::handle_of(value).attr("__name__"));
  throw pybind11::type_error(name + ": expected " + what + ", got " + std::string(type));
}

/// Converts an argument to a type of C++.
///
/// @param name  name of the argument, for complaints
/// @param what  the expected kind, for complaints: "a path"
/// @throws pybind11::type_error  where it is another kind
template <typename T>
T argument(pybind11::handle value, const std::string& name, const std::string& what) {
  try {
    return value.cast<T>();
  } catch (const pybind11::cast_error&) {
    refuse_type(value, name, what);
  }
}

/// Requires a factor of limits.
///
/// @throws pybind11::value_error  it is not in (0, 1]
inline void require_scaling(double number, const std::string& name) {
  if (!(number > 0.0 && number <= 1.0)) {
    throw pybind11::value_error(name + ": expected a number in (0, 1], got " +
                                std::string(pybind11::repr(pybind11::float_(number))));
  }
}

}  // namespace firstcontact::python
