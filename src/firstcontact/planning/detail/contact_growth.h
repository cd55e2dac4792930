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
/// Work in contact is rationed by the number of edges, so that an easy question is answered as
/// quickly as without it: little at first, then more the longer the search takes.
class ContactGrowth {
 public:
  ContactGrowth(PlanWork& work, ContactUse use, double range);

  /// What a blocked edge led to.
  struct Followed {
    std::size_t node = 0;
    bool reaches_target = false;
  };

  /// Draws whose turn it is: blocked edges, pushes, or passages.
  ///
  /// @param is_stuck  no edge has led away from where the tree begins: contacts are not rationed
  void next(bool is_stuck, RandomNumbers& random);

  /// Follows a blocked edge from a node as far as contacts let it; none where that leads nowhere,
  /// or is not this edge's turn.
  std::optional<Followed> follow(PlanTree& tree, std::size_t from, const Configuration& target);

  /// As ContactSteering::ways_out(), for ContactUse::both; else none.
  [[nodiscard]] std::vector<std::array<Eigen::VectorXd, 2>> ways_out(const Configuration& from);

  /// What a push out of contacts led to.
  struct Left {
    std::size_t node = 0;
    bool is_out = false;  ///< It is out of contact.
  };
  /// Moves from a node in a direction, with all the effort that is allowed. None where that leads
  /// nowhere.
  std::optional<Left> leave(PlanTree& tree, std::size_t from, const Eigen::VectorXd& direction);

  /// Moves from a marked place in a random direction. The node at the end; none where that leads
  /// nowhere, or it is not its turn.
  std::optional<std::size_t> push(PlanTree& tree, RandomNumbers& random);

  /// A node of a passage for a tree to go to, 0 or 1; none where it is not its turn. Now and then a
  /// new passage is found first.
  std::optional<PassageTrees::Node> passage(std::size_t tree, const Configuration& near,
                                            RandomNumbers& random);

  [[nodiscard]] PassageTrees& passages() { return passages_; }

  /// Whether to go on along contacts towards a passage.
  std::optional<Followed> follow_to_passage(PlanTree& tree, std::size_t from,
                                            const Configuration& target);

 private:
  [[nodiscard]] bool is_due() const;
  std::optional<std::size_t> take(PlanTree& tree, std::size_t from, const ContactWay& way);

  void find_passage(RandomNumbers& random);
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
  std::optional<ContactSteering> steering_;
  enum class Turn { edges, pushes, passages };
  Turn turn_ = Turn::edges;
  std::optional<GapSampler> gaps_;
  PassageTrees passages_;
  std::size_t draws_ = 0;  // Of gaps.
  bool is_stuck_ = false;
  std::size_t spent_ = 0;    // Edges that were checked in contact,
  std::size_t leaving_ = 0;  // and those of leave(), which are not rationed.
};

}  // namespace firstcontact::detail
