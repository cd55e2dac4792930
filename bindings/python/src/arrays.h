/// @file
/// Arrays of numpy: read into the library's types with clear complaints, and handed out as views.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <pybind11/numpy.h>
#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::python {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Three numbers, as a tuple, a list or an array.
///
/// @param name  name of the argument, for complaints
/// @throws pybind11::type_error, pybind11::value_error, as all functions here
Eigen::Vector3d vector_from(pybind11::handle value, const char* name);

/// Two numbers, likewise; the tuple (x, y).
Eigen::Vector2d vector2_from(pybind11::handle value, const char* name);

/// n numbers.
std::vector<double> numbers_from(pybind11::handle value, const char* name);

/// n×3 numbers.
std::vector<Eigen::Vector3d> points_from(pybind11::handle value, const char* name);

/// `rows`×`columns` numbers, row by row.
pybind11::array_t<double> matrix_from(pybind11::handle value, const char* name);

/// n×3 whole numbers below 2^32.
Triangles triangles_from(pybind11::handle value, const char* name);

/// A pair of vertices and triangles.
Mesh mesh_from(pybind11::handle value);

/// Read-only views, without a copy; they keep the owner alive.
pybind11::array view(const std::vector<Eigen::Vector3d>& points, pybind11::handle owner);
pybind11::array view(const Triangles& triangles, pybind11::handle owner);
pybind11::array view(std::span<const double> numbers, pybind11::handle owner);

/// Arrays that own the data of their argument, without a copy.
pybind11::array owning(std::vector<Eigen::Vector3d> points);
pybind11::array owning(Triangles triangles);
pybind11::array owning(std::vector<double> numbers);

/// A Mesh of firstcontact/_tuples.py.
pybind11::object mesh_tuple(pybind11::array vertices, pybind11::array triangles);

/// A small array with a copy of the numbers.
pybind11::array copied(const Eigen::Vector3d& vector);

}  // namespace firstcontact::python
