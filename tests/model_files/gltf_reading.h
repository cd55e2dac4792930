/// @file
/// Reads glTF files that a test has written.

#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/text/parse_error.h>

#include "model_files/gltf_body.h"

namespace firstcontact::test {

/// Fixture with its own folder; ctest runs each test in its own process.
class GltfTest : public testing::Test {
 protected:
  GltfTest() { std::filesystem::create_directories(folder_); }
  ~GltfTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  [[nodiscard]] MeshReading read(const std::string& name, const std::string& bytes,
                                 const ReadingOptions& options = {}) const {
    write(name, bytes);
    return read_mesh_file(folder_ / name, options);
  }

  [[nodiscard]] Mesh read_glb(const GltfWriter& gltf) const {
    return read("body.glb", gltf.glb()).mesh;
  }

  /// Returns the one line of the error; empty if the file is read.
  [[nodiscard]] std::string error_of(const std::string& name, const std::string& bytes) const {
    try {
      EXPECT_FALSE(read(name, bytes).mesh.triangles.empty());
      return "";
    } catch (const ParseError& error) {
      const std::string line = error.what();
      const std::string path = (folder_ / name).string();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_EQ(line.find(folder_.string()), 0u) << line;
      EXPECT_GT(line.size(), path.size() + 10) << line;
      return line;
    }
  }

  /// Tests whether the file is refused by a line that contains this text.
  [[nodiscard]] testing::AssertionResult is_refused(const GltfWriter& gltf,
                                                    const std::string& says) const {
    return is_refused("body.glb", gltf.glb(), says);
  }
  [[nodiscard]] testing::AssertionResult is_refused(const std::string& name,
                                                    const std::string& bytes,
                                                    const std::string& says) const {
    const std::string line = error_of(name, bytes);
    if (line.empty()) {
      return testing::AssertionFailure() << "it was read";
    }
    if (line.find(says) == std::string::npos) {
      return testing::AssertionFailure() << "it says: " << line;
    }
    return testing::AssertionSuccess();
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("gltf_" + std::to_string(::getpid()));
};

/// Tests whether the triangles have exactly these corners; each may start from any of its corners.
inline testing::AssertionResult has_corners(const Mesh& mesh, const Corners& expected) {
  if (3 * mesh.triangles.size() != expected.size()) {
    return testing::AssertionFailure() << mesh.triangles.size() << " triangles";
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    bool same = false;
    for (std::size_t turn = 0; turn < 3; ++turn) {
      bool turned = true;
      for (std::size_t k = 0; k < 3; ++k) {
        turned = turned && mesh.vertices[mesh.triangles[i][(k + turn) % 3]] == expected[3 * i + k];
      }
      same = same || turned;
    }
    if (!same) {
      return testing::AssertionFailure()
             << "triangle " << i << " begins at " << mesh.vertices[mesh.triangles[i][0]].transpose()
             << ", not at " << expected[3 * i].transpose();
    }
  }
  return testing::AssertionSuccess();
}

/// Applies a map to corners.
template <class Map>
Corners mapped(Corners corners, Map map) {
  for (Eigen::Vector3d& corner : corners) {
    corner = map(corner);
  }
  return corners;
}

/// Returns the same triangles with the opposite orientation.
inline Corners turned_over(Corners corners) {
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    std::swap(corners[i + 1], corners[i + 2]);
  }
  return corners;
}

inline Corners float_corners() { return corners_of_triangles(points_of(float_positions())); }

}  // namespace firstcontact::test
