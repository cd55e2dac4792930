// Ten million triangles: read from a file, welded, built and asked within 4 GiB of address space.

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr int kSquares = 2240;  // Along each side; two triangles each.
constexpr std::uint32_t kTriangles = 2 * kSquares * kSquares;
constexpr rlim_t kGibibyte = rlim_t{1} << 30;

/// A file that is gone with the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Limits the address space of this process while it lives.
class AddressSpaceLimit {
 public:
  explicit AddressSpaceLimit(rlim_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit limited = {bytes, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_AS, &limited), 0);
  }
  AddressSpaceLimit(const AddressSpaceLimit&) = delete;
  AddressSpaceLimit& operator=(const AddressSpaceLimit&) = delete;
  ~AddressSpaceLimit() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_ = {};
};

/// The paraboloid z = -(x^2 + y^2) over [-1, 1]^2 as binary STL; a vertex lies at the origin.
void write_paraboloid(const std::filesystem::path& path) {
  struct [[gnu::packed]] Facet {
    std::array<float, 3> normal;
    std::array<std::array<float, 3>, 3> corners;
    std::uint16_t attributes;
  };
  static_assert(sizeof(Facet) == 50);
  const auto corner = [](int i, int j) {
    const float x = 2.0f * static_cast<float>(i) / kSquares - 1.0f;
    const float y = 2.0f * static_cast<float>(j) / kSquares - 1.0f;
    return std::array<float, 3>{x, y, -(x * x + y * y)};
  };
  std::ofstream file(path, std::ios::binary);
  file.write(std::array<char, 80>{}.data(), 80);
  file.write(reinterpret_cast<const char*>(&kTriangles), sizeof kTriangles);
  for (int i = 0; i < kSquares; ++i) {
    for (int j = 0; j < kSquares; ++j) {
      const std::array<Facet, 2> facets = {
          Facet{{}, {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}, 0},
          Facet{{}, {corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}, 0}};
      file.write(reinterpret_cast<const char*>(facets.data()), sizeof facets);
    }
  }
  ASSERT_TRUE(file.good()) << "cannot write " << path;
}

/// Stands on its tip at the origin.
Shape tetrahedron() {
  return Shape({.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}, {-1.0, 1.0, 1.0}, {-1.0, -1.0, 1.0}},
                .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 2, 3}}});
}

TEST(LargeMesh, IsReadAndAskedWithinFourGibibytes) {
  const TemporaryFile file("ten_million_triangles.stl");
  write_paraboloid(file.path());
  const AddressSpaceLimit limit(4 * kGibibyte);
  const Shape hill(read_mesh(file.path()));
  EXPECT_EQ(hill.mesh().triangles.size(), kTriangles);
  EXPECT_EQ(hill.mesh().vertices.size(), (kSquares + 1) * (kSquares + 1));

  const Shape tip = tetrahedron();
  const Motion rest = Motion::fixed();
  const Motion fall = Motion::constant_velocity({.position = {0.0, 0.0, 0.5}}, {0.0, 0.0, -1.0});
  Workspace workspace;
  const FirstContactResult result = first_contact({hill, rest}, {tip, fall}, workspace);
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.t, 0.5, 2e-6);

  const Motion aside =
      Motion::constant_velocity({.position = {0.0, 0.0, 0.01}}, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0});
  EXPECT_EQ(first_contact({hill, rest}, {hill, aside}, workspace).verdict, Verdict::free);

  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  RecordProperty("greatest_resident_KiB", static_cast<int>(usage.ru_maxrss));
  std::printf("greatest resident set: %.2f GiB\n",
              static_cast<double>(usage.ru_maxrss) / (1 << 20));
}

}  // namespace
}  // namespace firstcontact
