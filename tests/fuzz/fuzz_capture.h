/// @file
/// Properties of every captured motion that a reader returns.

#pragma once

#include <firstcontact/robot_files/motion_capture.h>

#include "fuzz/fuzz_reader.h"

namespace firstcontact::test {

/// Requires that the capture gives a figure, and its first and last frames a motion.
inline void require_sound(const MotionCapture& capture) {
  const RobotModel figure = make_figure(capture);
  require(figure.links().size() == capture.bones.size());
  require(capture.frame_time > 0.0);
  if (capture.frames.size() > 1) {
    const RobotMotion motion = capture_motion(figure, capture, 0, capture.frames.size() - 1);
    const LinkPose pose = motion.link(figure.links().size() - 1).at(1.0).pose(1.0);
    require(pose.p_OL.allFinite());
  }
}

}  // namespace firstcontact::test
