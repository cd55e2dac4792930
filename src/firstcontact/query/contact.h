/// @file
/// The contact state: which features touch, where and how.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Core>

namespace firstcontact {

/// The kind of a feature.
enum class FeatureType { vertex, edge, face };

/// The words of FeatureType in files and in Python, in this order.
inline constexpr std::array<const char*, 3> kFeatureTypeWords{"vertex", "edge", "face"};

/// A feature of a shape: a vertex, a unique edge or a triangle, by its index in the shape.
struct Feature {
  FeatureType type = FeatureType::vertex;
  std::uint32_t index = 0;
  std::uint32_t triangle = 0;  ///< A triangle that the feature belongs to.

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// Two features within the contact band at the reported time.
struct Contact {
  Feature feature_A;
  Feature feature_B;
  Eigen::Vector3d p_WA = Eigen::Vector3d::Zero();  ///< [m]  Closest point on A's thickened surface.
  /// [-]  Unit, from A to B.
  ///
  /// Where the closest points coincide, it is the face's normal or the normalised product of the
  /// two edges. It then points against the relative motion of B. Null where no feature normal
  /// decides.
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> n_AB_W;
  double distance = 0.0;  ///< [m]  Negative: depth of thickened features.
  /// [m per step]  Velocity of B's point relative to A's along the normal; negative when closing;
  /// 0 without a normal.
  double normal_velocity = 0.0;
  /// Index of the geometry of A, and of B: links may have several, a body has one.
  std::array<std::size_t, 2> geometries = {};
};

/// The number of feature pairs within the contact band, those included that are not listed.
struct ContactCount {
  std::uint64_t at_least = 0;
  bool is_exact = false;  ///< False where only the first was asked for, or counting ended early.

  ContactCount& operator+=(const ContactCount& other) {
    at_least += other.at_least;
    is_exact = is_exact && other.is_exact;
    return *this;
  }
};

/// Exchanges the roles of A and B in a contact.
inline void swap_bodies(Contact& contact) {
  std::swap(contact.feature_A, contact.feature_B);
  std::swap(contact.p_WA, contact.p_WB);
  std::swap(contact.geometries[0], contact.geometries[1]);
  if (contact.n_AB_W) {
    contact.n_AB_W = -*contact.n_AB_W;
  }
}

}  // namespace firstcontact
