#include <firstcontact/model_files/detail/gltf_instances.h>

#include <string>
#include <vector>

#include <firstcontact/model_files/detail/gltf_transform.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

GltfInstances::GltfInstances(const GltfDocument& document, const GltfAccessorReader& accessors,
                             const JsonValue& extension)
    : document_(document), where_(extension) {
  const auto read = [&](const JsonValue& value, std::string_view type) {
    const GltfAccessor accessor =
        accessors.read(value, {.type = type, .floats = true, .integers = true});
    require_count(value, accessor.count());
    return accessor;
  };
  const JsonValue& attributes = document.reader().member(extension, "attributes");
  for (const auto& [name, value] : document.object(attributes)) {
    if (name == "TRANSLATION") {
      translation_ = read(value, "VEC3");
    } else if (name == "ROTATION") {
      rotation_ = read(value, "VEC4");
    } else if (name == "SCALE") {
      scale_ = read(value, "VEC3");
    } else if (name.starts_with('_')) {
      document.log().leave_out("attribute of an application", "data of an application");
    } else {
      document.refuse(
          value, "EXT_mesh_gpu_instancing",
          "unknown attribute " + in_quotes(name) + "; known are TRANSLATION, ROTATION and SCALE",
          name);
    }
  }
  if (!has_count_) {
    document.log().throw_errors();  // An error about an unknown name explains more.
    document.fail(attributes, "expected TRANSLATION, ROTATION or SCALE of instances, got none");
  }
}

void GltfInstances::require_count(const JsonValue& where, std::size_t count) {
  if (has_count_ && count != count_) {
    document_.fail(where, "expected as many elements as the instances' other arrays have, " +
                              std::to_string(count_) + ", got " + std::to_string(count));
  }
  has_count_ = true;
  count_ = count;
}

Eigen::Affine3d GltfInstances::transform(std::size_t instance) const {
  Eigen::Vector4d rotation(0.0, 0.0, 0.0, 1.0);
  for (std::size_t i = 0; rotation_ && i < 4; ++i) {
    rotation[static_cast<Eigen::Index>(i)] = rotation_->at(instance, i);
  }
  const auto X =
      compose(translation_ ? translation_->vector3(instance) : Eigen::Vector3d::Zero().eval(),
              rotation, scale_ ? scale_->vector3(instance) : Eigen::Vector3d::Ones().eval());
  if (!X) {
    document_.fail(where_,
                   "expected a finite quaternion other than zero, got another for instance " +
                       std::to_string(instance));
  }
  return *X;
}

}  // namespace firstcontact::detail
