/// @file
/// Ways between places that follow contacts where the straight edge is blocked.

#pragma once

#include <memory>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

class RandomNumbers;

/// A way of edges that are each proven free.
struct ProvenWay {
  std::vector<Configuration> places = {};  ///< The first is where it begins.
  bool reaches_target = false;             ///< To the bit.
};

/// A local planner for planners of all kinds: what they take in place of a straight edge.
///
/// Where an edge is blocked, the contacts constrain the rest of the motion: Gauss' principle of
/// least constraint, after S. Redon, M. Lin, "Practical local planning in the contact space", ICRA
/// 2005. So the mover slides, rolls and turns along what is in its way. See
/// ContactUse::slide for the planner here that does so by itself.
///
/// Thread-safe without locks: every thread has memory of its own.
class FIRSTCONTACT_API ContactWays {
 public:
  /// @param edges  that prove every edge; not null
  /// @param range  up to about which a single step of a slide grows, in the length of the space;
  ///               0 for a share of it. Steps that repeat what was slid may be longer
  /// @throws std::invalid_argument if the range is below 0 or not finite; if it is 0 where a joint
  ///         slides without limits
  explicit ContactWays(std::shared_ptr<const EdgeChecker> edges, double range = 0.0);
  ~ContactWays();
  ContactWays(ContactWays&&) noexcept;
  ContactWays& operator=(ContactWays&&) noexcept;

  [[nodiscard]] const EdgeChecker& edges() const;

  /// Up to about which a single step grows.
  [[nodiscard]] double range() const;

  /// Goes straight to a target where that is free, else as far as contacts let it.
  ///
  /// A way takes at most a few hundred edges. It has one place alone where nothing was gained.
  [[nodiscard]] ProvenWay follow(const Configuration& from, const Configuration& target) const;

  /// Draws a way through a narrow gap of what rests. At one place of it a thin part of the mover
  /// stands in the gap. From there it leads along the gap in both senses until contacts hold it.
  ///
  /// A thread's earlier draws change what it draws later. The way has no places where no gap was
  /// found, and for robots with joints.
  [[nodiscard]] ProvenWay passage(RandomNumbers& random) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
