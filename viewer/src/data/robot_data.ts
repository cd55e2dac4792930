/// Robots as the tool leaves them in the page (see docs/viewer.md).

import type { PoseData, QuaternionWxyz, Vector3 } from "./result";

/// A geometry of a link, by the number of its mesh.
export interface GeometryData {
  readonly mesh: number;
  readonly pose: PoseData;
  readonly radius?: number;
  /// Red, green, blue, from 0 to 1: the colour of the visual geometry.
  readonly color?: Vector3;
}

export interface LinkData {
  readonly name: string;
  readonly collision: readonly GeometryData[];
  /// The visual geometry of the link, if it differs.
  readonly visual?: readonly GeometryData[];
}

/// a[0] + a[1] s + a[2] s² ..., with s from 0 to 1 between the end of the segment before and `until`.
export interface SegmentData {
  readonly until: number;
  readonly a: readonly number[];
}

export interface CoordinateData {
  readonly name: string;
  readonly segments: readonly SegmentData[];
}

/// A pivot on a line, and the origin of a frame that turns about it at a constant rate.
export interface PieceData {
  readonly until: number;
  readonly pivot: Vector3;
  readonly velocity: Vector3;
  readonly axis: Vector3;
  readonly rate: number;
  readonly lever: Vector3;
  readonly quaternion_wxyz: QuaternionWxyz;
}

export interface LimitsData {
  readonly lower?: number;
  readonly upper?: number;
  readonly velocity?: number;
}

export type JointType =
  "fixed" | "revolute" | "continuous" | "prismatic" | "screw" | "planar" | "floating" | "ball";

export interface JointData {
  readonly name: string;
  readonly type: JointType;
  readonly parent: number; ///< Link.
  readonly child: number;
  readonly pose: PoseData; ///< Of the joint in its parent.
  readonly axis: Vector3; ///< Unit, in the joint.
  readonly limits: LimitsData;
  readonly pitch?: number; ///< [m/rad] Of a screw.
  readonly mimics?: string;
  readonly coordinates?: readonly CoordinateData[];
  readonly motion?: readonly PieceData[]; ///< Of floating and ball joints.
}

export interface RobotData {
  readonly name: string;
  readonly base: readonly PieceData[];
  readonly links: readonly LinkData[];
  readonly joints: readonly JointData[];
}

/// A part of the step in which a body follows its own motion; or a link, by the number of the body
/// that it is; or rests at a pose.
export interface StretchData {
  readonly until: number;
  readonly link?: number;
  readonly pose?: PoseData;
}

export interface CarriedData {
  readonly body: number;
  readonly stretches: readonly StretchData[];
}
