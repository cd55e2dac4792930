// Where a mesh is that a URDF names.

#include <firstcontact/robot_files/detail/mesh_uri.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact::detail {
namespace {

using std::filesystem::path;

class MeshUri : public testing::Test {
 protected:
  MeshUri() : folder_(path(testing::TempDir()) / ("mesh_uri." + std::to_string(getpid()))) {}
  ~MeshUri() override { std::filesystem::remove_all(folder_); }
  MeshUri(const MeshUri&) = delete;
  MeshUri& operator=(const MeshUri&) = delete;

  /// Makes a file, and the folders above it.
  void make(const std::string& name) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "v 0 0 0\n";
  }

  /// From the folder of this test.
  [[nodiscard]] std::string resolved(const std::string& uri, const std::string& urdf,
                                     const std::vector<std::string>& roots = {}) const {
    std::vector<path> all;
    for (const std::string& root : roots) {
      all.push_back(folder_ / root);
    }
    return resolve_mesh(uri, folder_ / urdf, all).lexically_relative(folder_).string();
  }

  path folder_;
};

// The folder of the process is of no matter.
TEST_F(MeshUri, IsBesideTheUrdfWhereItIsRelative) {
  EXPECT_EQ(resolved("a.obj", "robots/r.urdf"), "robots/a.obj");
  EXPECT_EQ(resolved("file://a.obj", "robots/r.urdf"), "robots/a.obj");
  EXPECT_EQ(resolve_mesh("file:///x/a.obj", folder_ / "r.urdf", {}), path("/x/a.obj"));
  EXPECT_EQ(resolve_mesh("/x/a.obj", folder_ / "r.urdf", {}), path("/x/a.obj"));
}

TEST_F(MeshUri, IsInTheFirstRootThatHasTheFile) {
  make("one/pkg/other.obj");
  make("two/pkg/a.obj");
  make("three/pkg/a.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "r.urdf", {"one", "two", "three"}), "two/pkg/a.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "r.urdf", {"three", "two"}), "three/pkg/a.obj");
  // No root has it: the first one that has the package is where it is expected.
  EXPECT_EQ(resolved("package://pkg/none.obj", "r.urdf", {"one", "two"}), "one/pkg/none.obj");
}

// Packages of Python have a folder of their own name inside.
TEST_F(MeshUri, IsInThePackageThatHoldsTheUrdf) {
  make("ws/pkg/pkg/a.obj");
  make("ws/pkg/a.obj");
  make("ws/pkg/urdf/pkg/a.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "ws/pkg/urdf/deep/r.urdf"), "ws/pkg/a.obj");
  make("one/pkg/other.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "ws/pkg/urdf/r.urdf", {"one"}), "ws/pkg/a.obj");
  // A folder beside the package that encloses the file is next.
  make("ws/meshes/b.obj");
  EXPECT_EQ(resolved("package://meshes/b.obj", "ws/pkg/urdf/r.urdf"), "ws/meshes/b.obj");
}

TEST_F(MeshUri, IsInAPackageBesideTheUrdf) {
  make("robots/pkg/a.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "robots/r.urdf"), "robots/pkg/a.obj");
}

// ".." is no folder: those above the file are searched, not those above the place it is named from.
TEST_F(MeshUri, IsFoundFromAPathThatGoesUp) {
  make("pkg/a.obj");
  make("robots/sub/pkg/a.obj");
  EXPECT_EQ(resolved("package://pkg/a.obj", "robots/sub/../r.urdf"), "pkg/a.obj");
}

TEST_F(MeshUri, TakesEveryFormOfAFileUri) {
  make("robots/a b.obj");
  make("robots/a%20c.obj");
  EXPECT_EQ(resolved("file://a%20b.obj", "robots/r.urdf"), "robots/a b.obj");
  EXPECT_EQ(resolved("file://a%20c.obj", "robots/r.urdf"), "robots/a%20c.obj");
  for (const char* start : {"file:", "file://", "file://localhost"}) {
    EXPECT_EQ(resolve_mesh(std::string(start) + "/x/a%20b.obj", folder_ / "r.urdf", {}),
              path("/x/a b.obj"))
        << start;
  }
}

TEST_F(MeshUri, RefusesWhatXacroReplaces) {
  EXPECT_THROW((void)resolved("$(find pkg)/a.obj", "r.urdf"), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::detail
