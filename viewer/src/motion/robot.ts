/// Where the links of a robot are: joints on their polynomials, as src/firstcontact/robot
/// defines them.

import type { JointData, PieceData, RobotData, SegmentData } from "../data/robot_data";
import type { Vector3 } from "../data/result";
import { combine, identity, poseOf, type Motion, type Pose } from "./motion";
import { add, compose, dot, rotate, scale, subtract, turn, zero } from "./vector";

const kept = 64; // Moments whose poses are remembered: all links are asked about the same ones.

interface Timed {
  readonly until: number;
}

/// The piece that holds t, and how far it is along it, from 0 to 1.
function pieceAt<T extends Timed>(pieces: readonly T[], t: number): { piece: T; begin: number } {
  const found = pieces.findIndex(({ until }) => t <= until);
  const k = found < 0 ? pieces.length - 1 : found;
  return { piece: pieces[k]!, begin: k > 0 ? pieces[k - 1]!.until : 0 };
}

/// A joint's coordinate at t. [rad or m]
export function coordinateAt(segments: readonly SegmentData[], t: number): number {
  const { piece, begin } = pieceAt(segments, t);
  const s = (t - begin) / (piece.until - begin);
  return piece.a.reduceRight((sum, a) => sum * s + a, 0);
}

/// A derivative of a joint's coordinate at t, per unit of t: the first, second or third one.
export function derivativeAt(segments: readonly SegmentData[], t: number, order: number): number {
  const { piece, begin } = pieceAt(segments, t);
  const length = piece.until - begin;
  const s = (t - begin) / length;
  let a: readonly number[] = piece.a;
  for (let k = 0; k < order; ++k) {
    a = a.slice(1).map((coefficient, j) => ((j + 1) * coefficient) / length);
  }
  return a.reduceRight((sum, coefficient) => sum * s + coefficient, 0);
}

/// Whether a coordinate never changes.
export const restsAt = (segments: readonly SegmentData[]): boolean =>
  segments.every(({ a }) => a[0] === segments[0]!.a[0] && a.slice(1).every((x) => x === 0));

/// The motion that pieces of constant rates say.
export function constantRates(pieces: readonly PieceData[]): Motion {
  return (t) => {
    const { piece, begin } = pieceAt(pieces, t);
    const turned = turn(piece.axis, (t - begin) * piece.rate);
    const pivot = add(piece.pivot, scale(t - begin, piece.velocity));
    return {
      position: add(pivot, rotate(turned, piece.lever)),
      rotation: compose(turned, piece.quaternion_wxyz),
    };
  };
}

export const restsOn = (pieces: readonly PieceData[]): boolean =>
  pieces.length === 1 &&
  pieces[0]!.rate === 0 &&
  dot(pieces[0]!.velocity, pieces[0]!.velocity) === 0;

/// Where a planar joint's x or y direction is: turned by the shortest rotation that takes z to n.
function acrossPlane(e: Vector3, n: Vector3): Vector3 {
  const sum = n[2] > 0 ? 1 + n[2] : (n[0] * n[0] + n[1] * n[1]) / (1 - n[2]);
  if (sum === 0) {
    return [e[0], -e[1], 0]; // Half a turn about x.
  }
  return subtract(e, scale(dot(n, e) / sum, [n[0], n[1], sum]));
}

/// X_JL(t) of a joint.
function motionOfJoint(joint: JointData): Motion {
  const { type, axis, pitch = 0, coordinates = [], motion } = joint;
  if (motion) {
    return constantRates(motion);
  }
  const q = (k: number, t: number): number => coordinateAt(coordinates[k]!.segments, t);
  switch (type) {
    case "revolute":
    case "continuous":
      return (t) => ({ position: zero, rotation: turn(axis, q(0, t)) });
    case "prismatic":
      return (t) => ({ position: scale(q(0, t), axis), rotation: identity.rotation });
    case "screw":
      return (t) => ({ position: scale(pitch * q(0, t), axis), rotation: turn(axis, q(0, t)) });
    case "planar": {
      const [x, y] = [acrossPlane([1, 0, 0], axis), acrossPlane([0, 1, 0], axis)];
      return (t) => ({
        position: add(scale(q(0, t), x), scale(q(1, t), y)),
        rotation: turn(axis, q(2, t)),
      });
    }
    default:
      return () => identity;
  }
}

/// Of each link, in the world.
export function linkMotions(robot: RobotData): Motion[] {
  const joints = rootsFirst(robot).map((joint) => ({
    ...joint,
    place: poseOf(joint.pose),
    move: motionOfJoint(joint),
  }));
  const base = constantRates(robot.base);
  const known = new Map<number, readonly Pose[]>();

  const posesAt = (t: number): readonly Pose[] => {
    const poses = new Array<Pose>(robot.links.length).fill(base(t));
    for (const { parent, child, place, move } of joints) {
      poses[child] = combine(combine(poses[parent]!, place), move(t));
    }
    return poses;
  };
  const remembered = (t: number): readonly Pose[] => {
    const poses = known.get(t) ?? posesAt(t);
    if (known.size >= kept) {
      known.clear();
    }
    known.set(t, poses);
    return poses;
  };
  return robot.links.map((_, link) => (t) => remembered(t)[link]!);
}

/// The joints, each after the one that moves its parent.
function rootsFirst({ links, joints }: RobotData): JointData[] {
  const below = new Map<number, JointData[]>(links.map((_, link) => [link, []]));
  joints.forEach((joint) => below.get(joint.parent)!.push(joint));
  const children = new Set(joints.map(({ child }) => child));
  const from = (link: number): JointData[] =>
    below.get(link)!.flatMap((joint) => [joint, ...from(joint.child)]);
  return links.flatMap((_, link) => (children.has(link) ? [] : from(link)));
}

/// The joints from the root to a link.
export function chainTo(robot: RobotData, link: number): JointData[] {
  const joint = robot.joints.find(({ child }) => child === link);
  return joint ? [...chainTo(robot, joint.parent), joint] : [];
}
