#include <firstcontact/model_files/detail/gltf_transform.h>

#include <cmath>
#include <string>

namespace firstcontact::detail {
namespace {

template <int kSize>
Eigen::Matrix<double, kSize, 1> numbers(const GltfDocument& document, const JsonValue& value,
                                        const std::string& what) {
  const JsonArray& elements = document.reader().array(value, what);
  if (elements.size() != static_cast<std::size_t>(kSize)) {
    document.reader().fail_expected(what, value);
  }
  Eigen::Matrix<double, kSize, 1> result;
  for (int i = 0; i < kSize; ++i) {
    result[i] = document.reader().number(elements[static_cast<std::size_t>(i)]);
  }
  return result;
}

/// Computes the rotation matrix of a quaternion divided by its length. The formula is homogeneous
/// in the quaternion and so needs no length; see K. Shoemake, "Animating rotation with quaternion
/// curves", 1985.
Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) {
  const int exponent = std::ilogb(quaternion.cwiseAbs().maxCoeff());
  const auto scaled = [&](int i) { return std::scalbn(quaternion[i], -exponent); };
  const double x = scaled(0);
  const double y = scaled(1);
  const double z = scaled(2);
  const double w = scaled(3);
  const double xx = x * x;
  const double yy = y * y;
  const double zz = z * z;
  const double ww = w * w;
  Eigen::Matrix3d R;
  R << ww + xx - yy - zz, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
      2.0 * (x * y + w * z), ww - xx + yy - zz, 2.0 * (y * z - w * x),   //
      2.0 * (x * z - w * y), 2.0 * (y * z + w * x), ww - xx - yy + zz;
  return R / (ww + xx + yy + zz);
}

}  // namespace

std::optional<Eigen::Affine3d> compose(const Eigen::Vector3d& translation,
                                       const Eigen::Vector4d& rotation,
                                       const Eigen::Vector3d& scale) {
  if (!rotation.allFinite() || rotation.isZero(0.0)) {
    return std::nullopt;
  }
  Eigen::Affine3d X;
  X.linear() = rotation_of(rotation) * scale.asDiagonal();
  X.translation() = translation;
  X.makeAffine();
  return X;
}

std::optional<Eigen::Affine3d> affine(const Eigen::Matrix4d& matrix) {
  constexpr double kNoise = 1e-5;
  const Eigen::RowVector4d error = matrix.row(3) - Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  if (!matrix.allFinite() || !(error.cwiseAbs().maxCoeff() <= kNoise)) {
    return std::nullopt;
  }
  Eigen::Affine3d X;
  X.matrix() = matrix;
  X.makeAffine();
  return X;
}

bool mirrors(const Eigen::Matrix3d& linear) {
  Eigen::Matrix3d columns = linear;
  for (int i = 0; i < 3; ++i) {  // Signs only: otherwise tiny scales would underflow.
    const double most = columns.col(i).cwiseAbs().maxCoeff();
    if (most > 0.0) {
      columns.col(i) /= most;
    }
  }
  return columns.determinant() < 0.0;
}

Eigen::Affine3d node_transform(const GltfDocument& document, const JsonValue& node) {
  const JsonObject& object = document.object(node);
  const JsonValue* const matrix = find(object, "matrix");
  const JsonValue* const translation = find(object, "translation");
  const JsonValue* const rotation = find(object, "rotation");
  const JsonValue* const scale = find(object, "scale");
  if (matrix != nullptr) {
    if (translation != nullptr || rotation != nullptr || scale != nullptr) {
      document.fail(node, "expected a matrix, or translation, rotation and scale, got both");
    }
    const auto elements = numbers<16>(document, *matrix, "16 numbers, the columns of a matrix");
    const auto X = affine(Eigen::Map<const Eigen::Matrix4d>(elements.data()));
    if (!X) {
      document.fail(*matrix, "expected an affine matrix, whose last row is 0, 0, 0, 1");
    }
    return *X;
  }
  const auto X =
      compose(translation == nullptr ? Eigen::Vector3d::Zero().eval()
                                     : numbers<3>(document, *translation, "three numbers"),
              rotation == nullptr ? Eigen::Vector4d(0.0, 0.0, 0.0, 1.0)
                                  : numbers<4>(document, *rotation, "four numbers, x, y, z and w"),
              scale == nullptr ? Eigen::Vector3d::Ones().eval()
                               : numbers<3>(document, *scale, "three numbers"));
  if (!X) {
    document.fail(*rotation, "expected a quaternion other than zero");
  }
  return *X;
}

}  // namespace firstcontact::detail
