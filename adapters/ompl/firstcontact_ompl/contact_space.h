/// @file
/// Motion along contacts for planners of OMPL: where a straight edge is blocked, it slides on.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <utility>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/contact_ways.h>

#include "firstcontact_ompl/proven_space.h"

namespace firstcontact {

struct ContactSpaceOptions {
  double range = 0.0;      ///< As ContactWays has it.
  bool slides = true;      ///< Without it all edges are straight.
  double passages = 0.25;  ///< [-]  Share of samples that lie in narrow gaps, of a body.
};

/// A space of OMPL whose edges are proven ways along contacts.
///
/// Between two states lies the straight edge where it is proven free, else a way that slides along
/// what blocks it (ContactWays). So planners of OMPL that know nothing of contacts grow along them:
/// interpolate() leads as far as contacts let it, and ContactEdges accepts motions that slide to
/// their end. It remembers these ways, as a slide depends on where it was to go. expand() puts
/// their places into a path; without it the path has edges that are not straight.
///
/// Some samples lie in narrow gaps that fit thin parts of the body, with proven ways out of them
/// (ContactWays::passage()).
///
/// Distances, and so the costs of paths before expand(), are those of straight edges. The memory
/// grows with every way until forget(). Thread-safe; one lock is held while a way is looked up.
class ContactStateSpace : public ChainedStateSpace {
 public:
  /// @param straight  of the same places as the edges: see make_ompl_space()
  /// @throws std::invalid_argument as OmplStates and ContactWays do
  ContactStateSpace(const ompl::base::StateSpacePtr& straight,
                    std::shared_ptr<const EdgeChecker> edges,
                    const ContactSpaceOptions& options = {})
      : ChainedStateSpace(straight),
        states_(*this, edges->space()),
        options_(options),
        ways_(std::move(edges), options.range) {}

  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<Sampler>(this, ChainedStateSpace::allocDefaultStateSampler());
  }

  /// Draws a way through a narrow gap, and remembers it; without places where none was found.
  [[nodiscard]] std::vector<Configuration> passage(RandomNumbers& random) const {
    const Way way = ways_.passage(random).places;
    return way.empty() ? way : within_bounds(way, nullptr);
  }

