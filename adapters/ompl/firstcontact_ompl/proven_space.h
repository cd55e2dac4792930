/// @file
/// The states of OMPL's spaces as places of a planner here.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/base/spaces/WrapperStateSpace.h>

#include <firstcontact/edges/configuration_space.h>

#include "firstcontact_ompl/screw_space.h"

namespace firstcontact {

/// A space of OMPL whose states are those of another one, and whose edges are chains of its edges:
/// ContactStateSpace.
class ChainedStateSpace : public ompl::base::WrapperStateSpace {
 public:
  using WrapperStateSpace::WrapperStateSpace;
};

/// Reads states of an OMPL space as configurations of a space here, and writes them.
///
/// A body has an SE3StateSpace: straight lines with slerp on both sides. Where its edges are screws
/// it has a ScrewStateSpace. Joints have RealVectorStateSpaces, and SO2StateSpaces for those that
/// go the short way round, in the order of the coordinates; several are joined by a
/// CompoundStateSpace, whatever its weights. A planar joint may have an SE2StateSpace. A
/// ChainedStateSpace is read as the one that it wraps. All other spaces, those that derive from
/// these among them, are refused: their edges may be other curves.
class OmplStates {
 public:
  /// @throws std::invalid_argument  names the type of the space, or the coordinate, that does not
  ///         fit
  OmplStates(const ompl::base::StateSpace& states, const ConfigurationSpace& places) {
    if (const auto* chained = dynamic_cast<const ChainedStateSpace*>(&states)) {
      if (dynamic_cast<const ChainedStateSpace*>(chained->getSpace().get()) != nullptr) {
        refuse(states, "chains of edges are made of a space with edges of its own");
      }
      *this = OmplStates(*chained->getSpace(), places);
      is_wrapped_ = true;
      return;
    }
    if (places.is_body()) {
      if (places.has_screws() && typeid(states) != typeid(ScrewStateSpace)) {
        refuse(states, "a body that moves on screws has a ScrewStateSpace");
      }
      if (!places.has_screws() && typeid(states) != typeid(ompl::base::SE3StateSpace)) {
        refuse(states, "a body has an SE3StateSpace");
      }
      is_body_ = true;
      has_slerp_ = !places.has_screws();
      return;
    }
    add(states, places);
    if (read_ != places.size()) {
      refuse(states, "it has " + std::to_string(read_) + " numbers, the joints have " +
                         std::to_string(places.size()));
    }
  }

  [[nodiscard]] Configuration read(const ompl::base::State* state) const {
    state = unwrapped(state);
    Configuration q;
    if (is_body_) {
      const auto* pose = state->as<ompl::base::SE3StateSpace::StateType>();
      const auto& r = pose->rotation();
      return {pose->getX(), pose->getY(), pose->getZ(), r.w, r.x, r.y, r.z};
    }
    for (const Part& part : parts_) {
      const ompl::base::State* found = part.of(state);
      if (part.turns) {
        q.push_back(found->as<ompl::base::SO2StateSpace::StateType>()->value);
      } else {
        const double* values = found->as<ompl::base::RealVectorStateSpace::StateType>()->values;
        q.insert(q.end(), values, values + part.count);
      }
    }
    return q;
  }

  /// Whether OMPL interpolates along the edge that is proven here, in whatever order it adds.
  ///
  /// Its slerp turns by the shorter way as the sign of a rounded dot product of quaternions has it,
  /// ours as the exact sign has it. At half a turn the dot product is 0, and the two ways may be
  /// opposite. With n = 4 products, |dot - rounded(dot)| <= gamma_n sum |a_i b_i|, gamma_4 < 2^-50
  /// for any order of the sum. Beyond twice that both signs are those of our rounded one; 2^-48 has
  /// room for the rounding of the sum of sizes.
  ///
  /// Source: N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 2nd edition, 2002,
  /// inequality (3.5).
  [[nodiscard]] bool has_same_edge(const Configuration& from, const Configuration& to) const {
    if (!has_slerp_) {
      return true;
    }
    double dot = 0.0;
    double sizes = 0.0;
    for (std::size_t k = 3; k < 7; ++k) {
      dot += from[k] * to[k];
      sizes += std::abs(from[k] * to[k]);
    }
    return std::abs(dot) > 0x1p-48 * sizes;
  }

  /// Makes a state of a configuration. read() gives it back to the bit, but for angles of joints
  /// that go the short way round: those beyond [-pi, pi) lose whole turns, rounded.
  void write(const Configuration& q, ompl::base::State* state) const {
    state = const_cast<ompl::base::State*>(unwrapped(state));
    if (is_body_) {
      auto* pose = state->as<ompl::base::SE3StateSpace::StateType>();
      pose->setXYZ(q[0], q[1], q[2]);
      auto& r = pose->rotation();
      r.w = q[3];
      r.x = q[4];
      r.y = q[5];
      r.z = q[6];
      return;
    }
    std::size_t next = 0;
    for (const Part& part : parts_) {
      auto* found = const_cast<ompl::base::State*>(part.of(state));
      if (part.turns) {
        found->as<ompl::base::SO2StateSpace::StateType>()->value = within_a_turn(q[next]);
      } else {
        std::copy_n(&q[next], part.count,
                    found->as<ompl::base::RealVectorStateSpace::StateType>()->values);
      }
      next += part.count;
    }
  }

 private:
  struct Part {
    std::vector<std::size_t> way;  // Through compound states.
    std::size_t count = 1;
    bool turns = false;

