#include <firstcontact/robot/tracking_error.h>

#include <stdexcept>

#include <firstcontact/robot/robot_description.h>

namespace firstcontact {

TrackingError tracking_error_of(const Joint& joint, double coordinate) {
  if (coordinate_count(joint.type) != 1) {
    throw std::invalid_argument("tracking_error_of: joint '" + joint.name +
                                "' does not have one coordinate");
  }
  return joint.type == JointType::prismatic ? TrackingError{.distance = coordinate}
                                            : TrackingError{.angle = coordinate};
}

}  // namespace firstcontact
