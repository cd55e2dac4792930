/// @file
/// Proven edges and places for planners of OMPL.

#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include <firstcontact/edges/edge_checker.h>

#include "firstcontact_ompl/proven_space.h"

namespace firstcontact {

/// A state is valid if it is within the bounds and proven free; what is undecided is not.
class ProvenStates : public ompl::base::StateValidityChecker {
 public:
  ProvenStates(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<const EdgeChecker> edges)
      : StateValidityChecker(si),
        states_(*si->getStateSpace(), edges->space()),
        edges_(std::move(edges)) {
    specs_.clearanceComputationType = ompl::base::StateValidityCheckerSpecs::BOUNDED_APPROXIMATE;
  }

  bool isValid(const ompl::base::State* state) const override {
    return si_->satisfiesBounds(state) && edges_->is_free(states_.read(state));
  }

  /// [m]  A proven lower bound; 0 where the state is not free. Never infinite: where no pair is
  /// tested, kFarthest.
  double clearance(const ompl::base::State* state) const override {
    return edges_->state(states_.read(state)).clearance.value_or(kFarthest);
  }

  static constexpr double kFarthest = 1e9;  ///< [m]

 private:
  OmplStates states_;
  std::shared_ptr<const EdgeChecker> edges_;
};

/// A motion is valid if the whole edge is proven free; what is undecided is not, and is counted.
/// A motion is not valid either where OMPL may turn the other way or not at all, as planners keep
/// places between and never ask again: OmplStates::has_same_edge() and leaves_out_turn().
///
/// Set it with setMotionValidator() before setup(), beside ProvenStates of the same checker. A
/// motion that is not valid has a last valid state. It is a rounded state of OMPL, and the edge to
/// it is proven by itself.
class ProvenEdges : public ompl::base::MotionValidator {
 public:
  ProvenEdges(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<const EdgeChecker> edges)
      : MotionValidator(si),
        states_(*si->getStateSpace(), edges->space()),
        edges_(std::move(edges)) {}

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override {
    const Configuration start = states_.read(from);
    const Configuration end = states_.read(to);
    return count(is_followed(start, end) ? edges_->check_quickly(start, end) : kBlocked);
  }

  /// The state of `last` may be null, or `to` itself.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last) const override {
    const Configuration start = states_.read(from);
    const Configuration end = states_.read(to);
    const EdgeAnswer answer = is_followed(start, end) ? edges_->check(start, end) : kBlocked;
    if (count(answer)) {
      return true;
    }
    ompl::base::State* reached = si_->allocState();
    last.second = prove_way(from, to, answer.fraction, reached);
    if (last.first != nullptr) {
      si_->copyState(last.first, reached);
    }
    si_->freeState(reached);
    return false;
  }

  /// Motions that took more effort than is allowed; they count as invalid.
  [[nodiscard]] std::size_t undecided() const { return undecided_; }

 private:
  static inline const EdgeAnswer kBlocked{.verdict = EdgeVerdict::blocked};

  /// Whether OMPL interpolates along our edge.
  bool is_followed(const Configuration& from, const Configuration& to) const {
    return states_.has_same_edge(from, to) && !states_.leaves_out_turn(from, to);
  }

  bool count(const EdgeAnswer& answer) const {
    const bool is_free = answer.verdict == EdgeVerdict::free;
    undecided_ += answer.verdict == EdgeVerdict::undecided ? 1 : 0;
    std::atomic_ref(is_free ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
    return is_free;
  }

  /// The state at a fraction, or at a lesser one, to which the edge is proven free; else the start.
  ///
  /// OMPL rounds states by its own arithmetic, and leaves out small turns. So the edge to the
  /// rounded state is proven by itself.
  double prove_way(const ompl::base::State* from, const ompl::base::State* to, double fraction,
                   ompl::base::State* reached) const {
    constexpr int kTries = 3;
    constexpr double kLess =
        1e-4;  // A little back leaves most contacts by more than the tolerance.
    const Configuration start = states_.read(from);
    for (int k = 0; k < kTries && fraction > 0.0; ++k) {
      si_->getStateSpace()->interpolate(from, to, fraction, reached);
      const Configuration place = states_.read(reached);
      if (is_followed(start, place) && edges_->check(start, place).verdict == EdgeVerdict::free) {
        return fraction;
      }
      fraction *= 1.0 - kLess * (k == 0 ? 1.0 : 100.0);
    }
    si_->copyState(reached, from);
    return 0.0;
  }

  OmplStates states_;
  std::shared_ptr<const EdgeChecker> edges_;
  mutable std::atomic<std::size_t> undecided_ = 0;
};

}  // namespace firstcontact
