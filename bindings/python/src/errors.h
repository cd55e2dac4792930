/// @file
/// Errors of the library as exceptions of Python.

#pragma once

#include <exception>
#include <filesystem>

#include <pybind11/pybind11.h>

namespace firstcontact::python {

/// The Python exception of an exception that the library threw; the GIL is held.
pybind11::object exception_from(const std::exception_ptr& error);

/// @throws std::filesystem::filesystem_error, in Python a FileNotFoundError, where there is no such
///         file
void require_file(const std::filesystem::path& path);

}  // namespace firstcontact::python
