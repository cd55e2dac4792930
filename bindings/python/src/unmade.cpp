#include <algorithm>
#include <cstddef>
#include <vector>

#include <pybind11/pybind11.h>

#include "bindings.h"

namespace firstcontact::python {
namespace {

namespace py = pybind11;

/// pybind11 calls it for an argument whose object holds no value, and would leave its memory as it
/// is.
void* refuse(std::size_t /*size*/) {
  throw py::type_error("this object was made by __new__ alone: its __init__ was not called");
}

void refuse_in(py::handle scope, std::vector<PyObject*>& known) {
  const py::dict names = py::dict(scope.attr("__dict__"));
  for (const auto& [name, value] : names) {
    if (!PyType_Check(value.ptr()) ||
        std::find(known.begin(), known.end(), value.ptr()) != known.end()) {
      continue;
    }
    known.push_back(value.ptr());
    if (py::detail::type_info* const type =
            py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr()))) {
      type->operator_new = &refuse;
      refuse_in(value, known);
    }
  }
}

}  // namespace

void refuse_unmade_objects(py::module_& m) {
  std::vector<PyObject*> known;
  refuse_in(m, known);
}

}  // namespace firstcontact::python
