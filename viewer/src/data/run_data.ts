/// A run as `firstcontact simulate` records it, as far as the page shows it (see docs/run_format.md).

import { bytesOf } from "./bytes";
import type { SceneData, Vector3 } from "./result";

export interface ImpactData {
  readonly at: number; ///< [s] Since the step began.
  readonly bodies: readonly [number, number];
  readonly point: Vector3;
  readonly impulse: Vector3; ///< [N s] On the second body.
}

/// The values of a step for all bodies together.
export interface StepData {
  readonly step: number;
  readonly time: number; ///< [s] At its end.
  readonly lasted: number; ///< [s]
  readonly time_lost: number; ///< [s]
  readonly clearance: number | null; ///< [m]
  readonly kinetic_energy: number; ///< [J]
  readonly potential_energy: number; ///< [J]
  readonly linear_momentum: Vector3; ///< [kg m/s]
  readonly angular_momentum: Vector3; ///< [kg m²/s]
  readonly residual: number; ///< [m/s]
  readonly events: number;
  readonly robots?: readonly RobotStepData[]; ///< That forces move.
  readonly impacts?: readonly ImpactData[];
  readonly ties?: readonly TieForceData[]; ///< In the order of the scene's.
}

/// The force of a tie.
export interface TieForceData {
  readonly force: Vector3; ///< [N] On its second body, the mean over the step without impacts.
}

/// A tie of two bodies, or of a body and the world, as in scenes.
export interface TieData {
  readonly type: "spring" | "cable" | "pin" | "hinge" | "weld";
  readonly bodies: readonly [string | null, string | null];
  readonly points?: readonly [Vector3 | null, Vector3 | null];
  readonly length?: number; ///< [m]
  readonly axis?: Vector3; ///< Of a hinge, in the frame of the first body.
}

/// A robot at the end of a step.
export interface RobotStepData {
  readonly velocities: readonly number[]; ///< [rad/s or m/s]
  readonly efforts: readonly number[]; ///< [N m or N] Of motors, the mean over the step.
}

/// The way of a body: where each of its pieces begins, and where the last one ends.
export interface WayData {
  readonly body: number;
  readonly times: Float64Array; ///< [s]
  readonly places: Float64Array; ///< [m] Of the centre of mass.
  readonly rotations: Float32Array; ///< w, x, y, z
  readonly turns: Float32Array; ///< [rad] Rotation vector until the next place.
}

/// All contacts, step after step.
export interface RunContactsData {
  readonly until: Uint32Array; ///< Of each step: how many there are with those before.
  readonly bodies: Uint32Array; ///< Two of each.
  readonly points: Float64Array; ///< [m]
  readonly impulses: Float32Array; ///< [N s] On the second body.
  readonly distances: Float32Array; ///< [m]
}

/// The device of a tool in a haptic run, a row for each step that has it.
export interface DeviceData {
  readonly body: number; ///< The tool.
  readonly steps: Uint32Array; ///< From 0: it is so as the step begins.
  readonly positions: Float64Array; ///< [m] Of the tool's frame, where the device leads it.
  readonly rotations: Float32Array; ///< w, x, y, z
  readonly forces: Float32Array; ///< [N] On the device.
  readonly torques: Float32Array; ///< [N m] On the device, about the centre of mass.
  readonly links: readonly DeviceLinkData[]; ///< Of a hand: its fingers.
}

/// A link of a tool where the device leads it, a row for each row of the device.
export interface DeviceLinkData {
  readonly body: number;
  readonly positions: Float64Array; ///< [m]
  readonly rotations: Float32Array; ///< w, x, y, z
}

export interface RunHeader {
  /// Left out of simulations.
  readonly kind?: "haptics";
  readonly scene: SceneData & {
    readonly simulation: {
      readonly duration: number;
      readonly step: number;
      readonly gravity: Vector3;
      readonly ties?: readonly TieData[];
    };
  };
  readonly version: string;
  readonly masses: readonly number[];
  readonly centres_of_mass: readonly Vector3[];
}

export interface RunData {
  readonly header: RunHeader;
  /// The number of the first geometry of a robot's links; as many as bodies where there is none.
  readonly linksFrom: number;
  readonly steps: readonly StepData[];
  readonly ways: readonly WayData[];
  readonly contacts: RunContactsData;
  readonly devices: readonly DeviceData[]; ///< Of haptic runs.
}

/// As the tool leaves it: rows of numbers are base64.
type Stored<T> = {
  readonly [K in keyof T]: T[K] extends Float64Array | Float32Array | Uint32Array ? string : T[K];
};

export interface StoredRun {
  readonly header: RunHeader;
  readonly links_from: number;
  readonly steps: readonly StepData[];
  readonly ways: readonly Stored<WayData>[];
  readonly contacts: Stored<RunContactsData>;
  /// Links are left out where a tool has none.
  readonly devices?: readonly (Stored<Omit<DeviceData, "links">> & {
    readonly links?: readonly Stored<DeviceLinkData>[];
  })[];
}

const doubles = (text: string): Float64Array => new Float64Array(bytesOf(text));
const singles = (text: string): Float32Array => new Float32Array(bytesOf(text));
const counts = (text: string): Uint32Array => new Uint32Array(bytesOf(text));

export function runOf(stored: StoredRun): RunData {
  const { header, links_from, steps, ways, contacts, devices = [] } = stored;
  return {
    header,
    linksFrom: links_from,
    steps,
    ways: ways.map(({ body, times, places, rotations, turns }) => ({
      body,
      times: doubles(times),
      places: doubles(places),
      rotations: singles(rotations),
      turns: singles(turns),
    })),
    contacts: {
      until: counts(contacts.until),
      bodies: counts(contacts.bodies),
      points: doubles(contacts.points),
      impulses: singles(contacts.impulses),
      distances: singles(contacts.distances),
    },
    devices: devices.map(({ body, links = [], ...rows }) => ({
      body,
      steps: counts(rows.steps),
      positions: doubles(rows.positions),
      rotations: singles(rows.rotations),
      forces: singles(rows.forces),
      torques: singles(rows.torques),
      links: links.map(({ body, positions, rotations }) => ({
        body,
        positions: doubles(positions),
        rotations: singles(rotations),
      })),
    })),
  };
}
