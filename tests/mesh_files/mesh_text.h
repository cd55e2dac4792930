/// @file
/// Writes meshes as text and bytes, for tests of the readers.

#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::test {

/// Writes a number with so many digits that reading gives the same double.
inline std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string coordinates(const Eigen::Vector3d& p) {
  return digits(p.x()) + " " + digits(p.y()) + " " + digits(p.z()) + "\n";
}

template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return bytes;
}

inline std::string to_obj(const Mesh& mesh) {
  std::string text;
  for (const auto& p : mesh.vertices) {
    text += "v " + coordinates(p);
  }
  for (const auto& t : mesh.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

/// Writes the part after the header of OFF and of ASCII PLY.
inline std::string vertices_and_faces(const Mesh& mesh) {
  std::string text;
  for (const auto& p : mesh.vertices) {
    text += coordinates(p);
  }
  for (const auto& t : mesh.triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
            "\n";
  }
  return text;
}

inline std::string to_off(const Mesh& mesh) {
  return "OFF\n" + std::to_string(mesh.vertices.size()) + " " +
         std::to_string(mesh.triangles.size()) + " 0\n" + vertices_and_faces(mesh);
}

inline std::string to_ascii_stl(const Mesh& mesh) {
  std::string text = "solid part\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto v : t) {
      text += "vertex " + coordinates(mesh.vertices[v]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

inline std::string to_binary_stl(const Mesh& mesh, std::string header = "binary") {
  header.resize(80, ' ');
  std::string data = header + bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    data += std::string(12, '\0');
    for (const auto v : t) {
      for (int k = 0; k < 3; ++k) {
        data += bytes_of(static_cast<float>(mesh.vertices[v][k]));
      }
    }
    data += std::string(2, '\0');
  }
  return data;
}

inline std::string ply_header(const Mesh& mesh, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment a test\nelement vertex " +
         std::to_string(mesh.vertices.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string to_ascii_ply(const Mesh& mesh) {
  return ply_header(mesh, "ascii") + vertices_and_faces(mesh);
}

inline std::string to_binary_ply(const Mesh& mesh, bool big_endian) {
  std::string data = ply_header(mesh, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const auto& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      data += bytes_of(p[k], big_endian);
    }
  }
  for (const auto& t : mesh.triangles) {
    data += '\3';
    for (const auto v : t) {
      data += bytes_of(v, big_endian);
    }
  }
  return data;
}

}  // namespace firstcontact::test
