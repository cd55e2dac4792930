/// @file
/// Contacts eight at a time: sweeps for vector units.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {

/// Contacts that share no moving body, one in each lane: solved at once they are solved in any
/// order. Velocities are those of kinetic coordinates x, V = V_free + S x with S S^T = M^-1, of
/// which an impulse changes J^T r where the contact sees J x. A lane without contact, or with one
/// that no impulse would change, sees nothing.
struct alignas(64) ContactBatch {
  static constexpr std::size_t kLanes = 8;
  using Lanes = std::array<double, kLanes>;
  using Jacobian = std::array<std::array<Lanes, 6>, 3>;

  std::array<Jacobian, 2> J = {};        ///< Of A and B, in the turned frames of the rows.
  std::array<Lanes, 3> free = {};        ///< [m/s]   u of the free velocities, beyond the least.
  Lanes normal = {};                     ///< [1/kg]  W_nn
  Lanes inverse_normal = {};             ///< [kg]
  std::array<Lanes, 2> coupling = {};    ///< [-]     W_tn / W_nn
  std::array<Lanes, 2> tangential = {};  ///< [1/kg]  Diagonal of A, see ContactResponse.
  Lanes friction = {};                   ///< [-]
  Lanes greatest = {};                   ///< [1/kg]  Of the diagonal of W.
};

/// Pairs of bodies, one in each lane, that share no moving body, with up to so many contacts each:
/// their bodies are loaded but once for all of them.
struct PairBatch {
  /// Where x of A and B begin; of a lane without pair, behind those of all bodies.
  std::array<std::array<std::int64_t, ContactBatch::kLanes>, 2> at = {};
  std::size_t first = 0;  ///< Contact batch of the first contacts; the others follow.
  std::size_t count = 0;
};

/// One sweep: solves each contact with all others held, pair by pair or in the reverse order. As
/// solve_alone() where it opens, sticks or has no friction; where it slides, two of Newton's steps
/// in each sweep take alpha (see ContactResponse::impulse()) to where it belongs.
///
/// @param impulses  [N s]  of each batch: its normal ones, then those along both tangents
/// @param sliding   [1/kg]  alpha of each lane when it slid last; at first 0
/// @param x         of each body eight numbers, the first six its kinetic coordinates
/// @returns [m/s]  the greatest change of a velocity
double sweep_batches(const std::vector<PairBatch>& pairs, const std::vector<ContactBatch>& batches,
                     bool backwards, double* impulses, double* sliding, double* x);

/// Where a pair is.
struct PairPlace {
  std::size_t batch = 0;
  std::size_t lane = 0;
};

/// A problem of bodies that are no links, in batches. Each body meets its contacts in the order of
/// the rows, so that a sweep does what one over the rows does, but for rounding and what slides.
/// The state of its solution is all impulses, batch by batch, then x.
class ContactBatches {
 public:
  /// @param rows  of the problem; to outlive the batches
  /// @returns nothing where lanes would stay empty: a few bodies with many contacts each, or few
  ///          contacts at all
  [[nodiscard]] static std::optional<ContactBatches> of(const ContactProblem& problem,
                                                        const ContactRows& rows);

  [[nodiscard]] std::size_t batch_count() const { return batches_.size(); }

  /// Of squared lengths of the state: those of impulses, by what they change.
  [[nodiscard]] Eigen::VectorXd weights() const;
  [[nodiscard]] Eigen::VectorXd state_of(const Projection& projection) const;
  /// @returns [m/s]  the greatest change of a velocity
  double sweep(bool backwards, Eigen::VectorXd& state);
  /// With the residual.
  void take(const Eigen::VectorXd& state, Projection& projection) const;

 private:
  explicit ContactBatches(const ContactRows& rows) : rows_(&rows) {}

  [[nodiscard]] bool assign_lanes(const ContactProblem& problem);
  void place_pairs(const std::vector<ContactPoint>& contacts, const std::vector<PairPlace>& places);
  void fill(const ContactProblem& problem);
  [[nodiscard]] Eigen::Index impulse_count() const {
    return static_cast<Eigen::Index>(3 * ContactBatch::kLanes * batches_.size());
  }
  [[nodiscard]] Eigen::Index state_size() const;

  const ContactRows* rows_;
  std::vector<std::size_t> lane_of_;  // Of each contact, counted through all batches.
  std::vector<std::array<std::size_t, 2>> bodies_of_;  // Of each contact.
  std::vector<PairBatch> pairs_;
  std::vector<ContactBatch> batches_;
  std::vector<double> sliding_;  // Of each lane.
  std::size_t bodies_ = 0;
};

}  // namespace firstcontact::detail
