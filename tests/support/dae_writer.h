/// @file
/// Writes COLLADA documents for tests. Shares no code with the reader.

#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "support/reference_body.h"

namespace firstcontact::test {

/// Kinds of primitives of a mesh.
enum class DaePrimitive { triangles, polylist, polygons, tristrips, trifans };

/// Writes a number with so many digits that reading gives the same double.
inline std::string dae_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

template <class Numbers>
std::string dae_numbers(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : " ") + dae_number(number);
  }
  return text;
}

template <class Indices>
std::string dae_indices(const Indices& indices) {
  std::string text;
  for (const std::size_t index : indices) {
    text += (text.empty() ? "" : " ") + std::to_string(index);
  }
  return text;
}

/// Writes a 4x4 matrix, row by row, from the rows of an affine map.
inline std::string dae_matrix_text(const std::array<double, 12>& rows) {
  return dae_numbers(rows) + " 0 0 0 1";
}

/// Writes a source of numbers: rows of `parameters` ("X Y Z" gives "XYZ").
inline std::string dae_source(const std::string& id, const std::vector<double>& numbers,
                              const std::string& parameters) {
  std::string text = "<source id='" + id + "'><float_array id='" + id + "-a' count='" +
                     std::to_string(numbers.size()) + "'>" + dae_numbers(numbers) +
                     "</float_array><technique_common><accessor source='#" + id + "-a' count='" +
                     std::to_string(numbers.size() / parameters.size()) + "' stride='" +
                     std::to_string(parameters.size()) + "'>";
  for (const char name : parameters) {
    text += "<param name='" + std::string(1, name) + "' type='float'/>";
  }
  return text + "</accessor></technique_common></source>";
}

/// Writes a source of names or, with the kind IDREF_array, of ids.
inline std::string dae_name_source(const std::string& id, const std::vector<std::string>& names,
                                   const std::string& kind) {
  std::string words;
  for (const std::string& name : names) {
    words += name + " ";
  }
  const std::string count = std::to_string(names.size());
  return "<source id='" + id + "'><" + kind + " id='" + id + "-a' count='" + count + "'>" + words +
         "</" + kind + "><technique_common><accessor source='#" + id + "-a' count='" + count +
         "'><param type='name'/></accessor></technique_common></source>";
}

/// Writes a source of 4x4 matrices, each as 16 numbers in words.
inline std::string dae_matrix_source(const std::string& id,
                                     const std::vector<std::string>& matrices) {
  std::string words;
  for (const std::string& matrix : matrices) {
    words += matrix + "\n";
  }
  const std::string count = std::to_string(matrices.size());
  return "<source id='" + id + "'><float_array id='" + id + "-a' count='" +
         std::to_string(16 * matrices.size()) + "'>" + words +
         "</float_array><technique_common><accessor source='#" + id + "-a' count='" + count +
         "' stride='16'><param name='TRANSFORM' type='float4x4'/></accessor></technique_common>"
         "</source>";
}

/// Returns the faces of the reference body as lists of corners of one kind of primitive.
inline std::vector<std::vector<std::size_t>> dae_lists(DaePrimitive kind) {
  switch (kind) {
    case DaePrimitive::tristrips:
      return {{0, 3, 1, 2}, {4, 5, 7, 6}, {0, 1, 4, 5}, {1, 2, 5, 6}, {2, 3, 6, 7}, {3, 0, 7, 4}};
    case DaePrimitive::trifans:
      return {{1, 0, 3, 2}, {5, 6, 7, 4}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    case DaePrimitive::triangles: {
      std::vector<std::vector<std::size_t>> lists;
      for (const auto& [a, b, c] : reference_body().triangles) {
        lists.push_back({a, b, c});
      }
      return lists;
    }
    case DaePrimitive::polylist:
    case DaePrimitive::polygons:
      break;
  }
  return reference_body().polygons;
}

/// Writes the primitive element.
///
/// Each corner has an index of another input before and after that of the vertex, as programs that
/// write normals and colours have.
inline std::string dae_primitive(const std::string& mesh, DaePrimitive kind) {
  static constexpr std::array<const char*, 5> kNames = {"triangles", "polylist", "polygons",
                                                        "tristrips", "trifans"};
  const std::string name = kNames[static_cast<std::size_t>(kind)];
  const auto lists = dae_lists(kind);
  const bool joined = kind == DaePrimitive::triangles || kind == DaePrimitive::polylist;
  std::string counts;
  std::string corners;
  for (const auto& list : lists) {
    counts += std::to_string(list.size()) + " ";
    corners += joined ? "" : "<p>";
    for (const std::size_t corner : list) {
      corners += "9 " + std::to_string(corner) + " -1 ";
    }
    corners += joined ? "" : "</p>";
  }
  return "<" + name + " count='" + std::to_string(lists.size()) +
         "'><input semantic='NORMAL' source='#no-such-source' offset='0'/>"
         "<input semantic='VERTEX' source='#" +
         mesh + "-v' offset='1'/><input semantic='COLOR' source='#" + mesh +
         "-c' offset='2' set='0'/>" +
         (kind == DaePrimitive::polylist ? "<vcount>" + counts + "</vcount>" : "") +
         (joined ? "<p>" + corners + "</p>" : corners) + "</" + name + ">";
}

/// Returns positions row by row.
inline std::vector<double> dae_rows(const std::vector<std::array<double, 3>>& points) {
  std::vector<double> rows;
  for (const auto& point : points) {
    rows.insert(rows.end(), point.begin(), point.end());
  }
  return rows;
}

/// Writes a geometry of given sources ("ID-p" is that of positions) and primitives.
inline std::string dae_geometry(const std::string& id, const std::string& sources,
                                const std::string& primitives, const std::string& mesh = "mesh") {
  return "<geometry id='" + id + "'><" + mesh + ">" + sources + "<vertices id='" + id +
         "-v'><input semantic='POSITION' source='#" + id + "-p'/></vertices>" + primitives + "</" +
         mesh + "></geometry>";
}

/// Writes the reference body as a geometry.
inline std::string dae_body(const std::string& id, double unit = 0.1,
                            DaePrimitive kind = DaePrimitive::triangles) {
  return dae_geometry(id, dae_source(id + "-p", dae_rows(reference_body(unit).vertices), "XYZ"),
                      dae_primitive(id, kind));
}

/// A document, in parts.
struct DaeWriter {
  std::string asset = "<asset><unit name='meter' meter='1'/><up_axis>Z_UP</up_axis></asset>";
  std::string geometries = dae_body("body");
  std::string controllers;
  std::string library_nodes;
  std::string nodes = "<node id='n'><instance_geometry url='#body'/></node>";
  std::string more;  ///< Further libraries.
  std::string scene = "<scene><instance_visual_scene url='#scene'/></scene>";

  [[nodiscard]] std::string text() const {
    return "<?xml version='1.0' encoding='utf-8'?>\n"
           "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>\n" +
           asset + "\n" + library("geometries", geometries) + library("controllers", controllers) +
           library("nodes", library_nodes) +
           library("visual_scenes", "<visual_scene id='scene'>" + nodes + "</visual_scene>") +
           more + scene + "\n</COLLADA>\n";
  }

 private:
  static std::string library(const std::string& name, const std::string& inside) {
    return inside.empty() ? "" : "<library_" + name + ">" + inside + "</library_" + name + ">\n";
  }
};

}  // namespace firstcontact::test
