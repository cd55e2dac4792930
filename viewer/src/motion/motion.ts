/// Where a body is at every instant: the motions of docs/formats.md, as src/firstcontact/motion
/// defines them.

import type {
  Between,
  BodyData,
  MotionData,
  PoseData,
  QuaternionWxyz,
  Vector3,
} from "../data/result";
import {
  add,
  compose,
  conjugate,
  cross,
  dot,
  length,
  rotate,
  scale,
  subtract,
  turn,
  unit,
  unitQuaternion,
} from "./vector";

export interface Pose {
  readonly position: Vector3;
  readonly rotation: QuaternionWxyz; ///< Unit.
}

/// The pose at t in [0, 1] of the scene's duration.
export type Motion = (t: number) => Pose;

export const identity: Pose = { position: [0, 0, 0], rotation: [1, 0, 0, 0] };

/// A point of the body frame in the world.
export const place = (pose: Pose, point: Vector3): Vector3 =>
  add(pose.position, rotate(pose.rotation, point));

/// A point of the world in the body frame.
export const unplace = (pose: Pose, point: Vector3): Vector3 =>
  rotate(conjugate(pose.rotation), subtract(point, pose.position));

/// X_AC of X_AB and X_BC.
export const combine = (a: Pose, b: Pose): Pose => ({
  position: place(a, b.position),
  rotation: compose(a.rotation, b.rotation),
});

export const poseOf = (data: PoseData): Pose => ({
  position: data.position,
  rotation: unitQuaternion(data.quaternion_wxyz),
});

const fixed =
  (pose: Pose): Motion =>
  () =>
    pose;

/// The origin moves on a line, the body turns at a constant rate.
function constantVelocity(from: Pose, translation: Vector3, axis: Vector3, angle: number): Motion {
  return (t) => ({
    position: add(from.position, scale(t, translation)),
    rotation: compose(turn(axis, t * angle), from.rotation),
  });
}

/// @param axis   unit
/// @param along  [m] on the axis, over the whole motion
function screw(from: Pose, point: Vector3, axis: Vector3, angle: number, along: number): Motion {
  const arm = subtract(from.position, point);
  return (t) => {
    const turned = turn(axis, t * angle);
    return {
      position: add(add(point, scale(t * along, axis)), rotate(turned, arm)),
      rotation: compose(turned, from.rotation),
    };
  };
}

function firstComponentPositive(v: Vector3): Vector3 {
  const first = v.find((component) => component !== 0);
  return first !== undefined && first < 0 ? scale(-1, v) : v;
}

/// The shortest rotation; of a half turn, the one whose axis has a positive first component.
function rotationBetween(from: Pose, to: Pose): { axis: Vector3; angle: number } {
  let [w, ...v] = compose(to.rotation, conjugate(from.rotation));
  if (w < 0) {
    [w, v] = [-w, [...scale(-1, v)]];
  } else if (w === 0) {
    v = [...firstComponentPositive(v)];
  }
  return { axis: unit(v), angle: 2 * Math.atan2(length(v), w) };
}

/// Below this the axis of a screw is too far away to be computed, as in C++.
const straight = 1e-15; // [rad]

function betweenPoses(from: Pose, to: Pose, between: Between): Motion {
  const { axis, angle } = rotationBetween(from, to);
  const d = subtract(to.position, from.position);
  if (between === "constant_velocity" || angle < straight) {
    return constantVelocity(from, d, axis, angle);
  }
  const along = dot(d, axis);
  const across = subtract(d, scale(along, axis));
  const lever = add(across, scale(1 / Math.tan(0.5 * angle), cross(axis, across)));
  return screw(from, add(from.position, scale(0.5, lever)), axis, angle, along);
}

function waypoints(times: readonly number[], poses: readonly Pose[], between: Between): Motion {
  const pieces = poses.slice(1).map((pose, i) => betweenPoses(poses[i]!, pose, between));
  return (t) => {
    if (t <= times[0]!) {
      return poses[0]!;
    }
    const next = times.findIndex((time) => t < time);
    if (next < 0) {
      return poses[poses.length - 1]!;
    }
    const begin = times[next - 1]!;
    return pieces[next - 1]!((t - begin) / (times[next]! - begin));
  };
}

function motionFrom(data: MotionData, duration: number): Motion {
  switch (data.type) {
    case "fixed":
      return fixed(poseOf(data.pose));
    case "waypoints":
      return waypoints(
        data.times.map((time) => time / duration),
        data.poses.map(poseOf),
        data.between,
      );
    case "vertices":
      return fixed(identity);
    default:
  }
  const from = poseOf(data.from);
  if ("to" in data) {
    return betweenPoses(from, poseOf(data.to), data.type);
  }
  if (data.type === "screw") {
    const axis = unit(data.axis_direction);
    return screw(from, data.axis_point, axis, data.angle, data.translation);
  }
  const angle = length(data.rotation_vector);
  return constantVelocity(from, data.translation, unit(data.rotation_vector), angle);
}

/// @param duration  [s] of the scene
export function motionOf(body: BodyData, duration: number): Motion {
  return body.motion
    ? motionFrom(body.motion, duration)
    : fixed(body.pose ? poseOf(body.pose) : identity);
}

/// Whether a body stays where it is.
export function isAtRest(body: BodyData): boolean {
  return body.motion === undefined || body.motion.type === "fixed";
}

/// The greatest angle through which a motion turns, over the whole step.
export function totalAngle(motion: MotionData): number {
  switch (motion.type) {
    case "constant_velocity":
      return "to" in motion ? Math.PI : length(motion.rotation_vector);
    case "screw":
      return "to" in motion ? Math.PI : Math.abs(motion.angle);
    case "waypoints":
      return Math.PI * motion.poses.length;
    default:
      return 0;
  }
}