  /// The place at a share of the way between two states. Where no way is known yet, the mover
  /// slides towards the place at that share of the straight edge. The state is where this slide
  /// ends: `from` if it leads nowhere.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double share,
                   ompl::base::State* state) const override {
    if (share <= 0.0 || share >= 1.0) {
      copyState(state, share <= 0.0 ? from : to);
      return;
    }
    const Configuration begin = states_.read(from);
    const Configuration end = states_.read(to);
    if (const std::optional<Configuration> place = split(begin, end, share)) {
      states_.write(*place, state);
      return;
    }
    ChainedStateSpace::interpolate(from, to, share, state);
    states_.write(slide(begin, states_.read(state)).back(), state);
  }

  /// The way towards a place, as far as it leads: a known one, the straight edge, or a slide. It
  /// ends nearer to the place than it begins, or has its begin alone.
  [[nodiscard]] std::vector<Configuration> way(const Configuration& from,
                                               const Configuration& to) const {
    std::optional<Way> known = recall(from, to);
    return known ? *std::move(known) : slide(from, to);
  }

  /// Puts the places of ways into a path, so that its edges are straight, and proves each of them.
  ///
  /// @return false where one is not proven; the path is as it was then
  [[nodiscard]] bool expand(ompl::geometric::PathGeometric& path) const {
    if (path.getStateCount() == 0) {
      return true;
    }
    Way places = {read(path, 0)};
    for (std::size_t k = 0; k + 1 < path.getStateCount(); ++k) {
      const Configuration to = read(path, k + 1);
      const Way next = way(places.back(), to);
      if (next.back() != to) {
        return false;
      }
      places.insert(places.end(), next.begin() + 1, next.end());
    }
    bool is_proven = is_free(places.front(), places.front());
    for (std::size_t k = 0; k + 1 < places.size() && is_proven; ++k) {
      is_proven = is_free(places[k], places[k + 1]);
    }
    if (is_proven) {
      write(places, path);
    }
    return is_proven;
  }

  /// Forgets all ways. Paths that were found before can no longer be expanded.
  void forget() {
    const std::unique_lock lock(mutex_);
    known_.clear();
    marks_.clear();
  }

  [[nodiscard]] const OmplStates& states() const { return states_; }

 private:
  using Way = std::vector<Configuration>;

  /// Draws from the whole space, and now and then from narrow gaps.
  class Sampler : public ompl::base::StateSampler {
   public:
    Sampler(const ContactStateSpace* space, ompl::base::StateSamplerPtr inner)
        : StateSampler(space), contacts_(space), inner_(std::move(inner)) {}

    void sampleUniform(ompl::base::State* state) override {
      if (drawn_.empty() && rng_.uniform01() < contacts_->options_.passages) {
        // Its ends are easy to reach, and the way leads on from there.
        RandomNumbers random(static_cast<std::uint64_t>(rng_.uniformInt(0, 1 << 30)));
        if (const Way way = contacts_->passage(random); !way.empty()) {
          drawn_ = {way.back(), way.front()};
        }
      }
      if (drawn_.empty()) {
        inner_->sampleUniform(state);
        return;
      }
      contacts_->states_.write(drawn_.back(), state);
      drawn_.pop_back();
    }

    void sampleUniformNear(ompl::base::State* state, const ompl::base::State* near,
                           double distance) override {
      inner_->sampleUniformNear(state, near, distance);
    }

    void sampleGaussian(ompl::base::State* state, const ompl::base::State* mean,
                        double deviation) override {
      inner_->sampleGaussian(state, mean, deviation);
    }

   private:
    const ContactStateSpace* contacts_;
    ompl::base::StateSamplerPtr inner_;
    Way drawn_;
  };

  /// A way, and the length of it until each of its places.
  struct KnownWay {
    Way places;
    std::vector<double> lengths;
  };
  /// A place on a way: at one of its own, or on the edge behind it.
  struct Mark {
    std::size_t way = 0;
    double length = 0.0;
  };

  [[nodiscard]] Configuration read(ompl::geometric::PathGeometric& path, std::size_t k) const {
    return states_.read(path.getState(static_cast<unsigned int>(k)));
  }

  void write(const Way& places, ompl::geometric::PathGeometric& path) const {
    std::vector<ompl::base::State*>& states = path.getStates();
    for (ompl::base::State* state : states) {
      freeState(state);
    }
    states.clear();
    for (const Configuration& place : places) {
      states.push_back(allocState());
      states_.write(place, states.back());
    }
  }

  [[nodiscard]] bool is_free(const Configuration& from, const Configuration& to) const {
    return states_.has_same_edge(from, to) &&
           ways_.edges().check_quickly(from, to).verdict == EdgeVerdict::free;
  }

  /// Goes towards a place, and remembers the way.
  [[nodiscard]] Way slide(const Configuration& from, const Configuration& target) const {
    if (!options_.slides) {
      return is_free(from, target) ? Way{from, target} : Way{from};
    }
    return within_bounds(ways_.follow(from, target).places, &target);
  }

  /// Cuts a way where it leaves the bounds, where OMPL may turn the other way, and where it is
  /// nearest to its target if it has one: a way that leads away again would let planners turn in
  /// circles. Remembers it.
  ///
  /// @param found  at least one place
  [[nodiscard]] Way within_bounds(const Way& found, const Configuration* target) const {
    Way way;
    std::size_t size = 0;
    double nearest = std::numeric_limits<double>::infinity();
    ompl::base::State* at = allocState();
    ompl::base::State* goal = allocState();
    states_.write(target != nullptr ? *target : found.front(), goal);
    for (std::size_t k = 0; k < found.size(); ++k) {
      states_.write(found[k], at);
      Configuration place = states_.read(at);  // Angles within a turn.
      const bool is_as_found = place == found[k] && (k == 0 || way.back() == found[k - 1]);
      const Configuration& before = k == 0 ? place : way.back();
      if (k > 0 && !(satisfiesBounds(at) && states_.has_same_edge(before, place) &&
                     (is_as_found || is_free(before, place)))) {
        break;
      }
      way.push_back(std::move(place));
      const double left = target != nullptr ? distance(at, goal) : -static_cast<double>(k);
      size = left < nearest ? k + 1 : size;
      nearest = std::min(nearest, left);
    }
    freeState(at);
    freeState(goal);
    way.resize(size);
    remember(way);
    return way;
  }

  void remember(const Way& way) const {
    if (way.size() <= 2) {
      return;  // A straight edge.
    }
    KnownWay known = {way, {0.0}};
    for (std::size_t k = 0; k + 1 < way.size(); ++k) {
      known.lengths.push_back(known.lengths.back() +
                              ways_.edges().space().distance(way[k], way[k + 1]));
    }
    const std::unique_lock lock(mutex_);
    marks_[way.front()].push_back({known_.size(), 0.0});
    marks_[way.back()].push_back({known_.size(), known.lengths.back()});
    known_.push_back(std::move(known));
  }

  /// The marks of two places on one way; none where they have none in common. Under the lock.
  [[nodiscard]] std::optional<std::pair<Mark, Mark>> common_way(const Configuration& from,
                                                                const Configuration& to) const {
    const auto first = marks_.find(from);
    const auto second = marks_.find(to);
    if (from == to || first == marks_.end() || second == marks_.end()) {
      return std::nullopt;
    }
    for (const Mark& begin : first->second) {
      for (const Mark& end : second->second) {
        if (begin.way == end.way) {
          return std::pair(begin, end);
        }
      }
    }
    return std::nullopt;
  }

  /// The piece of a known way between two of its places, in either direction.
  [[nodiscard]] std::optional<Way> recall(const Configuration& from,
                                          const Configuration& to) const {
    const std::shared_lock lock(mutex_);
    const auto marks = common_way(from, to);
    if (!marks) {
      return std::nullopt;
    }
    const KnownWay& known = known_[marks->first.way];
    const auto [low, high] = std::minmax(marks->first.length, marks->second.length);
    Way between;
    for (std::size_t k = 0; k < known.places.size(); ++k) {
      if (low < known.lengths[k] && known.lengths[k] < high) {
        between.push_back(known.places[k]);
      }
    }
    if (marks->second.length < marks->first.length) {
      std::reverse(between.begin(), between.end());
    }
    between.insert(between.begin(), from);
    between.push_back(to);
    return between;
  }

  /// The place at a share of a known way, which it marks there: planners split edges that they
  /// have, and ask no validator again.
  [[nodiscard]] std::optional<Configuration> split(const Configuration& from,
                                                   const Configuration& to, double share) const {
    const std::unique_lock lock(mutex_);
    const auto marks = common_way(from, to);
    if (!marks) {
      return std::nullopt;
    }
    const auto [begin, end] = *marks;
    const KnownWay& known = known_[begin.way];
    const double at = begin.length + share * (end.length - begin.length);
    const auto behind = std::upper_bound(known.lengths.begin() + 1, known.lengths.end() - 1, at);
    const auto edge = static_cast<std::size_t>(behind - known.lengths.begin()) - 1;
    const double length = known.lengths[edge + 1] - known.lengths[edge];
    const double part =
        length > 0.0 ? std::clamp((at - known.lengths[edge]) / length, 0.0, 1.0) : 0.0;
    const Configuration place =
        ways_.edges().space().interpolate(known.places[edge], known.places[edge + 1], part);
    ompl::base::State* state = allocState();
    states_.write(place, state);  // Angles within a turn.
    Configuration marked = states_.read(state);
    freeState(state);
    marks_[marked].push_back({begin.way, at});
    return marked;
  }

  OmplStates states_;
  ContactSpaceOptions options_;
  ContactWays ways_;
  mutable std::shared_mutex mutex_;
  mutable std::vector<KnownWay> known_;
  mutable std::map<Configuration, std::vector<Mark>> marks_;
};

