#include <firstcontact/island/detail/sequential_impacts.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
/// The contacts of a pair of bodies of a problem.
struct Pair {
  BodyPair bodies;
  std::vector<std::size_t> contacts = {};
};

std::vector<Pair> contacts_by_pair(const std::vector<BodyPair>& bodies) {
  std::vector<Pair> pairs;
  std::map<BodyPair, std::size_t> known;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const auto [found, is_new] = known.try_emplace(bodies[k], pairs.size());
    if (is_new) {
      pairs.push_back({bodies[k]});
    }
    pairs[found->second].contacts.push_back(k);
  }
  return pairs;
}

class Sequence {
 public:
  Sequence(const IslandState& state, ContactProblem problem, const std::vector<BodyPair>& pairs)
      : state_(state),
        problem_(std::move(problem)),
        pairs_(contacts_by_pair(pairs)),
        impulses_(problem_.contacts.size(), Vector3d::Zero()),
        drives_(problem_.drives.size(), 0.0),
        ties_(problem_.ties.size(), 0.0) {}

  ContactSolution run() {
    part_by_law();
    const std::size_t most = kAnswersOfPair * pairs_.size();
    double slow = slowest_bounce(state_);
    for (std::size_t answers = 0; answers < most; ++answers) {
      const auto [next, closing] = fastest();
      slow = std::max(slow, kSlowOfFirst * closing);
      if (!(closing > slow)) {
        break;
      }
      answer(pairs_[next]);
    }
    return hold_all();
  }

 private:
  /// Keeps only pairs that may bounce in the sequence.
  void part_by_law() {
    std::erase_if(pairs_, [&](const Pair& pair) {
      const bool holds = state_.model.laws.restitution(pair.bodies) == 0.0;
      if (holds) {
        std::ranges::copy(pair.contacts, std::back_inserter(held_));
      }
      return holds;
    });
  }

  [[nodiscard]] double closing_of(const Pair& pair) const {
    double closing = 0.0;
    for (const std::size_t k : pair.contacts) {
      closing = std::max(closing, -normal_velocity(problem_.contacts[k], problem_.bodies));
    }
    return closing;
  }

  [[nodiscard]] std::pair<std::size_t, double> fastest() const {
    std::pair<std::size_t, double> found{0, 0.0};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const double closing = closing_of(pairs_[p]);
      if (closing > found.second) {
        found = {p, closing};
      }
    }
    return found;
  }

  void answer(const Pair& pair) {
    ContactProblem alone;
    alone.bodies = problem_.bodies;
    alone.mechanisms = problem_.mechanisms;
    alone.drives = problem_.drives;
    alone.ties = problem_.ties;
    std::vector<std::size_t> contacts = pair.contacts;
    std::ranges::copy(held_, std::back_inserter(contacts));
    std::vector<double> restitution(contacts.size(), 0.0);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      alone.contacts.push_back(problem_.contacts[contacts[k]]);
      alone.contacts.back().guess.setZero();
      if (k < pair.contacts.size()) {
        restitution[k] =
            restitution_of(state_, pair.bodies, alone.contacts.back(), problem_.bodies);
      }
    }
    take(project_simultaneous_impact(state_, alone, restitution), contacts);
  }

  /// Lets all contacts hold the pairs that still close.
  ContactSolution hold_all() {
    for (ContactPoint& contact : problem_.contacts) {
      contact.guess.setZero();
    }
    ContactSolution held = project_simultaneous_impact(
        state_, problem_, std::vector<double>(problem_.contacts.size(), 0.0));
    for (std::size_t k = 0; k < impulses_.size(); ++k) {
      held.impulses[k] += impulses_[k];
    }
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      held.drives[k] += drives_[k];
    }
    for (std::size_t k = 0; k < ties_.size(); ++k) {
      held.ties[k] += ties_[k];
    }
    return held;
  }

  void take(const ContactSolution& solution, const std::vector<std::size_t>& contacts) {
    problem_.bodies = solution.bodies;
    for (std::size_t m = 0; m < problem_.mechanisms.size(); ++m) {
      problem_.mechanisms[m].velocity = solution.mechanisms[m];
    }
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      impulses_[contacts[k]] += solution.impulses[k];
    }
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      drives_[k] += solution.drives[k];
    }
    for (std::size_t k = 0; k < ties_.size(); ++k) {
      ties_[k] += solution.ties[k];
    }
  }

  const IslandState& state_;
  ContactProblem problem_;         // With the present velocities.
  std::vector<Pair> pairs_;        // Pairs that may bounce.
  std::vector<std::size_t> held_;  // Contacts of all other pairs.
  std::vector<Vector3d> impulses_;
  std::vector<double> drives_;
  std::vector<double> ties_;
};

}  // namespace

ContactSolution project_sequential_impacts(const IslandState& state, const ContactProblem& problem,
                                           const std::vector<BodyPair>& pairs) {
  return Sequence(state, problem, pairs).run();
}

}  // namespace firstcontact::detail
