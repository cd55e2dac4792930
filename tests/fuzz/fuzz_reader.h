/// @file
/// Properties of a reader's result on any bytes: a valid mesh or cloud, or a ParseError of one
/// line.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::test {

inline void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Parses the bytes, and passes the resulting mesh through weld and inspect.
template <class Parse>
void fuzz_reader(Parse parse, const std::uint8_t* data, std::size_t size) {
  try {
    Mesh mesh = parse(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz");
    require(!mesh.triangles.empty());
    weld(mesh);
    require(inspect(mesh).nonfinite_vertices == 0);
  } catch (const ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

/// Parses the bytes of a cloud, and requires finite points, at least one.
template <class Parse>
void fuzz_point_reader(Parse parse, const std::uint8_t* data, std::size_t size) {
  try {
    const auto points = parse(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz");
    require(!points.empty());
    for (const auto& point : points) {
      require(point.allFinite());
    }
  } catch (const ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace firstcontact::test
