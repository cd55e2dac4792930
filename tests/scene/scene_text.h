/// @file
/// Scenes as text, for tests of functions that read and check them.

#pragma once

#include <string>

namespace firstcontact::test {

/// The shape of a triangle of one metre in the plane z = 0.
constexpr const char* kTriangle =
    R"({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]})";

/// Writes a body; `more` has its pose or motion.
inline std::string body(const std::string& name, const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "shape": )" + kTriangle + (more.empty() ? "" : ", ") +
         more + "}";
}

/// Writes a motion by `translation` from a height z.
inline std::string falling(const std::string& z, const std::string& translation) {
  return R"("motion": {"type": "constant_velocity", "from": {"position": [0.1, 0.1, )" + z +
         R"(]}, "translation": [0, 0, )" + translation + "]}";
}

/// Writes a scene; `more` has its other keys.
inline std::string scene(const std::string& bodies, const std::string& more = "") {
  return R"({"firstcontact": 1, "bodies": [)" + bodies + "]" + (more.empty() ? "" : ", ") + more +
         "}";
}

}  // namespace firstcontact::test
