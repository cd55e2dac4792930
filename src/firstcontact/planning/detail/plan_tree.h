/// @file
/// A tree of places that proven edges connect.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/detail/nearest_index.h>
#include <firstcontact/planning/search_tree.h>

namespace firstcontact::detail {

/// Stands for the parent of a root.
inline constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();

/// The edges from parents to their children.
///
/// @param parents  of each node; kNoParent of a root
[[nodiscard]] inline std::vector<std::array<std::size_t, 2>> edges_of_parents(
    const std::vector<std::size_t>& parents) {
  std::vector<std::array<std::size_t, 2>> edges;
  for (std::size_t node = 0; node < parents.size(); ++node) {
    if (parents[node] != kNoParent) {
      edges.push_back({parents[node], node});
    }
  }
  return edges;
}

/// Places, each with an edge from its parent that is proven. Refers to the space.
class PlanTree {
 public:
  explicit PlanTree(const ConfigurationSpace& space) : space_(&space) {}

  /// Adds a place and returns its number.
  ///
  /// @param is_found  whether nearest() may return it; else it only leads on to others
  std::size_t add(Configuration q, std::size_t parent, bool is_found = true) {
    places_.push_back(std::move(q));
    parents_.push_back(parent);
    domains_.push_back(std::numeric_limits<double>::infinity());
    if (is_found) {
      show(places_.size() - 1);
    }
    return places_.size() - 1;
  }

  /// Lets nearest() return a place that it did not.
  void show(std::size_t node) {
    found_.add(node, [this](std::size_t a, std::size_t b) {
      return space_->distance(places_[a], places_[b]);
    });
  }

  /// Marks a place as one from which to move in contact.
  void mark(std::size_t node) { marked_.push_back(node); }

  /// The greatest distance of samples towards which a place is extended; infinite at first.
  [[nodiscard]] double domain(std::size_t node) const { return domains_[node]; }
  void set_domain(std::size_t node, double domain) { domains_[node] = domain; }

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// The parent of a node; kNoParent of a root, else less than the node.
  [[nodiscard]] std::size_t parent(std::size_t node) const { return parents_[node]; }
  [[nodiscard]] const Configuration& operator[](std::size_t node) const { return places_[node]; }
  /// The marked places, in the order in which they were marked.
  [[nodiscard]] const std::vector<std::size_t>& marked() const { return marked_; }

  /// The nearest place; of several the one that was shown first. The root where there is none.
  [[nodiscard]] std::size_t nearest(const Configuration& q) const {
    return found_
        .nearest([&](std::size_t node) { return space_->distance(places_[node], q); },
                 [](std::size_t) { return true; })
        .value_or(0);
  }

  /// The places from a node to its root.
  [[nodiscard]] std::vector<Configuration> to_root(std::size_t node) const {
    std::vector<Configuration> places;
    for (; node != kNoParent; node = parents_[node]) {
      places.push_back(places_[node]);
    }
    return places;
  }

  /// Gives the tree away, with an edge for each place that has a parent.
  [[nodiscard]] SearchTree take(SearchTreeKind kind) {
    return {.kind = kind, .places = std::move(places_), .edges = edges_of_parents(parents_)};
  }

 private:
  const ConfigurationSpace* space_;
  std::vector<Configuration> places_;
  std::vector<std::size_t> parents_;
  std::vector<double> domains_;
  NearestIndex found_;
  std::vector<std::size_t> marked_;
};

}  // namespace firstcontact::detail
