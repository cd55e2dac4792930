#include <firstcontact/dynamics/detail/contact_batches.h>

#include <algorithm>
#include <utility>

#include <firstcontact/dynamics/detail/kinetic_coordinates.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kLanes = ContactBatch::kLanes;

/// Fewer are swept one by one.
constexpr std::size_t kFewContacts = 32;
constexpr double kLeastFill = 0.375;  // [-]  Of the lanes.

constexpr std::size_t kImpulsesOfBatch = 3 * kLanes;
constexpr std::size_t kNumbersOfBody = 8;  // In x.

/// So many contacts of a pair in turn are solved before other pairs.
constexpr std::size_t kMostOfPair = 4;

/// Gives out the lanes of pair batches, each from a batch on; skips many full ones at once.
class FreeLanes {
 public:
  /// @param count  of the pair's contacts
  PairPlace take_from(std::size_t batch, std::size_t count) {
    const std::size_t found = likest_with_room(batch, count);
    while (used_.size() <= found) {
      next_.push_back(used_.size());
      used_.push_back(0);
      counts_.push_back(0);
    }
    const PairPlace place{found, used_[found]++};
    counts_[found] = std::max(counts_[found], count);
    if (used_[found] == kLanes) {
      next_[found] = found + 1;
    }
    return place;
  }
  /// The most contacts that a pair has, of each batch.
  [[nodiscard]] const std::vector<std::size_t>& counts() const { return counts_; }

 private:
  /// Pairs with as many contacts leave no lane empty: of a few batches the one whose pairs have, or
  /// else the first.
  std::size_t likest_with_room(std::size_t batch, std::size_t count) {
    const std::size_t first = first_with_room(batch);
    std::size_t found = first;
    for (int look = 0; look < kLooks && found < used_.size(); ++look) {
      if (counts_[found] == count) {
        return found;
      }
      found = first_with_room(found + 1);
    }
    return first;
  }

  std::size_t first_with_room(std::size_t batch) {
    std::size_t found = batch;
    while (found < next_.size() && next_[found] != found) {
      found = next_[found];
    }
    while (batch < found && batch < next_.size()) {
      batch = std::exchange(next_[batch], found);
    }
    return found;
  }

  static constexpr int kLooks = 16;

  std::vector<std::size_t> next_;  // Of each batch: itself, or a later one where it is full.
  std::vector<std::size_t> used_;
  std::vector<std::size_t> counts_;
};

/// How many contacts from one on are of the same pair, up to kMostOfPair.
std::size_t count_of_pair(const std::vector<ContactPoint>& contacts, std::size_t first) {
  std::size_t count = 1;
  while (count < kMostOfPair && first + count < contacts.size() &&
         contacts[first + count].bodies == contacts[first].bodies) {
    ++count;
  }
  return count;
}

/// Where in x a body begins.
std::int64_t place_of_body(std::size_t body) {
  return static_cast<std::int64_t>(kNumbersOfBody * body);
}

/// Where in the state the first impulse of a lane is; the others follow by kLanes each.
Index place_of(std::size_t lane) {
  return static_cast<Index>(lane / kLanes * kImpulsesOfBatch + lane % kLanes);
}

}  // namespace

std::optional<ContactBatches> ContactBatches::of(const ContactProblem& problem,
                                                 const ContactRows& rows) {
  ContactBatches made(rows);
  if (problem.contacts.size() < kFewContacts || !problem.mechanisms.empty() ||
      !made.assign_lanes(problem)) {
    return std::nullopt;
  }
  made.fill(problem);
  return made;
}

/// Whether that leaves few lanes empty.
bool ContactBatches::assign_lanes(const ContactProblem& problem) {
  const std::vector<ContactPoint>& contacts = problem.contacts;
  bodies_ = problem.bodies.size();
  std::vector<std::size_t> first_batch(bodies_, 0);  // After the last one of the body.
  std::vector<PairPlace> places(contacts.size());
  FreeLanes lanes;
  for (std::size_t k = 0; k < contacts.size(); k += count_of_pair(contacts, k)) {
    const auto [a, b] = contacts[k].bodies;
    places[k] =
        lanes.take_from(std::max(first_batch[a], first_batch[b]), count_of_pair(contacts, k));
    for (const std::size_t body : contacts[k].bodies) {
      first_batch[body] = is_movable(problem.bodies[body]) ? places[k].batch + 1 : 0;
    }
  }
  std::size_t batches = 0;
  for (const std::size_t count : lanes.counts()) {
    pairs_.push_back({.first = batches, .count = count});
    batches += count;
  }
  if (static_cast<double>(contacts.size()) < kLeastFill * static_cast<double>(batches * kLanes)) {
    return false;
  }
  place_pairs(contacts, places);
  batches_.resize(batches);
  sliding_.assign(batches * kLanes, 0.0);
  return true;
}

