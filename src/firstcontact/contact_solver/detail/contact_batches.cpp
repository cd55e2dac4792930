#include <firstcontact/contact_solver/detail/contact_batches.h>

#include <algorithm>
#include <cmath>

#include <firstcontact/contact_solver/detail/constants.h>
#include <firstcontact/contact_solver/detail/coulomb_cone.h>
#include <firstcontact/contact_solver/detail/mass_whitened_coordinates.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kNumbersOfBody = 8;  // Numbers in x.

/// The index in the state of a lane's first impulse; the others follow at distances of the number
/// of lanes.
template <class Number>
Index place_of(std::size_t lane) {
  constexpr std::size_t lanes = kLanes<Number>;
  return static_cast<Index>(lane / lanes * 3 * lanes + lane % lanes);
}

}  // namespace

BatchUnits units_of(const ContactRows& rows) {
  double fastest = 0.0;
  double sum = 0.0;
  std::size_t count = 0;
  for (const ContactRow& row : rows.contacts) {
    if (row.greatest() > 0.0) {
      fastest = std::max(fastest, row.excess_velocity(rows.free_velocities).cwiseAbs().maxCoeff());
      sum += std::log(row.greatest());
      ++count;
    }
  }
  return {fastest > 0.0 ? fastest : 1.0,
          count > 0 ? std::exp(sum / static_cast<double>(count)) : 1.0};
}

template <class Number>
std::optional<ContactBatches<Number>> ContactBatches<Number>::of(const ContactProblem& problem,
                                                                 const ContactRows& rows,
                                                                 const BatchUnits& units) {
  if (problem.contacts.size() < kFewContacts || !problem.mechanisms.empty() ||
      !problem.ties.empty()) {
    return std::nullopt;
  }
  const bool in_any_order = sizeof(Number) == 4 || problem.contacts.size() >= kVeryManyInOrder;
  const std::optional<GraphColouring> lanes = place_pairs(problem, kLanes<Number>, in_any_order);
  if (!lanes) {
    return std::nullopt;
  }
  ContactBatches made(rows, units);
  made.bodies_ = problem.bodies.size();
  made.take_lanes(problem.contacts, *lanes);
  made.fill(problem);
  return made;
}

template <class Number>
void ContactBatches<Number>::take_lanes(const std::vector<ContactPoint>& contacts,
                                        const GraphColouring& lanes) {
  using Place = typename PairBatch<Number>::Place;
  const auto place_of_body = [](std::size_t body) {
    return static_cast<Place>(kNumbersOfBody * body);
  };
  std::size_t batches = 0;
  for (const std::size_t count : lanes.counts) {
    PairBatch<Number> pair{.first = batches, .count = count};
    pair.at[0].fill(place_of_body(bodies_));
    pair.at[1].fill(place_of_body(bodies_));
    pairs_.push_back(pair);
    batches += count;
  }
  batches_.resize(batches);
  sliding_.assign(batches * kLanes<Number>, Number());
  for (std::size_t first = 0; first < contacts.size();) {
    const auto [batch, lane] = lanes.places[first];
    PairBatch<Number>& pair = pairs_[batch];
    for (std::size_t side = 0; side < 2; ++side) {
      pair.at[side][lane] = place_of_body(contacts[first].bodies[side]);
    }
    const std::size_t count = count_of_pair(contacts, first);
    for (std::size_t k = 0; k < count; ++k) {
      lane_of_.push_back((pair.first + k) * kLanes<Number> + lane);
      bodies_of_.push_back(contacts[first].bodies);
    }
    first += count;
  }
}

