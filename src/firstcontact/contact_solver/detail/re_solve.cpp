#include <firstcontact/contact_solver/detail/re_solve.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <limits>
#include <span>

#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The contacts that wait to be solved, each once; first come, first served.
class WaitingContacts {
 public:
  explicit WaitingContacts(std::size_t count) : waits_(count, false) {}

  [[nodiscard]] bool empty() const { return queue_.empty(); }
  void add(std::size_t k) {
    if (!waits_[k]) {
      waits_[k] = true;
      queue_.push_back(k);
    }
  }
  std::size_t take() {
    const std::size_t k = queue_.front();
    queue_.pop_front();
    waits_[k] = false;
    return k;
  }

 private:
  std::vector<bool> waits_;
  std::deque<std::size_t> queue_;
};

/// The contacts of each body.
class ContactsOfBodies {
 public:
  explicit ContactsOfBodies(const ContactProblem& problem)
      : first_(problem.bodies.size() + 1, 0), contacts_(2 * problem.contacts.size()) {
    for (const ContactPoint& contact : problem.contacts) {
      ++first_[contact.bodies[0]];
      ++first_[contact.bodies[1]];
    }
    std::size_t end = 0;
    for (std::size_t& first : first_) {
      end += first;
      first = end;
    }
    for (std::size_t k = problem.contacts.size(); k-- > 0;) {
      for (const std::size_t b : problem.contacts[k].bodies) {
        contacts_[--first_[b]] = k;
      }
    }
  }

  [[nodiscard]] std::span<const std::size_t> of(std::size_t body) const {
    return {contacts_.data() + first_[body], contacts_.data() + first_[body + 1]};
  }

 private:
  std::vector<std::size_t> first_;  // The contacts of body b are first_[b] to first_[b + 1].
  std::vector<std::size_t> contacts_;
};

/// The neighbourhood of the changed contacts: its rows are made when they are needed.
class Neighbourhood {
 public:
  Neighbourhood(const ContactProblem& problem, const ContactSolution& before)
      : problem_(problem),
        before_(before),
        layout_(problem),
        contacts_of_(problem),
        row_of_(problem.contacts.size(), kNone),
        is_reached_(problem.bodies.size(), false),
        V_(layout_.size) {
    for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
      set_velocity(b, b < before.bodies.size() ? before.bodies[b] : problem.bodies[b]);
    }
  }

  /// Gives the bodies of contacts the velocities that belong to the impulses. A contact may press
  /// elsewhere than it did in the solution before.
  void balance(const std::vector<std::size_t>& contacts) {
    for (const std::size_t k : contacts) {
      for (const std::size_t b : problem_.contacts[k].bodies) {
        if (is_movable(problem_.bodies[b]) && !is_reached_[b]) {
          reach(b);
          balance(b);
        }
      }
    }
  }

  void solve(const std::vector<std::size_t>& changed, const ProjectionOptions& options) {
    WaitingContacts waiting(problem_.contacts.size());
    std::ranges::for_each(changed, [&](std::size_t k) { waiting.add(k); });
    const std::size_t most = static_cast<std::size_t>(options.sweeps) * problem_.contacts.size();
    for (std::size_t solved = 0; !waiting.empty() && solved < most; ++solved) {
      const std::size_t k = waiting.take();
      Row& at = row(k);
      const double change = solve_alone(at.row, at.impulse, V_);
      for (const std::size_t b : problem_.contacts[k].bodies) {
        if (change > 0.0 && is_movable(problem_.bodies[b])) {
          reach(b);
          if (change > options.tolerance) {
            add_others(b, k, waiting);
          }
        }
      }
    }
  }

  [[nodiscard]] ContactSolution solution() {
    ContactSolution made{.bodies = problem_.bodies};
    for (std::size_t b = 0; b < made.bodies.size(); ++b) {
      made.bodies[b].v = V_.segment<3>(layout_.body[b]);
      made.bodies[b].w = V_.segment<3>(layout_.body[b] + 3);
    }
    made.residual = residual();
    for (const ContactPoint& contact : problem_.contacts) {
      made.impulses.push_back(contact.guess);
    }
    for (const Row& at : rows_) {
      made.impulses[at.contact] = at.row.own.turn().transpose() * at.impulse;
    }
    return made;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Row {
    std::size_t contact;
    ContactRow row;
    Vector3d impulse;  // [N s]  In the row's frame.
  };

  Row& row(std::size_t k) {
    if (row_of_[k] == kNone) {
      row_of_[k] = rows_.size();
      ContactRow made = make_row(problem_, layout_, problem_.contacts[k]);
      const Vector3d impulse = made.own.turn() * problem_.contacts[k].guess;
      rows_.push_back({k, std::move(made), impulse});
    }
    return rows_[row_of_[k]];
  }

  void balance(std::size_t body) {
    set_velocity(body, problem_.bodies[body]);
    for (const std::size_t k : contacts_of_.of(body)) {
      const Row& at = row(k);
      const std::size_t side = problem_.contacts[k].bodies[0] == body ? 0 : 1;
      at.row.sides[side].apply(at.impulse, V_);
    }
  }

  void add_others(std::size_t body, std::size_t than, WaitingContacts& waiting) const {
    for (const std::size_t k : contacts_of_.of(body)) {
      if (k != than) {
        waiting.add(k);
      }
    }
  }

  void reach(std::size_t body) {
    if (!is_reached_[body]) {
      is_reached_[body] = true;
      reached_.push_back(body);
    }
  }

  void set_velocity(std::size_t b, const ContactBody& body) {
    V_.segment<6>(layout_.body[b]) << body.v, body.w;
  }

  /// The greatest residual of the reached contacts. No other body moves otherwise than before.
  [[nodiscard]] double residual() {
    for (const std::size_t b : reached_) {
      if (is_movable(problem_.bodies[b])) {
        std::ranges::for_each(contacts_of_.of(b), [&](std::size_t k) { (void)row(k); });
      }
    }
    double greatest = before_.residual;
    for (const Row& at : rows_) {
      const double own = residual_of(at.row, at.impulse, V_);
      greatest =
          std::isfinite(own) ? std::max(greatest, own) : std::numeric_limits<double>::infinity();
    }
    return greatest;
  }

  const ContactProblem& problem_;
  const ContactSolution& before_;
  VelocityLayout layout_;
  ContactsOfBodies contacts_of_;
  std::vector<std::size_t> row_of_;  // For each contact its row, among those made.
  std::deque<Row> rows_;
  std::vector<bool> is_reached_;
  std::vector<std::size_t> reached_;  // Bodies that may move otherwise than before.
  Eigen::VectorXd V_;
};

}  // namespace

ContactSolution re_solve(const ContactProblem& problem, const ContactSolution& before,
                         const std::vector<std::size_t>& changed,
                         const ProjectionOptions& options) {
  assert(problem.mechanisms.empty() && problem.drives.empty() && problem.ties.empty());
  Neighbourhood around(problem, before);
  around.balance(changed);
  around.solve(changed, options);
  ContactSolution solution = around.solution();
  solution.allowed = before.allowed;
  return solution;
}

}  // namespace firstcontact::detail
