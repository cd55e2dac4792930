#include <firstcontact/scene/body_motion.h>

#include <variant>
#include <vector>

namespace firstcontact {
namespace {

/// Makes a motion of each kind; the overloads are picked by std::visit.
struct MotionMaker {
  double duration;

  Motion operator()(const FixedMotion& motion) const { return Motion::fixed(motion.pose); }

  Motion operator()(const ConstantVelocityMotion& motion) const {
    return Motion::constant_velocity(motion.from, motion.translation, motion.rotation_vector);
  }

  Motion operator()(const ScrewMotion& motion) const {
    return Motion::screw(motion.from, motion.axis_point, motion.axis_direction, motion.angle,
                         motion.translation);
  }

  Motion operator()(const TwoPoseMotion& motion) const {
    return motion.between == Between::screw ? Motion::screw(motion.from, motion.to)
                                            : Motion::constant_velocity(motion.from, motion.to);
  }

  Motion operator()(const WaypointMotion& motion) const {
    std::vector<double> times = motion.times;
    for (double& time : times) {
      time /= duration;
    }
    return Motion::waypoints(times, motion.poses, motion.between);
  }

  Motion operator()(const VertexMotion&) const { return Motion::fixed(); }
};

}  // namespace

bool spans_duration(const BodyMotion& motion) {
  return !std::holds_alternative<FixedMotion>(motion) &&
         !std::holds_alternative<WaypointMotion>(motion);
}

Motion normalised_motion(const BodyMotion& motion, double duration) {
  return std::visit(MotionMaker{duration}, motion);
}

}  // namespace firstcontact