/// A motion is valid if a proven way leads from its start to its end, straight or along contacts.
///
/// For a SpaceInformation of a ContactStateSpace, beside ProvenStates. A motion that is not valid
/// has the place that the slide reached as its last valid state, with the share of the distance to
/// the end that was gained.
class ContactEdges : public ompl::base::MotionValidator {
 public:
  /// @throws std::invalid_argument if the space is no ContactStateSpace
  explicit ContactEdges(const ompl::base::SpaceInformationPtr& si)
      : MotionValidator(si),
        space_(dynamic_cast<const ContactStateSpace*>(si->getStateSpace().get())) {
    if (space_ == nullptr) {
      throw std::invalid_argument("ContactEdges: OMPL space \"" + si->getStateSpace()->getName() +
                                  "\" is no ContactStateSpace");
    }
  }

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override {
    return count(leads_to(way(from, to), to));
  }

  /// The state of `last` may be null, or `to` itself.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last) const override {
    const std::vector<Configuration> found = way(from, to);
    if (count(leads_to(found, to))) {
      return true;
    }
    ompl::base::State* reached = si_->allocState();
    space_->states().write(found.back(), reached);
    const double whole = si_->distance(from, to);
    last.second = found.size() > 1 ? 1.0 - si_->distance(reached, to) / whole : 0.0;
    if (last.first != nullptr) {
      si_->copyState(last.first, reached);
    }
    si_->freeState(reached);
    return false;
  }

 private:
  [[nodiscard]] std::vector<Configuration> way(const ompl::base::State* from,
                                               const ompl::base::State* to) const {
    return space_->way(space_->states().read(from), space_->states().read(to));
  }

  /// A way of one place has not been proven.
  [[nodiscard]] bool leads_to(const std::vector<Configuration>& way,
                              const ompl::base::State* to) const {
    return way.size() > 1 && way.back() == space_->states().read(to);
  }

  bool count(bool is_valid) const {
    std::atomic_ref(is_valid ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
    return is_valid;
  }

  const ContactStateSpace* space_;
};

}  // namespace firstcontact
