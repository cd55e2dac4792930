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
/// go the short way round, in the order of the coordinates. Behind them each floating joint has an
/// SE3StateSpace. Several are joined by a CompoundStateSpace, whatever its weights. A planar joint
/// may have an SE2StateSpace. A
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
      parts_.push_back({{}, kPose, Kind::pose});
      if (!places.has_screws()) {
        slerps_.push_back(3);
      }
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
    for (const Part& part : parts_) {
      const ompl::base::State* found = part.of(state);
      if (part.kind == Kind::pose) {
        const auto* pose = found->as<ompl::base::SE3StateSpace::StateType>();
        const auto& r = pose->rotation();
        q.insert(q.end(), {pose->getX(), pose->getY(), pose->getZ(), r.w, r.x, r.y, r.z});
      } else if (part.kind == Kind::angle) {
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
    return std::all_of(slerps_.begin(), slerps_.end(), [&](std::size_t first) {
      double dot = 0.0;
      double sizes = 0.0;
      for (std::size_t k = first; k < first + 4; ++k) {
        dot += from[k] * to[k];
        sizes += std::abs(from[k] * to[k]);
      }
      return std::abs(dot) > 0x1p-48 * sizes;
    });
  }

  /// Whether OMPL's interpolation leaves out the turn of an edge, and so follows other places.
  ///
  /// Its slerp keeps the first rotation where 1 - |dot| of the quaternions is below 1e-9: where
  /// they are less than 4.5e-5 apart, for a turn of 9e-5 rad. Planners may keep the places between
  /// and never ask again. Turns of 1e-12 rad stay within the hair of clearance of an edge.
  [[nodiscard]] bool leaves_out_turn(const Configuration& from, const Configuration& to) const {
    return std::any_of(slerps_.begin(), slerps_.end(), [&](std::size_t first) {
      double dot = 0.0;
      double minus = 0.0;
      double plus = 0.0;
      for (std::size_t k = first; k < first + 4; ++k) {
        dot += from[k] * to[k];
        minus += (from[k] - to[k]) * (from[k] - to[k]);
        plus += (from[k] + to[k]) * (from[k] + to[k]);
      }
      // Its dot product is of the numbers as they are: lengths may be 1 to a millionth.
      return std::sqrt(std::min(minus, plus)) > 5e-13 && std::abs(dot) > 1.0 - 2e-9;
    });
  }

  /// Makes a state of a configuration. read() gives it back to the bit, but for angles of joints
  /// that go the short way round: those beyond [-pi, pi) lose whole turns, rounded.
  void write(const Configuration& q, ompl::base::State* state) const {
    state = const_cast<ompl::base::State*>(unwrapped(state));
    std::size_t next = 0;
    for (const Part& part : parts_) {
      auto* found = const_cast<ompl::base::State*>(part.of(state));
      if (part.kind == Kind::pose) {
        auto* pose = found->as<ompl::base::SE3StateSpace::StateType>();
        pose->setXYZ(q[next], q[next + 1], q[next + 2]);
        auto& r = pose->rotation();
        r.w = q[next + 3];
        r.x = q[next + 4];
        r.y = q[next + 5];
        r.z = q[next + 6];
      } else if (part.kind == Kind::angle) {
        found->as<ompl::base::SO2StateSpace::StateType>()->value = within_a_turn(q[next]);
      } else {
        std::copy_n(&q[next], part.count,
                    found->as<ompl::base::RealVectorStateSpace::StateType>()->values);
      }
      next += part.count;
    }
  }

 private:
  static constexpr std::size_t kPose = 7;  // Numbers of a pose.

  enum class Kind { numbers, angle, pose };

  struct Part {
    std::vector<std::size_t> way;  // Through compound states.
    std::size_t count = 1;
    Kind kind = Kind::numbers;

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
    if (typeid(states) == typeid(ompl::base::SE3StateSpace)) {
      const bool is_next = read_ >= places.coordinates().size() && read_ < places.size();
      if (!is_next) {
        refuse(states, "an SE3StateSpace is of a floating joint, behind all other joints");
      }
      parts_.push_back({way, kPose, Kind::pose});
      slerps_.push_back(read_ + 3);
      read_ += kPose;
      return;
    }
    const bool turns = typeid(states) == typeid(ompl::base::SO2StateSpace);
    if (!turns && typeid(states) != typeid(ompl::base::RealVectorStateSpace)) {
      refuse(states,
             "joints have RealVectorStateSpaces, SO2StateSpaces, SE2StateSpaces and, where they "
             "float, SE3StateSpaces");
    }
    const std::size_t count = turns ? 1 : states.getDimension();
    for (std::size_t k = 0; k < count; ++k) {
      if (read_ + k >= places.coordinates().size()) {
        refuse(states, places.poses().empty()
                           ? "it has more numbers than there are joints"
                           : "it has more numbers than there are joints with coordinates; a "
                             "floating joint has an SE3StateSpace");
      }
      const SpaceCoordinate& coordinate = places.coordinates()[read_ + k];
      if (coordinate.turns_short != turns) {
        refuse(states, "joint \"" + coordinate.name +
                           (turns ? "\" does not go the short way round"
                                  : "\" goes the short way round: give it an SO2StateSpace"));
      }
    }
    parts_.push_back({way, count, turns ? Kind::angle : Kind::numbers});
    read_ += count;
  }

  std::vector<Part> parts_;
  std::size_t read_ = 0;
  std::vector<std::size_t> slerps_;  // First numbers of the quaternions that slerp.
  bool is_wrapped_ = false;
};

namespace detail {

/// The bounds of a pose's box.
inline ompl::base::RealVectorBounds bounds_of(const SpacePose& pose) {
  ompl::base::RealVectorBounds bounds(3);
  for (unsigned int k = 0; k < 3; ++k) {
    bounds.setLow(k, pose.low[k]);
    bounds.setHigh(k, pose.high[k]);
  }
  return bounds;
}

/// Whether the only coordinates are those of a planar joint, in their order.
inline bool is_planar(const ConfigurationSpace& places) {
  const auto coordinates = places.coordinates();
  if (coordinates.size() != 3 || places.size() != 3 || places.mover_count() != 1) {
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
/// long way share one RealVectorStateSpace, and a planar joint alone has an SE2StateSpace. Floating
/// joints have SE3StateSpaces, which come last.
inline ompl::base::StateSpacePtr make_ompl_space(const ConfigurationSpace& places) {
  if (places.is_body()) {
    auto space = places.has_screws() ? std::make_shared<ScrewStateSpace>()
                                     : std::make_shared<ompl::base::SE3StateSpace>();
    space->setBounds(detail::bounds_of(places.poses().front()));
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
  for (const SpacePose& pose : places.poses()) {
    auto floats = std::make_shared<ompl::base::SE3StateSpace>();
    floats->setName(pose.name);
    floats->setBounds(detail::bounds_of(pose));
    compound->addSubspace(floats, 1.0);
  }
  if (compound->getSubspaceCount() == 1) {
    return compound->getSubspace(0);  // Some planners know no compounds.
  }
  return compound;
}

}  // namespace firstcontact
