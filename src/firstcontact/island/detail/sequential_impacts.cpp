#include <firstcontact/island/detail/sequential_impacts.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <firstcontact/contact_solver/detail/contact_rows.h>
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

/// Finds bodies and robots that contacts and ties move together.
class MovedTogether {
 public:
  explicit MovedTogether(const ContactProblem& problem) : problem_(problem) {
    parents_.resize(problem.bodies.size() + problem.mechanisms.size());
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    for (const TieRow& tie : problem.ties) {
      if (tie.sides.size() == 2) {
        join(tie.sides[0].body, tie.sides[1].body);
      }
    }
  }

  void join(const std::vector<std::size_t>& contacts) {
    for (const std::size_t k : contacts) {
      join(problem_.contacts[k].bodies[0], problem_.contacts[k].bodies[1]);
    }
  }

  /// The same number for all contacts of bodies that move together.
  [[nodiscard]] std::size_t root_of(std::size_t contact) const {
    const std::array<std::size_t, 2>& bodies = problem_.contacts[contact].bodies;
    return root(mover_of(bodies[moves(bodies[0]) ? 0 : 1]));
  }

 private:
  [[nodiscard]] bool moves(std::size_t body) const {
    return problem_.bodies[body].link || is_movable(problem_.bodies[body]);
  }
  [[nodiscard]] std::size_t mover_of(std::size_t body) const {
    const std::optional<MechanismLink>& link = problem_.bodies[body].link;
    return link ? problem_.bodies.size() + link->mechanism : body;
  }
  [[nodiscard]] std::size_t root(std::size_t mover) const {
    while (parents_[mover] != mover) {
      mover = parents_[mover];
    }
    return mover;
  }
  void join(std::size_t a, std::size_t b) {
    if (moves(a) && moves(b)) {
      const std::size_t of_a = root(mover_of(a));
      const std::size_t of_b = root(mover_of(b));
      parents_[std::max(of_a, of_b)] = std::min(of_a, of_b);
    }
  }

  const ContactProblem& problem_;
  std::vector<std::size_t> parents_;
};

class Sequence {
 public:
  Sequence(const IslandState& state, ContactProblem problem, const std::vector<BodyPair>& pairs)
      : state_(state),
        problem_(std::move(problem)),
        bodies_(pairs),
        pairs_(contacts_by_pair(pairs)),
        impulses_(problem_.contacts.size(), Vector3d::Zero()),
        drives_(problem_.drives.size(), 0.0),
        ties_(problem_.ties.size(), 0.0) {}

  ContactSolution run() {
    part_by_law();
    const std::size_t most = kAnswersOfPair * pairs_.size();
    double slow = slowest_bounce(state_);
    for (std::size_t answers = 0; answers < most;) {
      const auto [next, closing] = fastest();
      slow = std::max(slow, kSlowOfFirst * closing);
      if (!(closing > slow)) {
        break;
      }
      const std::vector<std::vector<std::size_t>> groups = grouped(next);
      for (const std::vector<std::size_t>& contacts : groups) {
        answer(contacts);
      }
      answers += groups.size();
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

  /// Finds the pairs that close as fast as the fastest, and their speed [m/s].
  [[nodiscard]] std::pair<std::vector<std::size_t>, double> fastest() const {
    std::vector<double> closing;
    for (const Pair& pair : pairs_) {
      closing.push_back(closing_of(pair));
    }
    const double greatest = closing.empty() ? 0.0 : std::ranges::max(closing);
    std::vector<std::size_t> found;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      if (closing[p] >= (1.0 - kEquallyFast) * greatest) {
        found.push_back(p);
      }
    }
    return {std::move(found), greatest};
  }

  /// Puts the contacts of pairs together where an answer of one changes the velocities of another.
  [[nodiscard]] std::vector<std::vector<std::size_t>> grouped(
      const std::vector<std::size_t>& pairs) const {
    if (pairs.size() == 1) {
      return {pairs_[pairs[0]].contacts};
    }
    MovedTogether moved(problem_);
    moved.join(held_);
    for (const std::size_t p : pairs) {
      moved.join(pairs_[p].contacts);
    }
    std::map<std::size_t, std::vector<std::size_t>> groups;  // By what moves; in the order of it.
    for (const std::size_t p : pairs) {
      std::ranges::copy(pairs_[p].contacts,
                        std::back_inserter(groups[moved.root_of(pairs_[p].contacts[0])]));
    }
    std::vector<std::vector<std::size_t>> contacts;
    for (auto& [root, group] : groups) {
      contacts.push_back(std::move(group));
    }
    return contacts;
  }

  /// Lets some contacts bounce, while those of pairs without restitution hold.
  void answer(const std::vector<std::size_t>& bouncing) {
    ContactProblem alone;
    alone.bodies = problem_.bodies;
    alone.mechanisms = problem_.mechanisms;
    alone.drives = problem_.drives;
    alone.ties = problem_.ties;
    std::vector<std::size_t> contacts = bouncing;
    std::ranges::copy(held_, std::back_inserter(contacts));
    std::vector<double> restitution(contacts.size(), 0.0);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      alone.contacts.push_back(problem_.contacts[contacts[k]]);
      alone.contacts.back().guess.setZero();
      if (k < bouncing.size()) {
        restitution[k] =
            restitution_of(state_, bodies_[contacts[k]], alone.contacts.back(), problem_.bodies);
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
  ContactProblem problem_;               // With the present velocities.
  const std::vector<BodyPair>& bodies_;  // Of each contact.
  std::vector<Pair> pairs_;              // Pairs that may bounce.
  std::vector<std::size_t> held_;        // Contacts of all other pairs.
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
