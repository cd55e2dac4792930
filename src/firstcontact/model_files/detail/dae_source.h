/// @file
/// The sources of a COLLADA document: arrays of values, and the rows in them.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/model_files/detail/dae_document.h>

namespace firstcontact::detail {

/// Reads points by the parameters X, Y and Z in any order, or by the first three where none is
/// named.
///
/// Words for numbers that are not finite ("NaN", "-1.#IND", "INF") are accepted: only points that
/// are used have to be finite.
///
/// @throws ParseError  rows that the array does not have, other parameters, words that are no
///         numbers, a count that contradicts the array
[[nodiscard]] std::vector<Eigen::Vector3d> read_dae_points(const DaeDocument& document,
                                                           const XmlElement& source);

/// Reads rows of `width` numbers, one after another.
///
/// @throws ParseError  as read_dae_points
[[nodiscard]] std::vector<double> read_dae_numbers(const DaeDocument& document,
                                                   const XmlElement& source, std::size_t width);

/// Names of joints or geometries.
struct DaeNames {
  std::vector<std::string> names;
  bool ids = false;  ///< Whether names are ids of the document, not sids.
};

/// Reads names.
///
/// @throws ParseError  as read_dae_points
[[nodiscard]] DaeNames read_dae_names(const DaeDocument& document, const XmlElement& source);

}  // namespace firstcontact::detail
