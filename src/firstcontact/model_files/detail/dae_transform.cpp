#include <firstcontact/model_files/detail/dae_transform.h>

#include <cmath>
#include <string>
#include <string_view>

#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRadiansPerDegree = 0.017453292519943295;

struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

/// Computes sine and cosine, exactly at multiples of a quarter turn, where writers mean 0 and 1.
SineCosine sine_cosine_of_degrees(double degrees) {
  const double rest = std::remainder(degrees, 360.0);  // Exact, in [-180, 180].
  if (std::remainder(rest, 90.0) == 0.0) {
    const bool half = rest == 180.0 || rest == -180.0;
    return {half ? 0.0 : rest / 90.0, half ? -1.0 : rest == 0.0 ? 1.0 : 0.0};
  }
  return {std::sin(rest * kRadiansPerDegree), std::cos(rest * kRadiansPerDegree)};
}

/// Scales a finite vector of a length > 0 to length 1.
Vector3d unit_vector(const DaeDocument& document, const XmlElement& where, const Vector3d& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    document.fail(where, "expected axes and directions of a length > 0");
  }
  const Vector3d scaled = v / largest;  // Its squares neither overflow nor vanish.
  const double norm = scaled.norm();
  return norm == 1.0 ? scaled : scaled / norm;
}

/// Makes a rotation. Derivation: R = cos I + sin [u]x + (1 - cos) u u^T (Rodrigues).
Affine3d rotation(const DaeDocument& document, const XmlElement& where,
                  const std::vector<double>& v) {
  const SineCosine turn = sine_cosine_of_degrees(v[3]);
  if (turn.sine == 0.0 && turn.cosine == 1.0) {
    return Affine3d::Identity();  // Some writers give no axis then.
  }
  const Vector3d u = unit_vector(document, where, {v[0], v[1], v[2]});
  Matrix3d cross;
  cross << 0.0, -u.z(), u.y(), u.z(), 0.0, -u.x(), -u.y(), u.x(), 0.0;
  Affine3d X = Affine3d::Identity();
  X.linear() = turn.cosine * Matrix3d::Identity() + turn.sine * cross +
               (1.0 - turn.cosine) * u * u.transpose();
  return X;
}

Affine3d look_at(const DaeDocument& document, const XmlElement& where,
                 const std::vector<double>& v) {
  const Vector3d eye(v[0], v[1], v[2]);
  const Vector3d forward = unit_vector(document, where, Vector3d(v[3], v[4], v[5]) - eye);
  const Vector3d up = unit_vector(document, where, {v[6], v[7], v[8]});
  const Vector3d right = unit_vector(document, where, forward.cross(up));
  Affine3d X = Affine3d::Identity();
  X.linear() << right, right.cross(forward), -forward;
  X.translation() = eye;
  return X;
}

Affine3d skew(const DaeDocument& document, const XmlElement& where, const std::vector<double>& v) {
  // Axes that a writer rounded to single precision are still perpendicular.
  constexpr double kMostCosine = 1e-6;
  const Vector3d turned = unit_vector(document, where, {v[1], v[2], v[3]});
  const Vector3d along = unit_vector(document, where, {v[4], v[5], v[6]});
  if (!(std::abs(turned.dot(along)) <= kMostCosine) || !(std::abs(v[0]) < 90.0)) {
    document.fail(where, "expected an angle below 90 degrees and axes that are perpendicular");
  }
  const double slope =
      std::abs(v[0]) == 45.0 ? std::copysign(1.0, v[0]) : std::tan(v[0] * kRadiansPerDegree);
  Affine3d X = Affine3d::Identity();
  X.linear() += slope * along * turned.transpose();
  return X;
}

Affine3d scaling(const std::vector<double>& v) {
  Affine3d X = Affine3d::Identity();
  X.linear() = Vector3d(v[0], v[1], v[2]).asDiagonal();
  return X;
}

/// Multiplies by one child of the node, if it is a transform.
void apply(const DaeDocument& document, const XmlElement& element, Affine3d& X) {
  const std::string_view name = element.Name();
  const auto row = [&](std::size_t count) { return read_dae_row(document, element, count); };
  if (name == "translate") {
    const std::vector<double> v = row(3);
    X.translate(Vector3d(v[0], v[1], v[2]));
  } else if (name == "matrix") {
    X = X * dae_matrix(document, element, row(16).data());
  } else if (name == "rotate") {
    X = X * rotation(document, element, row(4));
  } else if (name == "scale") {
    X = X * scaling(row(3));
  } else if (name == "lookat") {
    X = X * look_at(document, element, row(9));
  } else if (name == "skew") {
    X = X * skew(document, element, row(7));
  }
}

}  // namespace

std::vector<double> read_dae_row(const DaeDocument& document, const XmlElement& element,
                                 std::size_t count) {
  const XmlText text = document.xml().content(element);
  TextCursor cursor(text.view(), document.xml().source(), {}, text.line());
  std::vector<double> values;
  while (values.size() <= count && cursor.find_line()) {
    values.push_back(cursor.number("a finite number"));
  }
  if (values.size() != count) {
    document.fail(element, "expected " + std::to_string(count) + " numbers, got " +
                               (values.size() > count ? "more" : std::to_string(values.size())));
  }
  return values;
}

Affine3d dae_matrix(const DaeDocument& document, const XmlElement& where, const double* numbers) {
  Affine3d X;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      X.matrix()(row, column) = numbers[4 * row + column];
    }
  }
  if (!X.matrix().allFinite()) {
    document.fail(where, "expected finite numbers in a matrix");
  }
  if (X.matrix().row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    document.refuse(where, "expected 0 0 0 1 as the last row of a matrix");
    X.makeAffine();
  }
  return X;
}

Affine3d read_dae_transform(const DaeDocument& document, const XmlElement& node) {
  Affine3d X = Affine3d::Identity();
  for (const XmlElement* child = node.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    apply(document, *child, X);
  }
  return X;
}

}  // namespace firstcontact::detail
