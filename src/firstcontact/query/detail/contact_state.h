/// @file
/// The features that are close at one instant.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/query/contact.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// What contacts are reported relative to.
struct ContactFrame {
  const Shape& A;
  const Shape& B;
  const MovingPair& pair;
  double t;
  Eigen::Vector3d p_WC;  ///< [m]  Centre of A's hierarchy in the world at t.
};

/// One contact from the closest features of two triangles (indices in the hierarchies' order).
[[nodiscard]] Contact make_contact(const ContactFrame& frame, const RelativeState& state,
                                   std::uint32_t triangle_A, std::uint32_t triangle_B,
                                   const ClosestFeatures& closest);

/// Appends every feature pair within `band` [m] (radii included) of the pairs of triangles that the
/// last search opened, sorted, each once.
void collect_contacts_of(const ContactFrame& frame, double band, WorkspaceData& workspace,
                         std::vector<Contact>& contacts);

/// The same of all triangles.
void collect_contacts(const ContactFrame& frame, double band, WorkspaceData& workspace,
                      std::vector<Contact>& contacts);

}  // namespace firstcontact::detail