/// @param places  of the first contact of each pair
void ContactBatches::place_pairs(const std::vector<ContactPoint>& contacts,
                                 const std::vector<PairPlace>& places) {
  const std::int64_t nowhere = place_of_body(bodies_);
  for (PairBatch& pair : pairs_) {
    pair.at[0].fill(nowhere);
    pair.at[1].fill(nowhere);
  }
  for (std::size_t first = 0; first < contacts.size();) {
    const auto [batch, lane] = places[first];
    PairBatch& pair = pairs_[batch];
    for (std::size_t side = 0; side < 2; ++side) {
      pair.at[side][lane] = place_of_body(contacts[first].bodies[side]);
    }
    const std::size_t count = count_of_pair(contacts, first);
    for (std::size_t k = 0; k < count; ++k) {
      lane_of_.push_back((pair.first + k) * kLanes + lane);
      bodies_of_.push_back(contacts[first].bodies);
    }
    first += count;
  }
}

void ContactBatches::fill(const ContactProblem& problem) {
  std::vector<Matrix6d> roots;
  for (const ContactBody& body : problem.bodies) {
    roots.push_back(is_movable(body) ? square_root(body.inverse_inertia) : Matrix6d::Zero());
  }
  for (ContactBatch& batch : batches_) {  // As lanes without contact: nothing is divided by zero.
    batch.normal.fill(1.0);
    batch.inverse_normal.fill(1.0);
    batch.tangential = {batch.normal, batch.normal};
  }
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    const ContactRow& row = rows_->contacts[k];
    if (!(row.greatest() > 0.0)) {
      continue;  // No impulse would change anything.
    }
    ContactBatch& batch = batches_[lane_of_[k] / kLanes];
    const std::size_t lane = lane_of_[k] % kLanes;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t body = problem.contacts[k].bodies[side];
      const RowSide::Jacobian J = row.sides[side].J * roots[body];
      for (int i = 0; i < 3; ++i) {
        for (int c = 0; c < 6; ++c) {
          batch.J[side][i][c][lane] = J(i, c);
        }
      }
    }
    const Vector3d free = row.excess_velocity(rows_->free_velocities);
    for (int i = 0; i < 3; ++i) {
      batch.free[i][lane] = free[i];
    }
    batch.normal[lane] = row.own.W()(0, 0);
    batch.inverse_normal[lane] = 1.0 / row.own.W()(0, 0);
    for (int i = 0; i < 2; ++i) {
      batch.coupling[i][lane] = row.own.coupling()[i];
      batch.tangential[i][lane] = row.own.tangential()[i];
    }
    batch.friction[lane] = row.friction;
    batch.greatest[lane] = row.greatest();
  }
}

Index ContactBatches::state_size() const {
  return impulse_count() + static_cast<Index>(kNumbersOfBody * (bodies_ + 1));
}

VectorXd ContactBatches::weights() const {
  VectorXd weights = VectorXd::Zero(state_size());
  Index at = 0;
  for (const ContactBatch& batch : batches_) {
    for (int i = 0; i < 3; ++i) {
      std::ranges::copy(batch.greatest, weights.data() + at);
      at += kLanes;
    }
  }
  return weights;
}

VectorXd ContactBatches::state_of(const Projection& projection) const {
  VectorXd state = VectorXd::Zero(state_size());
  double* const x = state.data() + impulse_count();
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    const ContactBatch& batch = batches_[lane_of_[k] / kLanes];
    const std::size_t lane = lane_of_[k] % kLanes;
    for (int i = 0; i < 3; ++i) {
      const double impulse = projection.impulses.contacts[k][i];
      state[place_of(lane_of_[k]) + static_cast<Index>(kLanes) * i] = impulse;
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::int64_t c = 0; c < 6; ++c) {
          x[place_of_body(bodies_of_[k][side]) + c] += batch.J[side][i][c][lane] * impulse;
        }
      }
    }
  }
  return state;
}

void ContactBatches::take(const VectorXd& state, Projection& projection) const {
  for (std::size_t k = 0; k < lane_of_.size(); ++k) {
    for (int i = 0; i < 3; ++i) {
      projection.impulses.contacts[k][i] =
          state[place_of(lane_of_[k]) + static_cast<Index>(kLanes) * i];
    }
  }
  projection.velocities = velocities_after(*rows_, projection.impulses);
  projection.residual = greatest_residual(*rows_, projection.impulses, projection.velocities);
}

double ContactBatches::sweep(bool backwards, VectorXd& state) {
  return sweep_batches(pairs_, batches_, backwards, state.data(), sliding_.data(),
                       state.data() + impulse_count());
}

}  // namespace firstcontact::detail
