#include <firstcontact/geometry/weld.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace firstcontact {
namespace {

using Bits = std::array<std::uint64_t, 3>;

Bits bits(const Eigen::Vector3d& p) {
  // Adding 0.0 turns -0.0 into 0.0 and keeps everything else.
  return {std::bit_cast<std::uint64_t>(p.x() + 0.0), std::bit_cast<std::uint64_t>(p.y() + 0.0),
          std::bit_cast<std::uint64_t>(p.z() + 0.0)};
}

// The finaliser of splitmix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014), chained.
std::uint64_t hash(const Bits& b) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (const std::uint64_t word : b) {
    h ^= word;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
    h ^= h >> 31;
  }
  return h;
}

/// The distinct positions at the front of `vertices`, found by open addressing.
class PositionTable {
 public:
  explicit PositionTable(std::vector<Eigen::Vector3d>& vertices) : vertices_(vertices) {}

  /// Finds the number of a position; a new one is stored behind the others.
  std::uint32_t number(const Eigen::Vector3d& p) {
    if (2 * std::size_t{count_} >= slots_.size()) {
      grow();
    }
    std::uint32_t& slot = find(bits(p));
    if (slot == kEmpty) {
      vertices_[count_] = p;
      slot = count_++;
    }
    return slot;
  }

  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t& find(const Bits& wanted) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(wanted) & mask;
    while (slots_[i] != kEmpty && bits(vertices_[slots_[i]]) != wanted) {
      i = (i + 1) & mask;
    }
    return slots_[i];
  }

  void grow() {
    slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), kEmpty);
    for (std::uint32_t i = 0; i < count_; ++i) {
      find(bits(vertices_[i])) = i;
    }
  }

  std::vector<Eigen::Vector3d>& vertices_;
  std::vector<std::uint32_t> slots_;
  std::uint32_t count_ = 0;
};

}  // namespace

std::size_t weld(Mesh& mesh) {
  const std::size_t before = mesh.vertices.size();
  std::vector<std::uint32_t> number(before);
  // Distinct positions move to the front, never past the vertex in hand.
  PositionTable table(mesh.vertices);
  for (std::size_t i = 0; i < before; ++i) {
    const Eigen::Vector3d p = mesh.vertices[i];
    number[i] = table.number(p);
  }
  if (table.count() == before) {
    return 0;
  }
  mesh.vertices.resize(table.count());
  mesh.vertices.shrink_to_fit();
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) {
      v = number[v];
    }
  }
  return before - mesh.vertices.size();
}

}  // namespace firstcontact
