/// The devices of a haptic run: where each of them leads its tool, and what the hand feels there.

import type { Vector3 } from "./data/result";
import type { DeviceData, RunData } from "./data/run_data";
import { place, type Motion, type Pose } from "./motion/motion";
import { distance, length, unitQuaternion } from "./motion/vector";
import { firstNotLess } from "./motion/way";

/// A device as a step begins.
export interface DeviceMoment {
  readonly pose: Pose; ///< Of the tool, where the device leads it.
  readonly force: Vector3; ///< [N] On the device.
  readonly torque: Vector3; ///< [N m] On the device, about the centre of the tool.
  readonly links: readonly Pose[]; ///< Of the links of a hand, where the device leads them.
}

type PoseRows = Pick<DeviceData, "positions" | "rotations">;

/// A body that a device moves.
interface Tool {
  readonly name: string;
  readonly motion: Motion;
}

export class Device {
  readonly body: number;
  readonly links: readonly number[]; ///< The bodies of a hand's links.
  readonly name: string; ///< Of its tool.
  readonly forces: readonly number[]; ///< [N] Of each step.
  readonly torques: readonly number[]; ///< [N m] Of each step.
  /// [m] Of each step: from where the device leads the tool to where the tool is, by their centres.
  readonly leads: readonly number[];
  private readonly begins: readonly number[]; // t of each step.

  /// @param centre  of mass, in the frame of the tool: it follows the handle
  constructor(
    private readonly data: DeviceData,
    private readonly tool: Tool,
    private readonly centre: Vector3,
    { steps }: RunData,
  ) {
    const duration = steps.at(-1)!.time;
    this.body = data.body;
    this.links = data.links.map(({ body }) => body);
    this.name = tool.name;
    this.begins = steps.map(({ time, lasted }) => (time - lasted) / duration);
    const each = (of: (moment: DeviceMoment, step: number) => number): number[] =>
      steps.map((_, step) => {
        const moment = this.at(step);
        return moment ? of(moment, step) : 0;
      });
    this.forces = each(({ force }) => length(force));
    this.torques = each(({ torque }) => length(torque));
    this.leads = each(({ pose }, step) =>
      distance(place(pose, centre), this.centreAt(this.begins[step]!)),
    );
  }

  /// Null before the first step that has the device.
  at(step: number): DeviceMoment | null {
    const { steps, forces, torques, links } = this.data;
    const k = firstNotLess(steps, step + 1) - 1;
    if (k < 0) {
      return null;
    }
    const row = (numbers: ArrayLike<number>): Vector3 => [
      numbers[3 * k]!,
      numbers[3 * k + 1]!,
      numbers[3 * k + 2]!,
    ];
    const pose = ({ positions, rotations }: PoseRows): Pose => {
      const [w, x, y, z] = rotations.subarray(4 * k, 4 * k + 4);
      return { position: row(positions), rotation: unitQuaternion([w!, x!, y!, z!]) };
    };
    return {
      pose: pose(this.data),
      force: row(forces),
      torque: row(torques),
      links: links.map(pose),
    };
  }

  /// The centre of the tool at a moment.
  centreAt(t: number): Vector3 {
    return place(this.tool.motion(t), this.centre);
  }

  /// The centre of the tool where the device leads it.
  targetOf({ pose }: DeviceMoment): Vector3 {
    return place(pose, this.centre);
  }
}

export const devicesOf = (run: RunData, bodies: readonly Tool[]): readonly Device[] =>
  run.devices.map(
    (data) => new Device(data, bodies[data.body]!, run.header.centres_of_mass[data.body]!, run),
  );
