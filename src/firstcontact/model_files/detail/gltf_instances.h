/// @file
/// The instances of a node's mesh (EXT_mesh_gpu_instancing).

#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/gltf_accessor.h>

namespace firstcontact::detail {

/// The instances of a mesh, in the frame of the node that has it.
class GltfInstances {
 public:
  /// Reads the instances.
  ///
  /// @param extension  of the node
  /// @throws ParseError  arrays of different lengths, no array at all
  GltfInstances(const GltfDocument& document, const GltfAccessorReader& accessors,
                const JsonValue& extension);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Computes the map of an instance.
  ///
  /// @throws ParseError  a quaternion of zeros, or one that is not finite
  [[nodiscard]] Eigen::Affine3d transform(std::size_t instance) const;

 private:
  void require_count(const JsonValue& where, std::size_t count);

  const GltfDocument& document_;
  const JsonValue& where_;
  std::size_t count_ = 0;
  bool has_count_ = false;
  std::optional<GltfAccessor> translation_;
  std::optional<GltfAccessor> rotation_;
  std::optional<GltfAccessor> scale_;
};

}  // namespace firstcontact::detail
