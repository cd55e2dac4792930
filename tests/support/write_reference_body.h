/// @file
/// Writes the reference body in the formats of meshes, each feature with and without.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "support/reference_body.h"

namespace firstcontact::test {

/// Precision that a format keeps of a coordinate.
enum class Keeps { doubles, floats, whole_numbers };

/// A body as the bytes of a file.
struct WrittenBody {
  std::string name;       ///< Special feature of the file.
  std::string extension;  ///< Extension, with its dot.
  std::string bytes;
  Keeps keeps = Keeps::doubles;
};

/// Writes the shortest of the usual notations that gives the same double.
inline std::string decimal(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

template <class T>
std::string raw(T value, bool big_endian) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return bytes;
}

inline std::string with_line_ends(const std::string& text, const std::string& end) {
  std::string result;
  for (const char c : text) {
    result += c == '\n' ? end : std::string(1, c);
  }
  return result;
}

// ---- OBJ

struct ObjStyle {
  std::string corner;  ///< Text after the number of a vertex; "?" stands for a number.
  bool negative = false;
  bool faces_first = false;
};

inline std::string to_obj(const ReferenceBody& body, const ObjStyle& style) {
  std::string vertices;
  std::string faces;
  for (const auto& [x, y, z] : body.vertices) {
    vertices += "v " + decimal(x) + " " + decimal(y) + " " + decimal(z) + "\n";
  }
  const auto count = static_cast<int>(body.vertices.size());
  for (const auto& polygon : body.polygons) {
    faces += "f";
    for (const std::size_t corner : polygon) {
      const int number = static_cast<int>(corner) + 1;
      faces += " " + std::to_string(style.negative ? number - count - 1 : number);
      for (const char c : style.corner) {
        faces += c == '?' ? "1" : std::string(1, c);
      }
    }
    faces += "\n";
  }
  const std::string looks = "vt 0 0\nvn 0 0 1\ng part\nusemtl red\ns off\n";
  return style.faces_first ? faces + vertices : vertices + looks + faces;
}

inline std::vector<WrittenBody> written_as_obj(const ReferenceBody& body) {
  const std::string plain = to_obj(body, {});
  std::string continued = plain;
  for (std::size_t at = continued.find("f "); at != continued.npos;
       at = continued.find("\nf ", at + 4)) {
    continued.insert(continued.find(' ', at) + 1, "\\\n ");
  }
  return {{"plain", ".obj", plain},
          {"textures", ".obj", to_obj(body, {.corner = "/?"})},
          {"normals", ".obj", to_obj(body, {.corner = "//?"})},
          {"textures and normals", ".obj", to_obj(body, {.corner = "/?/?"})},
          {"negative numbers", ".obj", to_obj(body, {.corner = "", .negative = true})},
          {"faces first", ".obj", to_obj(body, {.corner = "", .faces_first = true})},
          {"comments", ".obj", "# Written by hand\n\n" + with_line_ends(plain, " # end\n")},
          {"carriage returns", ".obj", with_line_ends(plain, "\r\n")},
          {"byte order mark", ".obj", "\xef\xbb\xbf" + plain},
          {"continued lines", ".obj", continued}};
}

// ---- STL

inline std::string to_ascii_stl(const ReferenceBody& body, const std::string& normal) {
  std::string text = "solid a part of two words\n";
  for (const auto& triangle : body.triangles) {
    text += " facet normal " + normal + "\n  outer loop\n";
    for (const std::size_t corner : triangle) {
      const auto& [x, y, z] = body.vertices[corner];
      text += "   vertex " + decimal(x) + " " + decimal(y) + " " + decimal(z) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid a part of two words\n";
}

inline std::string to_binary_stl(const ReferenceBody& body, std::string header) {
  header.resize(80, ' ');
  std::string data = header + raw(static_cast<std::uint32_t>(body.triangles.size()), false);
  for (const auto& triangle : body.triangles) {
    data += std::string(12, '\0');
    for (const std::size_t corner : triangle) {
      for (const double x : body.vertices[corner]) {
        data += raw(static_cast<float>(x), false);
      }
    }
    data += std::string(2, '\0');
  }
  return data;
}

inline std::vector<WrittenBody> written_as_stl(const ReferenceBody& body) {
  const std::string ascii = to_ascii_stl(body, "0 0 0");
  std::string capitals = ascii;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  return {{"ASCII", ".stl", ascii},
          {"ASCII in capitals", ".stl", capitals},
          {"ASCII with normals of no number", ".stl", to_ascii_stl(body, "nan nan nan")},
          {"ASCII with carriage returns", ".stl", with_line_ends(ascii, "\r\n")},
          {"binary", ".stl", to_binary_stl(body, "a part"), Keeps::floats},
          {"binary that begins with solid", ".stl", to_binary_stl(body, "solid"), Keeps::floats},
          {"binary with padding", ".stl", to_binary_stl(body, "a part") + "\r\n", Keeps::floats}};
}

// ---- PLY

enum class PlyFormat { ascii, little_endian, big_endian };

/// Writes numbers of a PLY body, in text or in bytes.
class PlyBody {
 public:
  PlyBody(PlyFormat format, std::string& out) : format_(format), out_(out) {}

  template <class T>
  void number(T value) {
    if (format_ == PlyFormat::ascii) {
      out_ += decimal(static_cast<double>(value)) + " ";
    } else {
      out_ += raw(value, format_ == PlyFormat::big_endian);
    }
  }
  void end() { out_ += format_ == PlyFormat::ascii ? "\n" : ""; }

 private:
  PlyFormat format_;
  std::string& out_;
};

/// @param further  whether other elements and properties stand between those of the body
template <class Coordinate, class Index>
std::string to_ply(const ReferenceBody& body, PlyFormat format, const std::string& coordinate,
                   const std::string& index, bool further) {
  const std::string formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string out = "ply\nformat " + formats[static_cast<int>(format)] + " 1.0\ncomment a part\n";
  out += further ? "element material 1\nproperty uchar red\n" : "";
  out += "element vertex " + std::to_string(body.vertices.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) {
    out += "property " + coordinate + " " + axis + "\n";
  }
  out += further ? "property uchar red\n" : "";
  out += "element face " + std::to_string(body.polygons.size()) + "\n";
  out += further ? "property uchar flags\n" : "";
  out += "property list uchar " + index + (further ? " vertex_index\n" : " vertex_indices\n");
  out += "end_header\n";
  PlyBody write(format, out);
  if (further) {
    write.number(std::uint8_t{7});
    write.end();
  }
  for (const auto& p : body.vertices) {
    for (const double x : p) {
      write.number(static_cast<Coordinate>(x));
    }
    if (further) {
      write.number(std::uint8_t{255});
    }
    write.end();
  }
  for (const auto& polygon : body.polygons) {
    if (further) {
      write.number(std::uint8_t{1});
    }
    write.number(static_cast<std::uint8_t>(polygon.size()));
    for (const std::size_t corner : polygon) {
      write.number(static_cast<Index>(corner));
    }
    write.end();
  }
  return out;
}

/// Returns whether every coordinate is a value of the smallest type.
inline bool has_small_whole_numbers(const ReferenceBody& body) {
  return std::all_of(body.vertices.begin(), body.vertices.end(), [](const auto& p) {
    return std::all_of(p.begin(), p.end(),
                       [](double x) { return x == std::floor(x) && std::abs(x) <= 127.0; });
  });
}

inline std::vector<WrittenBody> written_as_ply(const ReferenceBody& body) {
  std::vector<WrittenBody> all;
  const char* names[] = {"ASCII", "little endian", "big endian"};
  for (const PlyFormat format :
       {PlyFormat::ascii, PlyFormat::little_endian, PlyFormat::big_endian}) {
    const std::string name = names[static_cast<int>(format)];
    for (const bool further : {false, true}) {
      const std::string with = further ? " with further properties" : "";
      all.push_back({name + " double" + with, ".ply",
                     to_ply<double, std::int32_t>(body, format, "double", "int", further)});
      all.push_back({name + " float" + with, ".ply",
                     to_ply<float, std::uint8_t>(body, format, "float", "uchar", further),
                     Keeps::floats});
      if (has_small_whole_numbers(body)) {
        all.push_back({name + " int" + with, ".ply",
                       to_ply<std::int32_t, std::uint16_t>(body, format, "int", "ushort", further),
                       Keeps::whole_numbers});
        all.push_back({name + " char" + with, ".ply",
                       to_ply<std::int8_t, std::uint32_t>(body, format, "char", "uint", further),
                       Keeps::whole_numbers});
      }
    }
  }
  return all;
}

// ---- OFF

inline std::string to_off(const ReferenceBody& body, const std::string& header,
                          const std::string& vertex_columns, const std::string& face_columns) {
  std::string text = header + std::to_string(body.vertices.size()) + " " +
                     std::to_string(body.polygons.size()) + " 0\n";
  for (const auto& [x, y, z] : body.vertices) {
    text += decimal(x) + " " + decimal(y) + " " + decimal(z) + vertex_columns + "\n";
  }
  for (const auto& polygon : body.polygons) {
    text += std::to_string(polygon.size());
    for (const std::size_t corner : polygon) {
      text += " " + std::to_string(corner);
    }
    text += face_columns + "\n";
  }
  return text;
}

inline std::vector<WrittenBody> written_as_off(const ReferenceBody& body) {
  const std::string plain = to_off(body, "OFF\n", "", "");
  return {{"plain", ".off", plain},
          {"counts beside the header", ".off", to_off(body, "OFF ", "", "")},
          {"colours of faces", ".off", to_off(body, "OFF\n", "", " 255 0 0")},
          {"colours of vertices", ".off", to_off(body, "COFF\n", " 255 0 0 255", "")},
          {"normals", ".off", to_off(body, "NOFF\n", " 0 0 1", "")},
          {"comments", ".off", "# a part\n" + with_line_ends(plain, " # end\n")},
          {"carriage returns", ".off", with_line_ends(plain, "\r\n")},
          {"byte order mark", ".off", "\xef\xbb\xbf" + plain}};
}

}  // namespace firstcontact::test
