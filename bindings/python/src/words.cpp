#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

py::handle member(const char* enumeration, const char* word) {
  return py::module_::import("firstcontact._words").attr(enumeration)(word).release();
}

py::object tuple_type(const char* name) {
  return py::module_::import("firstcontact._tuples").attr(name);
}

void refuse_word(const char* enumeration, const char* const* words, std::size_t count,
                 const std::string& got) {
  std::string text = std::string(enumeration) + ": expected one of ";
  for (std::size_t k = 0; k < count; ++k) {
    text += std::string(k > 0 ? ", " : "") + '"' + words[k] + '"';
  }
  throw py::value_error(text + ", got \"" + got + '"');
}

}  // namespace firstcontact::python
