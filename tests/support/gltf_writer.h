/// @file
/// Writes glTF documents for tests of their reader, and shares no code with that reader.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace firstcontact::test {

/// Returns the code of a type of numbers in glTF.
template <class T>
constexpr int gltf_code() {
  return std::is_same_v<T, std::int8_t>     ? 5120
         : std::is_same_v<T, std::uint8_t>  ? 5121
         : std::is_same_v<T, std::int16_t>  ? 5122
         : std::is_same_v<T, std::uint16_t> ? 5123
         : std::is_same_v<T, std::uint32_t> ? 5125
                                            : 5126;
}

inline std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

template <class T>
std::string little_endian(T value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);  // The machines of these tests are little-endian.
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    bytes += static_cast<char>(bits >> (8 * i) & 0xff);
  }
  return bytes;
}

inline std::string as_base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits;
  for (const char c : bytes) {
    for (int i = 7; i >= 0; --i) {
      bits += (static_cast<unsigned char>(c) >> i & 1) != 0 ? '1' : '0';
    }
  }
  while (bits.size() % 6 != 0) {
    bits += '0';
  }
  std::string text;
  for (std::size_t i = 0; i < bits.size(); i += 6) {
    text += digits[std::stoul(bits.substr(i, 6), nullptr, 2)];
  }
  while (text.size() % 4 != 0) {
    text += '=';
  }
  return text;
}

/// A document to be completed: members are JSON texts, the buffer is bytes.
struct GltfWriter {
  std::string buffer;
  std::vector<std::string> views;
  std::vector<std::string> accessors;
  std::vector<std::string> meshes;
  std::vector<std::string> nodes;
  std::vector<std::string> skins;
  std::string scenes = R"("scene":0,"scenes":[{"nodes":[0]}],)";
  std::string more;  ///< Further members of the root, each with a comma after it.

  static std::string list(const std::vector<std::string>& elements) {
    std::string text;
    for (const std::string& element : elements) {
      text += (text.empty() ? "" : ",") + element;
    }
    return "[" + text + "]";
  }

  /// Adds bytes and returns the index of their view; `stride` is 0 for packed rows.
  std::size_t add_view(const std::string& bytes, std::size_t stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    views.push_back(R"({"buffer":0,"byteOffset":)" + std::to_string(buffer.size()) +
                    R"(,"byteLength":)" + std::to_string(bytes.size()) +
                    (stride > 0 ? R"(,"byteStride":)" + std::to_string(stride) : "") + "}");
    buffer += bytes;
    return views.size() - 1;
  }

  /// @param head  members of the accessor: its bufferView, or nothing, with a comma after each
  std::size_t add_accessor(const std::string& head, int code, std::size_t count,
                           const std::string& type) {
    accessors.push_back("{" + head + R"("componentType":)" + std::to_string(code) + R"(,"count":)" +
                        std::to_string(count) + R"(,"type":")" + type + "\"}");
    return accessors.size() - 1;
  }

  /// Adds rows of numbers; each row is padded to whole words where it is not SCALAR.
  template <class T>
  std::size_t add_numbers(const std::vector<T>& numbers, const std::string& type,
                          const std::string& more_members = "") {
    const std::size_t columns = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    const std::size_t row = columns * sizeof(T);
    const std::size_t stride = columns == 1 ? row : (row + 3) / 4 * 4;
    std::string bytes;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      bytes += little_endian(numbers[i]);
      if (i % columns == columns - 1) {
        bytes.resize(bytes.size() + stride - row, '\x55');
      }
    }
    const std::size_t view = add_view(bytes, stride == row ? 0 : stride);
    return add_accessor("\"bufferView\":" + std::to_string(view) + "," + more_members,
                        gltf_code<T>(), numbers.size() / columns, type);
  }

  /// Returns the document; `uri` is a member of its buffer with a comma after it, or empty.
  [[nodiscard]] std::string json(const std::string& uri) const {
    return R"({"asset":{"version":"2.0"},)" + scenes + more + R"("buffers":[{)" + uri +
           R"("byteLength":)" + std::to_string(buffer.size()) + R"(}],"bufferViews":)" +
           list(views) + R"(,"accessors":)" + list(accessors) + R"(,"skins":)" + list(skins) +
           R"(,"meshes":)" + list(meshes) + R"(,"nodes":)" + list(nodes) + "}";
  }

  [[nodiscard]] std::string with_data_uri(
      const std::string& head = "data:application/octet-stream;base64,") const {
    return json(R"("uri":")" + head + as_base64(buffer) + "\",");
  }

  /// Returns a GLB file; `between` holds further chunks between the two.
  [[nodiscard]] std::string glb(const std::string& between = "") const {
    return glb_of(json(""), buffer, between);
  }

  static std::string chunk(const std::string& type, std::string content, char filling) {
    content.resize((content.size() + 3) / 4 * 4, filling);
    return little_endian(static_cast<std::uint32_t>(content.size())) + type + content;
  }

  static std::string glb_of(const std::string& json, const std::string& binary,
                            const std::string& between = "") {
    const std::string chunks =
        chunk("JSON", json, ' ') + between + chunk(std::string("BIN\0", 4), binary, '\0');
    return "glTF" + little_endian(std::uint32_t{2}) +
           little_endian(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
  }
};

}  // namespace firstcontact::test
