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
  bool reaches_target = false;             ///< Whether the last place is the target, to the bit.
};

/// A local planner that planners of all kinds use in place of a straight edge.
///
/// Where an edge is blocked, the contacts constrain the rest of the motion by Gauss' principle of
/// least constraint. So the mover slides, rolls and turns along the obstacle. The planner here that
/// does so by itself is that of ContactUse::slide.
///
/// Source: S. Redon, M. Lin, "Practical local planning in the contact space", ICRA 2005.
///
/// Thread-safe without locks: every thread has memory of its own.
class FIRSTCONTACT_API ContactWays {
 public:
  /// Prepares ways in the space of an edge checker.
  ///
  /// @param edges  proves every edge; not null
  /// @param range  the length, in that of the space, up to about which a single step of a slide
  ///               grows; 0 for a share of it. Steps that repeat an earlier slide may be longer
  /// @throws std::invalid_argument if the range is below 0 or not finite; if it is 0 where a joint
  ///         slides without limits
  explicit ContactWays(std::shared_ptr<const EdgeChecker> edges, double range = 0.0);
  ~ContactWays();
  ContactWays(ContactWays&&) noexcept;
  ContactWays& operator=(ContactWays&&) noexcept;

  [[nodiscard]] const EdgeChecker& edges() const;

  /// The length up to about which a single step grows.
  [[nodiscard]] double range() const;

  /// Goes straight to a target where that is free, else as far as contacts let it.
  ///
  /// A way takes at most a few hundred edges. Where nothing was gained it has only its first place.
  [[nodiscard]] ProvenWay follow(const Configuration& from, const Configuration& target) const;

  /// Draws a way through a narrow gap between resting bodies.
  ///
  /// At one place of the way a thin part of the mover stands in the gap. From there the way leads
  /// along the gap in both senses until contacts hold it. It has no places where no gap was found,
  /// and for robots with joints. A thread's earlier draws change its later ones.
  [[nodiscard]] ProvenWay passage(RandomNumbers& random) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace firstcontact
