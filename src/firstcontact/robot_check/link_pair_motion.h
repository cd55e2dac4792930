/// @file
/// Two bodies that move by joints, as a query sees them.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// A body of a pair: its motion in a frame F that both share, and a ball around its shape.
struct LinkBall {
  const LinkMotion& X_FL;
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                             ///< [m]
};

/// The relative motion of two links, each of which turns about its pole of acceleration.
///
/// That is the point whose acceleration across the spin is zero. A link on one axle that turns at a
/// constant rate then has no bend at the start of a piece.
///
/// Derivation: w is the spin and al its rate. c is the acceleration of the ball's centre C at t,
/// and a its part across w. The pole is Q = C + a / w^2. A point at d from Q has the acceleration
/// q + al x d + w x (w x d), with q that of the link's point at Q. Its model has w x (w x d). They
/// differ by q + al x d at t, and after tau by at most (J + w^3 |d|) tau more, with J a bound of
/// the point's jerk. J_P is such a bound for the link's point P, and j its growth for each metre
/// from P. So for tau <= T the difference, integrated twice, is at most
///   (|q| + (J_P + j |Q - P|) T / 3  +  (|al| + (j + w^3) T / 3) |d|) tau^2 / 2.
/// P is the pole at the start of the piece. A pole outside of the ball gives no tight bound; P is
/// then C, |q| + |al| |d| is |c - a| + |al| r, and J is J_P + j r.
///
/// Pieces are windows of time in which no point's path bends by more than about half of itself. For
/// bodies that follow a Motion they are its pieces, and nothing bends. Windows are halves of halves
/// of a smooth piece, so that pairs of one robot share them. Refers to the motions and the scratch
/// memory.
class FIRSTCONTACT_API LinkPairMotion final : public PairMotion {
 public:
  /// @param t_end  end of the time that is of interest
  LinkPairMotion(const LinkBall& A, const LinkBall& B, LinkScratch& scratch, double t_end = 1.0);

  double enter(double t) override;
  [[nodiscard]] RelativeState state(double t) const override;
  [[nodiscard]] double speed_bound(double radius_A, double radius_B) const override;
  [[nodiscard]] bool follows_joints() const override { return true; }
  [[nodiscard]] Eigen::Vector3d origin(double t) const override;

 private:
  struct Body {
    LinkBall ball;
    const LinkPath* path = nullptr;  ///< The piece that was entered.
    double speed = 0.0;  ///< [m per step]  Bound for any point of the ball, in the window.
    double jerk = 0.0;   ///< [m per step^3]  Bound for any point of the ball, in the window.
    bool has_near_pole = false;  ///< Whether the pole is within the ball, at the start of the
                                 ///< window.
    Eigen::Vector3d p_LP = Eigen::Vector3d::Zero();  ///< [m]  The pole, or the ball's centre.
    double jerk_at_P = 0.0;       ///< [m per step^3]  Bound for that point of the link.
    double jerk_per_metre = 0.0;  ///< [per step^3]  Growth of the bound for each metre from it.
  };
  struct BodyState;
  void bound(Body& body, double t, double end);
  [[nodiscard]] BodyState state_of(const Body& body, double t) const;
  void set_bend(const Body& body, const LinkState& link, const Eigen::Vector3d& bent,
                const Eigen::Vector3d& lever, double error, double t, BodyState& state) const;
  [[nodiscard]] BodyState free_state(const Body& body, const ConstantRatePath& path,
                                     double t) const;

  std::array<Body, 2> bodies_;
  double t_end_;
  double end_ = 0.0;
  DoubleDoubleVector3 p_FO_;  ///< Origin of positions.
  LinkScratch& scratch_;
};

}  // namespace firstcontact
