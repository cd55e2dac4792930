/// @file
/// Contacts in batches of eight or sixteen: sweeps for vector units.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/graph_colouring.h>

namespace firstcontact::detail {

/// The number of lanes of a vector of 512 bits.
template <class Number>
constexpr std::size_t kLanes = 64 / sizeof(Number);

/// One number for each lane.
template <class Number>
using Lanes = std::array<Number, kLanes<Number>>;

/// Contacts that share no moving body, one in each lane. Any order of solving them gives the same.
///
/// Velocities are those of mass-whitened coordinates x, V = V_free + S x with S S^T = M^-1. A
/// contact has the velocity J x, and its impulse r changes x by J^T r. J is zero for a lane without
/// a contact, or with a contact that no impulse would change. Numbers are multiples of BatchUnits.
template <class Number>
struct alignas(64) ContactBatch {
  using Jacobian = std::array<std::array<Lanes<Number>, 6>, 3>;

  std::array<Jacobian, 2> J = {};  ///< Jacobians of A and B, in the turned frames of the rows.
  std::array<Lanes<Number>, 3> free = {};        ///< u of the free velocities, less the target.
  Lanes<Number> normal = {};                     ///< W_nn
  Lanes<Number> inverse_normal = {};             ///< 1 / W_nn
  std::array<Lanes<Number>, 2> coupling = {};    ///< W_tn / W_nn
  std::array<Lanes<Number>, 2> tangential = {};  ///< Diagonal of A, see ContactResponse.
  Lanes<Number> friction = {};                   ///< [-]
  Lanes<Number> greatest = {};                   ///< Greatest entry of the diagonal of W.
};

/// Pairs of bodies, one in each lane, that share no moving body, with up to `count` contacts each.
///
/// The bodies are loaded once for all of these contacts.
template <class Number>
struct PairBatch {
  using Place = std::conditional_t<sizeof(Number) == 4, std::int32_t, std::int64_t>;

  /// Index of the first number of x of A and B; for a lane without a pair, behind all bodies.
  std::array<std::array<Place, kLanes<Number>>, 2> at = {};
  std::size_t first = 0;  ///< Batch of the first contacts; the batches of the others follow.
  std::size_t count = 0;  ///< Number of batches.
};

/// Runs one sweep: solves each contact with all others held, pair by pair or in the reverse order.
///
/// A contact that opens, sticks or has no friction is solved as by solve_alone(). For a contact
/// that slides, two of Newton's steps in each sweep bring alpha (see ContactResponse::impulse())
/// nearer to its value.
///
/// @param impulses  for each batch its normal ones, then those along both tangents
/// @param sliding   alpha of each lane when it slid last; at first 0
/// @param x         eight numbers for each body, of which the first six are its mass-whitened
///         coordinates
double wide_gauss_seidel(const std::vector<PairBatch<double>>& pairs,
                         const std::vector<ContactBatch<double>>& batches, bool backwards,
                         double* impulses, double* sliding, double* x);
float wide_gauss_seidel(const std::vector<PairBatch<float>>& pairs,
                        const std::vector<ContactBatch<float>>& batches, bool backwards,
                        float* impulses, float* sliding, float* x);

/// The units of the numbers of batches.
///
/// In SI units the squares of very small impulses would underflow in single precision.
struct BatchUnits {
  double velocity = 1.0;  ///< [m/s]
  double response = 1.0;  ///< [1/kg]

  [[nodiscard]] double impulse() const { return velocity / response; }  ///< [N s]
};

/// Finds units in which free velocities and responses are about one.
[[nodiscard]] BatchUnits units_of(const ContactRows& rows);

/// A problem of bodies that are no links, in batches.
///
/// Where few lanes stay empty, each body meets its contacts in the order of the rows. A sweep is
/// then one over the rows, but for rounding and contacts that slide. The state of its solution is
/// all impulses, batch by batch, then x.
template <class Number>
class ContactBatches {
 public:
  using State = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

  /// Puts the contacts of a problem into batches.
  ///
  /// @param rows  of the problem; to outlive the batches
  /// @returns nothing where lanes would stay empty: a few bodies with many contacts each, or few
  ///          contacts at all
  [[nodiscard]] static std::optional<ContactBatches> of(const ContactProblem& problem,
                                                        const ContactRows& rows,
                                                        const BatchUnits& units = {});

  /// The weights of squared lengths of the state: impulses count by their changes of velocity.
  [[nodiscard]] State weights() const;
  /// The state of a projection.
  [[nodiscard]] State state_of(const Projection& projection) const;
  /// Runs a sweep.
  ///
  /// @returns [m/s]  the greatest change of a velocity
  double sweep(bool backwards, State& state);
  /// Writes a state to a projection, with its residual.
  void take(const State& state, Projection& projection) const;

 private:
  ContactBatches(const ContactRows& rows, const BatchUnits& units) : rows_(&rows), units_(units) {}

  void take_lanes(const std::vector<ContactPoint>& contacts, const GraphColouring& lanes);
  void fill(const ContactProblem& problem);
  [[nodiscard]] Eigen::Index impulse_count() const {
    return static_cast<Eigen::Index>(3 * kLanes<Number> * batches_.size());
  }
  [[nodiscard]] Eigen::Index state_size() const;

  const ContactRows* rows_;
  BatchUnits units_;
  std::vector<std::size_t> lane_of_;  // Lane of each contact, counted through all batches.
  std::vector<std::array<std::size_t, 2>> bodies_of_;  // Bodies of each contact.
  std::vector<PairBatch<Number>> pairs_;
  std::vector<ContactBatch<Number>> batches_;
  std::vector<Number> sliding_;  // Alpha of each lane.
  std::size_t bodies_ = 0;
};

extern template class ContactBatches<double>;
extern template class ContactBatches<float>;

}  // namespace firstcontact::detail
