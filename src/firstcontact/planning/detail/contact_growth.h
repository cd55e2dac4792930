/// @file
/// Trees that grow along contacts where their edges are blocked.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/contact_steering.h>
#include <firstcontact/planning/detail/gap_sampler.h>
#include <firstcontact/planning/detail/passage_trees.h>
#include <firstcontact/planning/detail/plan_tree.h>
#include <firstcontact/planning/detail/plan_work.h>
#include <firstcontact/planning/plan_path.h>

namespace firstcontact::detail {

/// Grows trees in contact. It does nothing for ContactUse::none.
///
/// Work in contact is rationed by the number of edges: little at first, then more the longer the
/// search takes. It draws random numbers of its own. So an easy question is answered by the same
/// search as without contacts, and as quickly.
class ContactGrowth {
 public:
  ContactGrowth(PlanWork& work, ContactUse use, double range);

  /// The result of following a blocked edge.
  struct Followed {
    std::size_t node = 0;
    bool reaches_target = false;
  };

  /// Draws the kind of work that is next: blocked edges, pushes, or passages.
  ///
  /// @param is_stuck  no edge has led away from the root of the tree: contacts are then not
  ///                  rationed
  void next(bool is_stuck);

  /// Whether work in contact has become due, once or more.
  [[nodiscard]] bool has_begun() const { return has_begun_; }

  /// Follows a blocked edge from a node as far as contacts let it.
  ///
  /// It returns none where that leads nowhere, or is not this edge's turn.
  std::optional<Followed> follow(PlanTree& tree, std::size_t from, const Configuration& target);

  /// The directions of ContactSteering::ways_out() for ContactUse::both; else none.
  [[nodiscard]] std::vector<std::array<Eigen::VectorXd, 2>> ways_out(const Configuration& from);

  /// The result of a push out of contacts.
  struct Left {
    std::size_t node = 0;
    bool is_out = false;  ///< Whether it is out of contact.
  };
  /// Moves from a node in a direction, with all the effort that is allowed.
  ///
  /// It returns none where that leads nowhere.
  std::optional<Left> leave(PlanTree& tree, std::size_t from, const Eigen::VectorXd& direction);

  /// Moves from a marked place in a random direction, and returns the node at the end.
  ///
  /// It returns none where that leads nowhere, or is not its turn.
  std::optional<std::size_t> push(PlanTree& tree);

  /// A node of a passage as a target for a tree, 0 or 1; none where it is not its turn.
  ///
  /// Now and then it finds a new passage first.
  std::optional<PassageTrees::Node> passage(std::size_t tree, const Configuration& near);

  [[nodiscard]] PassageTrees& passages() { return passages_; }

  /// Goes on along contacts towards a passage, where it is its turn.
  std::optional<Followed> follow_to_passage(PlanTree& tree, std::size_t from,
                                            const Configuration& target);

 private:
  [[nodiscard]] bool is_due() const;
  [[nodiscard]] ContactSteering& steering();
  std::optional<std::size_t> take(PlanTree& tree, std::size_t from, const ContactWay& way);

  void find_passage();
  std::optional<Followed> go(PlanTree& tree, std::size_t from, const Configuration& target);

  template <class Work>
  auto counted(const Work& work) {
    const std::size_t before = work_.counts().edges_checked;
    auto result = work();
    spent_ += work_.counts().edges_checked - before;
    return result;
  }

  PlanWork& work_;
  ContactUse use_;
  double range_;
  RandomNumbers random_;
  std::optional<ContactSteering> steering_;  // Made at the first use: easy questions have none.
  enum class Turn { edges, pushes, passages };
  Turn turn_ = Turn::edges;
  std::optional<GapSampler> gaps_;
  PassageTrees passages_;
  std::size_t draws_ = 0;  // Number of draws of gaps.
  bool is_stuck_ = false;
  bool has_begun_ = false;
  std::size_t spent_ = 0;    // Edges that were checked in contact.
  std::size_t leaving_ = 0;  // Edges of leave(), which are not rationed.
};

}  // namespace firstcontact::detail
