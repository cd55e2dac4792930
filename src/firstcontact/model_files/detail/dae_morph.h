/// @file
/// Morphs of a COLLADA document at the weights that the file states.

#pragma once

#include <vector>

#include <Eigen/Core>

#include <firstcontact/model_files/detail/dae_budget.h>
#include <firstcontact/model_files/detail/dae_document.h>
#include <firstcontact/model_files/detail/dae_geometry.h>

namespace firstcontact::detail {

/// Finds the base geometry of a <morph>.
[[nodiscard]] const XmlElement& dae_morph_base(const DaeDocument& document,
                                               const XmlElement& morph);

/// Reads the positions of the base geometry, morphed by its targets.
///
/// They are b (1 - sum of w_i) + sum of w_i t_i where the method is NORMALIZED, b + sum of w_i t_i
/// where it is RELATIVE. Targets of weight 0 are not read.
///
/// Source: "COLLADA – Digital Asset Schema Release 1.4.1", <morph>.
///
/// @throws ParseError  another method, a target that is no geometry or has other numbers of
///         vertices or weights
[[nodiscard]] std::vector<Eigen::Vector3d> read_dae_morph(const DaeDocument& document,
                                                          DaeGeometries& geometries,
                                                          DaeBudget& budget,
                                                          const XmlElement& morph);

}  // namespace firstcontact::detail