template <class Number>
void ContactBatches<Number>::fill(const ContactProblem& problem) {
  const auto number = [](double value) { return static_cast<Number>(value); };
  std::vector<Matrix6d> roots;
  for (const ContactBody& body : problem.bodies) {
    roots.push_back(is_movable(body)
                        ? Matrix6d(square_root(body.inverse_inertia) / std::sqrt(units_.response))
                        : Matrix6d(Matrix6d::Zero()));
  }
  for (ContactBatch<Number>& batch : batches_) {
    // Filled as lanes without contact: nothing is divided by zero.
    batch.normal.fill(1);
    batch.inverse_normal.fill(1);
    batch.tangential = {batch.normal, batch.normal};
  }
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    const ContactRow& row = rows_->contacts[k];
    if (!(row.greatest() > 0.0)) {
      continue;  // No impulse would change anything.
    }
    ContactBatch<Number>& batch = batches_[lane_of_[k] / kLanes<Number>];
    const std::size_t lane = lane_of_[k] % kLanes<Number>;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t body = problem.contacts[k].bodies[side];
      const RowSide::Jacobian J = row.sides[side].J * roots[body];
      for (int i = 0; i < 3; ++i) {
        for (int c = 0; c < 6; ++c) {
          batch.J[side][i][c][lane] = number(J(i, c));
        }
      }
    }
    const Vector3d free = row.excess_velocity(rows_->free_velocities);
    for (int i = 0; i < 3; ++i) {
      batch.free[i][lane] = number(free[i] / units_.velocity);
    }
    batch.normal[lane] = number(row.own.W()(0, 0) / units_.response);
    batch.inverse_normal[lane] = number(units_.response / row.own.W()(0, 0));
    for (int i = 0; i < 2; ++i) {
      batch.coupling[i][lane] = number(row.own.coupling()[i]);
      batch.tangential[i][lane] = number(row.own.tangential()[i] / units_.response);
    }
    batch.friction[lane] = number(row.friction);
    batch.greatest[lane] = number(row.greatest() / units_.response);
  }
}

template <class Number>
Index ContactBatches<Number>::state_size() const {
  return impulse_count() + static_cast<Index>(kNumbersOfBody * (bodies_ + 1));
}

template <class Number>
auto ContactBatches<Number>::weights() const -> State {
  State weights = State::Zero(state_size());
  Index at = 0;
  for (const ContactBatch<Number>& batch : batches_) {
    for (int i = 0; i < 3; ++i) {
      std::ranges::copy(batch.greatest, weights.data() + at);
      at += static_cast<Index>(kLanes<Number>);
    }
  }
  return weights;
}

/// The velocities are added up in double precision.
template <class Number>
auto ContactBatches<Number>::state_of(const Projection& projection) const -> State {
  State state = State::Zero(state_size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(state_size() - impulse_count());
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    const ContactBatch<Number>& batch = batches_[lane_of_[k] / kLanes<Number>];
    const std::size_t lane = lane_of_[k] % kLanes<Number>;
    for (int i = 0; i < 3; ++i) {
      const double impulse = projection.impulses.contacts[k][i] / units_.impulse();
      state[place_of<Number>(lane_of_[k]) + static_cast<Index>(kLanes<Number>) * i] =
          static_cast<Number>(impulse);
      for (std::size_t side = 0; side < 2; ++side) {
        const auto at = static_cast<Index>(kNumbersOfBody * bodies_of_[k][side]);
        for (std::size_t c = 0; c < 6; ++c) {
          x[at + static_cast<Index>(c)] += batch.J[side][i][c][lane] * impulse;
        }
      }
    }
  }
  state.tail(x.size()) = x.template cast<Number>();
  return state;
}

template <class Number>
void ContactBatches<Number>::take(const State& state, Projection& projection) const {
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    Vector3d impulse;
    for (int i = 0; i < 3; ++i) {
      impulse[i] = state[place_of<Number>(lane_of_[k]) + static_cast<Index>(kLanes<Number>) * i];
    }
    projection.impulses.contacts[k] =
        project_on_cone(units_.impulse() * impulse, rows_->contacts[k].friction);
  }
  projection.velocities = velocities_after(*rows_, projection.impulses);
  projection.residual = greatest_residual(*rows_, projection.impulses, projection.velocities);
}

template <class Number>
double ContactBatches<Number>::sweep(bool backwards, State& state) {
  return units_.velocity * wide_gauss_seidel(pairs_, batches_, backwards, state.data(),
                                             sliding_.data(), state.data() + impulse_count());
}

template class ContactBatches<double>;
template class ContactBatches<float>;

}  // namespace firstcontact::detail
