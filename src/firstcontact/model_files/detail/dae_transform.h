/// @file
/// The transforms of a COLLADA node.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// Computes the product of a node's transforms in the order of the document: the last acts first.
///
/// A <rotate> about a multiple of a quarter turn is exact. The axis of a <rotate> need not be of
/// unit length. <lookat> is the pose of an eye that looks along -z, its up in the plane of y and z.
/// A <skew> moves points along its second axis, in proportion to their place along the first, which
/// turns by the angle. The axes have to be perpendicular: other axes have several interpretations.
///
/// @throws ParseError  numbers that are missing, too many or not finite, axes of no length, a
///         matrix whose last row is not 0 0 0 1
[[nodiscard]] Eigen::Affine3d read_dae_transform(const DaeDocument& document,
                                                 const XmlElement& node);

/// Makes the map of the 16 numbers of a matrix, row by row.
///
/// @param where  for errors
[[nodiscard]] Eigen::Affine3d dae_matrix(const DaeDocument& document, const XmlElement& where,
                                         const double* numbers);

/// Reads the finite numbers inside of an element, exactly `count` of them.
[[nodiscard]] std::vector<double> read_dae_row(const DaeDocument& document,
                                               const XmlElement& element, std::size_t count);

}  // namespace firstcontact::detail
