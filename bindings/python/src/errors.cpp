#include "errors.h"

#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <pybind11/stl.h>

#include <firstcontact/text/parse_error.h>

#include "bindings.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

py::object parse_error(const ParseError& error) {
  return py::module_::import("firstcontact._errors")
      .attr("ParseError")(error.what(), error.path(), error.message(), error.line(),
                          error.offset());
}

py::object os_error(const std::filesystem::filesystem_error& error) {
  const std::error_code& code = error.code();
  return py::handle(PyExc_OSError)(code.value(), code.message(), error.path1().string());
}

void raise(const py::object& exception) {
  PyErr_SetObject(py::type::handle_of(exception).ptr(), exception.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) {
      std::rethrow_exception(pointer);
    }
  } catch (const ParseError&) {
    raise(exception_from(pointer));
  } catch (const std::filesystem::filesystem_error&) {
    raise(exception_from(pointer));
  }
}

}  // namespace

py::object exception_from(const std::exception_ptr& pointer) {
  try {
    std::rethrow_exception(pointer);
  } catch (const ParseError& error) {
    return parse_error(error);
  } catch (const std::filesystem::filesystem_error& error) {
    return os_error(error);
  } catch (const std::invalid_argument& error) {
    return py::handle(PyExc_ValueError)(error.what());
  } catch (const std::bad_alloc&) {
    return py::handle(PyExc_MemoryError)("not enough memory to answer this");
  } catch (const std::exception& error) {
    return py::handle(PyExc_RuntimeError)(error.what());
  }
}

void require_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw std::filesystem::filesystem_error(
        "expected a file", path, std::make_error_code(std::errc::no_such_file_or_directory));
  }
}

void bind_errors(py::module_& /*m*/) { py::register_exception_translator(translate); }

}  // namespace firstcontact::python
