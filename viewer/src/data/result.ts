/// The JSON that `firstcontact check` writes, as far as the page shows it (see docs/formats.md).

import type { FileReport, PairCounts } from "./reports";

export type Vector3 = readonly [number, number, number];
export type QuaternionWxyz = readonly [number, number, number, number];

export interface PoseData {
  readonly position: Vector3;
  readonly quaternion_wxyz: QuaternionWxyz;
}

export type Between = "constant_velocity" | "screw";

export type MotionData =
  | { readonly type: "fixed"; readonly pose: PoseData }
  | {
      readonly type: "constant_velocity";
      readonly from: PoseData;
      readonly translation: Vector3;
      readonly rotation_vector: Vector3;
    }
  | {
      readonly type: "screw";
      readonly from: PoseData;
      readonly axis_point: Vector3;
      readonly axis_direction: Vector3;
      readonly angle: number;
      readonly translation: number;
    }
  | { readonly type: Between; readonly from: PoseData; readonly to: PoseData }
  | {
      readonly type: "waypoints";
      readonly times: readonly number[];
      readonly poses: readonly PoseData[];
      readonly between: Between;
    }
  | { readonly type: "vertices"; readonly to: readonly Vector3[] };

export interface BodyData {
  readonly name: string;
  readonly shape: Readonly<Record<string, unknown>>;
  readonly pose?: PoseData;
  readonly motion?: MotionData;
}

export interface SceneData {
  readonly id: string;
  readonly bodies: readonly BodyData[];
  readonly options: {
    readonly duration: number;
    readonly margin: number;
    readonly tolerance?: number;
  };
}

export type Verdict = "free" | "contact" | "contact_at_start" | "undecided";
export type Names = readonly [string, string];

export interface Feature {
  readonly type: "vertex" | "edge" | "face";
  readonly index: number;
}

export interface Contact {
  readonly bodies: Names;
  /// Which geometry of each, where links may have several.
  readonly geometries?: readonly [number, number];
  readonly features: readonly [Feature, Feature];
  readonly triangles: readonly [number, number];
  readonly points: readonly [Vector3, Vector3];
  readonly normal: Vector3 | null;
  readonly distance: number;
  readonly normal_velocity: number | null;
}

export interface Closest {
  readonly pair: Names;
  readonly distance: number;
  readonly lower_bound: number;
  readonly t: number;
  readonly time: number;
  readonly points?: readonly [Vector3, Vector3];
}

/// The answer for the scene; the answer of each pair has the same keys.
export interface Answer {
  readonly verdict: Verdict;
  readonly reason: string | null;
  readonly t: number;
  readonly t_upper: number | null;
  readonly time: number;
  readonly pair: Names | null;
  readonly contacts: readonly Contact[];
  /// How many there are, those included that are not listed.
  readonly contact_count?: number;
  readonly clearance: number | null;
  readonly closest?: Closest;
}

/// From when to when a pair is in contact.
export interface Interval {
  readonly enter: number;
  readonly leave: number;
}

export interface PairAnswer extends Answer {
  readonly pair: Names;
  readonly margin: number;
  readonly intervals?: readonly Interval[];
}

/// A joint beyond one of its limits. Outside the intervals [s] the joint keeps the limit.
export interface Limit {
  readonly robot: string;
  readonly joint: string;
  readonly limit: "lower_position" | "upper_position" | "velocity";
  readonly value: number;
  readonly excess: number;
  readonly time: number;
  readonly intervals: readonly (readonly [number, number])[];
}

/// Which way a continuous joint went [rad].
export interface Turn {
  readonly robot: string;
  readonly joint: string;
  readonly from: number;
  readonly to: number;
  readonly turned: number;
  readonly turning: "long" | "short";
}

export interface Result extends Answer {
  readonly id: string;
  readonly tolerance_used?: number;
  readonly enclosure_error?: number;
  readonly turns?: readonly Turn[];
  readonly pairs?: readonly PairAnswer[];
  readonly limits?: readonly Limit[];
  readonly warnings?: readonly string[];
  /// Results of earlier versions lack these two.
  readonly pair_counts?: PairCounts;
  readonly files?: readonly FileReport[];
  readonly scene: SceneData;
  readonly version: string;
}
