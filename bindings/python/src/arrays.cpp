#include "arrays.h"

#include <cstring>
#include <memory>
#include <string>
#include <utility>

namespace firstcontact::python {

namespace py = pybind11;

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double), "points are rows of n×3 arrays");

namespace {

std::string shape_text(const py::array& array) { return py::str(py::tuple(array.attr("shape"))); }

[[noreturn]] void refuse(const char* name, const std::string& expected, const std::string& got) {
  throw py::value_error(std::string(name) + ": expected " + expected + ", got " + got);
}

/// An array of numbers of the given kinds.
py::array array_from(py::handle value, const char* name, const std::string& kinds,
                     const std::string& expected) {
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    refuse(name, expected, "rows of different lengths, or no array at all");
  }
  if (array.size() > 0 && kinds.find(array.dtype().kind()) == std::string::npos) {
    const std::string message = std::string(name) + ": expected " + expected +
                                ", got an array of dtype " + std::string(py::str(array.dtype()));
    throw py::type_error(message);
  }
  return array;
}

py::array_t<double> doubles_from(py::handle value, const char* name, const std::string& expected) {
  return py::array_t<double, py::array::c_style | py::array::forcecast>(
      array_from(value, name, "iuf", expected));
}

template <typename Row>
std::vector<Row> rows_of(const py::array& array) {
  std::vector<Row> rows(static_cast<std::size_t>(array.shape(0)));
  if (!rows.empty()) {
    std::memcpy(static_cast<void*>(rows.data()), array.data(), sizeof(Row) * rows.size());
  }
  return rows;
}

py::array read_only(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <typename Row>
py::array three_columns(const std::vector<Row>& rows, py::handle owner) {
  using Number = typename Row::value_type;
  return py::array_t<Number>({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}},
                             reinterpret_cast<const Number*>(rows.data()), owner);
}

template <typename Element>
py::capsule keep(std::unique_ptr<std::vector<Element>> data) {
  return py::capsule(data.release(),
                     [](void* kept) { delete static_cast<std::vector<Element>*>(kept); });
}

template <typename Row>
py::array owning_rows(std::vector<Row> rows) {
  auto data = std::make_unique<std::vector<Row>>(std::move(rows));
  const std::vector<Row>& kept = *data;
  return three_columns(kept, keep(std::move(data)));
}

/// Whether it is a pair or a triple of plain floats, which needs no array.
bool read_plain(py::handle value, double* numbers, py::ssize_t count) {
  if (!PyTuple_Check(value.ptr()) || PyTuple_GET_SIZE(value.ptr()) != count) {
    return false;
  }
  for (py::ssize_t k = 0; k < count; ++k) {
    PyObject* element = PyTuple_GET_ITEM(value.ptr(), k);
    if (!PyFloat_Check(element) && !PyLong_CheckExact(element)) {
      return false;
    }
    numbers[k] = PyFloat_AsDouble(element);
  }
  if (PyErr_Occurred() != nullptr) {  // A whole number beyond all doubles.
    throw py::error_already_set();
  }
  return true;
}

void read_numbers(py::handle value, const char* name, double* numbers, py::ssize_t count) {
  if (read_plain(value, numbers, count)) {
    return;
  }
  const std::string expected = std::to_string(count) + " numbers";
  const auto array = doubles_from(value, name, expected);
  if (array.ndim() != 1 || array.shape(0) != count) {
    refuse(name, expected, "an array of shape " + shape_text(array));
  }
  std::memcpy(numbers, array.data(), sizeof(double) * static_cast<std::size_t>(count));
}

}  // namespace

Eigen::Vector3d vector_from(py::handle value, const char* name) {
  Eigen::Vector3d vector;
  read_numbers(value, name, vector.data(), 3);
  return vector;
}

Eigen::Vector2d vector2_from(py::handle value, const char* name) {
  Eigen::Vector2d vector;
  read_numbers(value, name, vector.data(), 2);
  return vector;
}

std::vector<double> numbers_from(py::handle value, const char* name) {
  const auto array = doubles_from(value, name, "n numbers");
  if (array.ndim() != 1) {
    refuse(name, "an array of shape (n,)", "shape " + shape_text(array));
  }
  return {array.data(), array.data() + array.size()};
}

std::vector<Eigen::Vector3d> points_from(py::handle value, const char* name) {
  const auto array = doubles_from(value, name, "n×3 numbers");
  if (array.ndim() != 2 || array.shape(1) != 3) {
    refuse(name, "an array of shape (n, 3), one point per row", "shape " + shape_text(array));
  }
  return rows_of<Eigen::Vector3d>(array);
}

py::array_t<double> matrix_from(py::handle value, const char* name) {
  auto array = doubles_from(value, name, "rows of numbers");
  if (array.ndim() != 2) {
    refuse(name, "an array of two dimensions", "shape " + shape_text(array));
  }
  return array;
}

Triangles triangles_from(py::handle value, const char* name) {
  const py::array array = array_from(value, name, "iu", "m×3 whole numbers");
  if (array.ndim() != 2 || array.shape(1) != 3) {
    refuse(name, "an array of shape (m, 3), three vertices per row", "shape " + shape_text(array));
  }
  if (array.dtype().equal(py::dtype::of<std::uint32_t>()) || array.size() == 0) {
    return rows_of<std::array<std::uint32_t, 3>>(
        py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>(array));
  }
  const py::object least = array.attr("min")();
  const py::object greatest = array.attr("max")();
  if (least < py::int_(0) || greatest > py::int_(0xffffffffu)) {
    refuse(name, "rows of vertices, from 0 on",
           "numbers from " + std::string(py::str(least)) + " to " + std::string(py::str(greatest)));
  }
  return rows_of<std::array<std::uint32_t, 3>>(
      py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>(array));
}

Mesh mesh_from(py::handle value) {
  if (!PyTuple_Check(value.ptr()) || PyTuple_GET_SIZE(value.ptr()) != 2) {
    throw py::type_error("mesh: expected a pair (vertices, triangles), got " +
                         std::string(Py_TYPE(value.ptr())->tp_name));
  }
  return {.vertices = points_from(PyTuple_GET_ITEM(value.ptr(), 0), "vertices"),
          .triangles = triangles_from(PyTuple_GET_ITEM(value.ptr(), 1), "triangles")};
}

py::array view(const std::vector<Eigen::Vector3d>& points, py::handle owner) {
  return read_only(three_columns(points, owner));
}

py::array view(const Triangles& triangles, py::handle owner) {
  return read_only(three_columns(triangles, owner));
}

py::array view(std::span<const double> numbers, py::handle owner) {
  return read_only(
      py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data(), owner));
}

py::array owning(std::vector<Eigen::Vector3d> points) { return owning_rows(std::move(points)); }

py::array owning(Triangles triangles) { return owning_rows(std::move(triangles)); }

py::array owning(std::vector<double> numbers) {
  auto data = std::make_unique<std::vector<double>>(std::move(numbers));
  const std::vector<double>& kept = *data;
  return py::array_t<double>(static_cast<py::ssize_t>(kept.size()), kept.data(),
                             keep(std::move(data)));
}

py::object mesh_tuple(py::array vertices, py::array triangles) {
  return py::module_::import("firstcontact._tuples")
      .attr("Mesh")(std::move(vertices), std::move(triangles));
}

py::array copied(const Eigen::Vector3d& vector) {
  return py::array_t<double>(py::ssize_t{3}, vector.data());
}

}  // namespace firstcontact::python
