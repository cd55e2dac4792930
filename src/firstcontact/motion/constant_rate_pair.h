/// @file
/// The motions of two bodies that each follow a Motion, as a query uses them.

#pragma once

#include <optional>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/motion/relative_motion.h>

namespace firstcontact {

/// The pair of two motions. Refers to the motions.
class FIRSTCONTACT_API ConstantRatePair final : public PairMotion {
 public:
  /// Makes the pair of two motions.
  ///
  /// @param p_AC, p_BC  [m]  the bodies' points C, best the centres of their shapes
  /// @param resolution  [m]  as of RelativeMotion
  ConstantRatePair(const Motion& X_WA, const Motion& X_WB, const Eigen::Vector3d& p_AC,
                   const Eigen::Vector3d& p_BC, double resolution);

  double enter(double t) override;
  [[nodiscard]] RelativeState state(double t) const override { return piece_->state(t); }
  [[nodiscard]] double speed_bound(double radius_A, double radius_B) const override;
  [[nodiscard]] Eigen::Vector3d origin(double t) const override;

 private:
  const Motion& X_WA_;
  const Motion& X_WB_;
  Eigen::Vector3d p_AC_;
  Eigen::Vector3d p_BC_;
  double resolution_;
  std::optional<RelativeMotion> piece_;
};

}  // namespace firstcontact
