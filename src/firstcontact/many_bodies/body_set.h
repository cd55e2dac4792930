/// @file
/// Many moving bodies and the rules for their pairs: the input of the many-body queries.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// Moving bodies, numbered from 0.
///
/// Replacing the shape or the motion of one body rebuilds the data of that body only. Queries only
/// read the set, also from several threads at once.
class FIRSTCONTACT_API BodySet {
 public:
  explicit BodySet(PairRules rules = PairRules()) : rules_(std::move(rules)) {}

  /// Adds a body and returns its number.
  std::size_t add(Shape shape, Motion X_WS);
  void set_shape(std::size_t body, Shape shape);  ///< Replaces the shape. @throws std::out_of_range
  /// Replaces the motion. @throws std::out_of_range
  void set_motion(std::size_t body, Motion X_WS);

  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  [[nodiscard]] const Shape& shape(std::size_t body) const { return bodies_[body].shape; }
  [[nodiscard]] const Motion& motion(std::size_t body) const { return bodies_[body].X_WS; }
  /// The shape and the motion of a body, as references into this set.
  [[nodiscard]] MovingShape moving_shape(std::size_t body) const {
    return {shape(body), motion(body)};
  }
  /// The paths of the centre of the body's hierarchy, one for each piece of its motion.
  [[nodiscard]] const std::vector<ConstantRatePath>& centre_path(std::size_t body) const {
    return bodies_[body].centre_path;
  }

  [[nodiscard]] PairRules& rules() { return rules_; }
  [[nodiscard]] const PairRules& rules() const { return rules_; }

 private:
  struct Body {
    Shape shape;
    Motion X_WS;
    std::vector<ConstantRatePath> centre_path;
  };
  static std::vector<ConstantRatePath> centre_path_of(const Shape& shape, const Motion& X_WS);

  std::vector<Body> bodies_;
  PairRules rules_;
};

}  // namespace firstcontact
