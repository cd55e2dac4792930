#include <firstcontact/model_files/detail/gltf_skin.h>

#include <cmath>
#include <limits>
#include <string>

#include <firstcontact/model_files/detail/gltf_transform.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Four weights that were rounded to bytes add up to 1 within 4 / 255.
constexpr double kRounding = 4.0 / 255.0;

void warn_of_sum(const GltfDocument& document, const GltfPrimitive& primitive, double sum,
                 std::size_t vertex) {
  document.log().warn(
      ParseError(document.log().path(), primitive.where->line,
                 "the weights of vertex " + std::to_string(vertex) + " add up to " +
                     write_json(sum) + " and not to 1; they were taken as shares of their sum"),
      "weights of joints");
}

Eigen::Matrix4d matrix_of(const GltfAccessor& accessor, std::size_t row) {
  Eigen::Matrix4d matrix;
  for (std::size_t i = 0; i < 16; ++i) {
    matrix(static_cast<Eigen::Index>(i % 4), static_cast<Eigen::Index>(i / 4)) =
        accessor.at(row, i);
  }
  return matrix;
}

}  // namespace

GltfSkin read_gltf_skin(const GltfDocument& document, const GltfAccessorReader& accessors,
                        const GltfNodes& nodes, std::size_t index) {
  const JsonValue& where = document.all(GltfArray::skins)[index];
  const JsonObject& object =
      document.checked(where, GltfObject::skin, "skins[" + std::to_string(index) + "]");
  GltfSkin skin;
  for (const JsonValue& joint : document.array(document.reader().member(where, "joints"))) {
    skin.X_WM.push_back(nodes.X_WN[document.index(joint, GltfArray::nodes)]);
  }
  const JsonValue* const matrices = find(object, "inverseBindMatrices");
  if (matrices == nullptr) {
    return skin;
  }
  const GltfAccessor inverse = accessors.read(*matrices, {.type = "MAT4"});
  if (inverse.count() < skin.X_WM.size()) {
    document.fail(*matrices, "expected a matrix for each of " + std::to_string(skin.X_WM.size()) +
                                 " joints, got " + std::to_string(inverse.count()));
  }
  for (std::size_t i = 0; i < skin.X_WM.size(); ++i) {
    const auto X_JM = affine(matrix_of(inverse, i));
    if (!X_JM) {
      document.fail(*matrices, "expected affine matrices, whose last row is 0, 0, 0, 1; matrix " +
                                   std::to_string(i) + " is not");
    }
    skin.X_WM[i] = skin.X_WM[i] * *X_JM;
  }
  return skin;
}

Eigen::Affine3d blend(const GltfDocument& document, const GltfPrimitive& primitive,
                      const GltfSkin& skin, std::size_t vertex) {
  Eigen::Matrix4d mean = Eigen::Matrix4d::Zero();
  double sum = 0.0;
  for (const auto& [joints, weights] : primitive.influences) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double weight = weights.at(vertex, i);
      if (!(weight >= 0.0) || !(weight <= std::numeric_limits<double>::max())) {
        document.fail(*primitive.where, "expected weights >= 0 of joints, got another for vertex " +
                                            std::to_string(vertex));
      }
      if (weight == 0.0) {
        continue;
      }
      const double joint = joints.at(vertex, i);
      if (!(joint < static_cast<double>(skin.X_WM.size()))) {
        document.fail(*primitive.where, "expected joints of the skin, which has " +
                                            std::to_string(skin.X_WM.size()) + ", got joint " +
                                            write_json(joint) + " for vertex " +
                                            std::to_string(vertex));
      }
      mean += weight * skin.X_WM[static_cast<std::size_t>(joint)].matrix();
      sum += weight;
    }
  }
  if (!(sum > 0.0)) {
    document.fail(*primitive.where, "expected a joint that moves vertex " + std::to_string(vertex) +
                                        ", got weights of zero");
  }
  if (!(std::abs(sum - 1.0) <= kRounding)) {
    warn_of_sum(document, primitive, sum, vertex);
  }
  Eigen::Affine3d X_WM;
  X_WM.matrix() = mean / sum;
  X_WM.makeAffine();
  return X_WM;
}

}  // namespace firstcontact::detail
