/// @file
/// Contacts eight or sixteen at a time: sweeps for vector units.

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

template <class Number>
using Lanes = std::array<Number, kLanes<Number>>;

/// Contacts that share no moving body, one in each lane: solved at once they are solved in any
/// order. Velocities are those of kinetic coordinates x, V = V_free + S x with S S^T = M^-1, of
/// which an impulse changes J^T r where the contact sees J x. A lane without contact, or with one
/// that no impulse would change, sees nothing. Numbers are multiples of BatchUnits.
template <class Number>
struct alignas(64) ContactBatch {
  using Jacobian = std::array<std::array<Lanes<Number>, 6>, 3>;

  std::array<Jacobian, 2> J = {};                ///< Of A and B, in the turned frames of the rows.
  std::array<Lanes<Number>, 3> free = {};        ///< u of the free velocities, beyond the least.
  Lanes<Number> normal = {};                     ///< W_nn
  Lanes<Number> inverse_normal = {};             ///< 1 / W_nn
  std::array<Lanes<Number>, 2> coupling = {};    ///< W_tn / W_nn
  std::array<Lanes<Number>, 2> tangential = {};  ///< Diagonal of A, see ContactResponse.
  Lanes<Number> friction = {};                   ///< [-]
  Lanes<Number> greatest = {};                   ///< Of the diagonal of W.
};

/// Pairs of bodies, one in each lane, that share no moving body, with up to so many contacts each.
///
/// Their bodies are loaded once for all of these contacts.
template <class Number>
struct PairBatch {
  using Place = std::conditional_t<sizeof(Number) == 4, std::int32_t, std::int64_t>;

  /// Where x of A and B begin; of a lane without pair, behind those of all bodies.
  std::array<std::array<Place, kLanes<Number>>, 2> at = {};
  std::size_t first = 0;  ///< Contact batch of the first contacts; the others follow.
  std::size_t count = 0;
};

/// One sweep: solves each contact with all others held, pair by pair or in the reverse order. As
/// solve_alone() where it opens, sticks or has no friction; where it slides, two of Newton's steps
/// in each sweep take alpha (see ContactResponse::impulse()) to where it belongs.
///
/// @param impulses  of each batch: its normal ones, then those along both tangents
/// @param sliding   alpha of each lane when it slid last; at first 0
/// @param x         of each body eight numbers, the first six its kinetic coordinates
/// @returns  the greatest change of a velocity
double wide_gauss_seidel(const std::vector<PairBatch<double>>& pairs,
                         const std::vector<ContactBatch<double>>& batches, bool backwards,
                         double* impulses, double* sliding, double* x);
float wide_gauss_seidel(const std::vector<PairBatch<float>>& pairs,
                        const std::vector<ContactBatch<float>>& batches, bool backwards,
                        float* impulses, float* sliding, float* x);

/// The units of which the numbers of batches are multiples.
///
/// Single precision has no room for the squares of very small impulses.
struct BatchUnits {
  double velocity = 1.0;  ///< [m/s]
  double response = 1.0;  ///< [1/kg]

  [[nodiscard]] double impulse() const { return velocity / response; }  ///< [N s]
};

/// In which free velocities and responses are about one.
[[nodiscard]] BatchUnits units_of(const ContactRows& rows);

/// A problem of bodies that are no links, in batches.
///
/// Where few lanes stay empty each body meets its contacts in the order of the rows. A sweep then
/// does what one over the rows does, but for rounding and contacts that slide. The state of its
/// solution is all impulses, batch by batch, then x.
template <class Number>
class ContactBatches {
 public:
  using State = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

  /// @param rows  of the problem; to outlive the batches
  /// @returns nothing where lanes would stay empty: a few bodies with many contacts each, or few
  ///          contacts at all
  [[nodiscard]] static std::optional<ContactBatches> of(const ContactProblem& problem,
                                                        const ContactRows& rows,
                                                        const BatchUnits& units = {});

  /// The weights of squared lengths of the state: those of impulses, by their changes of velocity.
  [[nodiscard]] State weights() const;
  [[nodiscard]] State state_of(const Projection& projection) const;
  /// @returns [m/s]  the greatest change of a velocity
  double sweep(bool backwards, State& state);
  /// With the residual.
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
  std::vector<std::size_t> lane_of_;  // Of each contact, counted through all batches.
  std::vector<std::array<std::size_t, 2>> bodies_of_;  // Of each contact.
  std::vector<PairBatch<Number>> pairs_;
  std::vector<ContactBatch<Number>> batches_;
  std::vector<Number> sliding_;  // Of each lane.
  std::size_t bodies_ = 0;
};

extern template class ContactBatches<double>;
extern template class ContactBatches<float>;

}  // namespace firstcontact::detail