    [[nodiscard]] const ompl::base::State* of(const ompl::base::State* state) const {
      for (const std::size_t step : way) {
        state = state->as<ompl::base::CompoundState>()->components[step];
      }
      return state;
    }
  };

  [[nodiscard]] const ompl::base::State* unwrapped(const ompl::base::State* state) const {
    return is_wrapped_ ? state->as<ompl::base::WrapperStateSpace::StateType>()->getState() : state;
  }

  static double within_a_turn(double angle) {
    constexpr double kHalf = std::numbers::pi;
    if (-kHalf <= angle && angle < kHalf) {
      return angle;
    }
    const double rest = std::remainder(angle, 2.0 * kHalf);
    return rest < kHalf ? rest : -kHalf;
  }

  [[noreturn]] static void refuse(const ompl::base::StateSpace& states, const std::string& why) {
    throw std::invalid_argument("OMPL space \"" + states.getName() + "\" of type " +
                                typeid(states).name() + ": " + why);
  }

  void add(const ompl::base::StateSpace& states, const ConfigurationSpace& places,
           const std::vector<std::size_t>& way = {}) {
    // An SE2StateSpace is a compound of two numbers and an angle, with the edges of a compound.
    if (typeid(states) == typeid(ompl::base::CompoundStateSpace) ||
        typeid(states) == typeid(ompl::base::SE2StateSpace)) {
      const auto& compound = static_cast<const ompl::base::CompoundStateSpace&>(states);
      for (std::size_t k = 0; k < compound.getSubspaceCount(); ++k) {
        std::vector<std::size_t> further = way;
        further.push_back(k);
        add(*compound.getSubspace(static_cast<unsigned int>(k)), places, further);
      }
      return;
    }
    const bool turns = typeid(states) == typeid(ompl::base::SO2StateSpace);
    if (!turns && typeid(states) != typeid(ompl::base::RealVectorStateSpace)) {
      refuse(states, "joints have RealVectorStateSpaces, SO2StateSpaces and SE2StateSpaces");
    }
    const std::size_t count = turns ? 1 : states.getDimension();
    for (std::size_t k = 0; k < count; ++k) {
      if (read_ + k >= places.size()) {
        refuse(states, "it has more numbers than there are joints");
      }
      const SpaceCoordinate& coordinate = places.coordinates()[read_ + k];
      if (coordinate.turns_short != turns) {
        refuse(states, "joint \"" + coordinate.name +
                           (turns ? "\" does not go the short way round"
                                  : "\" goes the short way round: give it an SO2StateSpace"));
      }
    }
    parts_.push_back({way, count, turns});
    read_ += count;
  }

  std::vector<Part> parts_;
  std::size_t read_ = 0;
  bool is_body_ = false;
  bool has_slerp_ = false;
  bool is_wrapped_ = false;
};

namespace detail {

/// Whether the only coordinates are those of a planar joint, in their order.
inline bool is_planar(const ConfigurationSpace& places) {
  const auto coordinates = places.coordinates();
  if (coordinates.size() != 3 || places.mover_count() != 1) {
    return false;
  }
  const std::size_t joint = coordinates[0].joint;
  for (std::size_t k = 0; k < 3; ++k) {
    if (coordinates[k].joint != joint || coordinates[k].index != k) {
      return false;
    }
  }
  return places.model().joints()[joint].type == JointType::planar && coordinates[2].turns_short;
}

}  // namespace detail

/// The OMPL space of a space here, with its box or its limits as bounds: neighbouring joints with a
/// long way share one RealVectorStateSpace, and a planar joint alone has an SE2StateSpace.
inline ompl::base::StateSpacePtr make_ompl_space(const ConfigurationSpace& places) {
  if (places.is_body()) {
    auto space = places.has_screws() ? std::make_shared<ScrewStateSpace>()
                                     : std::make_shared<ompl::base::SE3StateSpace>();
    ompl::base::RealVectorBounds bounds(3);
    for (unsigned int k = 0; k < 3; ++k) {
      bounds.setLow(k, places.low()[k]);
      bounds.setHigh(k, places.high()[k]);
    }
    space->setBounds(bounds);
    return space;
  }
  const auto coordinates = places.coordinates();
  if (detail::is_planar(places)) {
    auto plane = std::make_shared<ompl::base::SE2StateSpace>();
    ompl::base::RealVectorBounds bounds(2);
    for (unsigned int k = 0; k < 2; ++k) {
      bounds.setLow(k, coordinates[k].lower);
      bounds.setHigh(k, coordinates[k].upper);
    }
    plane->setBounds(bounds);
    return plane;
  }
  auto compound = std::make_shared<ompl::base::CompoundStateSpace>();
  for (std::size_t k = 0; k < coordinates.size();) {
    if (coordinates[k].turns_short) {
      compound->addSubspace(std::make_shared<ompl::base::SO2StateSpace>(), 1.0);
      ++k;
      continue;
    }
    auto several = std::make_shared<ompl::base::RealVectorStateSpace>();
    for (; k < coordinates.size() && !coordinates[k].turns_short; ++k) {
      several->addDimension(coordinates[k].name, coordinates[k].lower, coordinates[k].upper);
    }
    compound->addSubspace(several, 1.0);
  }
  if (compound->getSubspaceCount() == 1) {
    return compound->getSubspace(0);  // Some planners know no compounds.
  }
  return compound;
}

}  // namespace firstcontact
