/// The springs, cables and joints of a run: where their ends are at every instant, and their forces.

import type { Vector3 } from "./data/result";
import type { RunData, TieData } from "./data/run_data";
import { identity, place, unplace, type Motion } from "./motion/motion";
import { distance, length, rotate, unit } from "./motion/vector";

export interface Tie {
  readonly type: TieData["type"];
  readonly names: readonly [string | null, string | null]; ///< Of the bodies; null: the world.
  /// Its two points in the world at t in [0, 1]; of joints they are the same but for rounding.
  readonly ends: (t: number) => [Vector3, Vector3];
  readonly axis: ((t: number) => Vector3) | null; ///< Unit, in the world, of a hinge.
  readonly length: number; ///< [m] At which a cable is taut: given, or that at the start.
  readonly forces: readonly number[]; ///< [N] The mean over each step, without impacts.
}

/// Those of a body or of the world.
interface Place {
  readonly name: string;
  readonly motion: Motion;
}

const world: Motion = () => identity;

/// Returns a point of each body, in its frame. A missing point is the other one at the start.
function pointsOf(
  { type, points }: TieData,
  motions: readonly [Motion, Motion],
): [Vector3, Vector3] {
  const [a, b] = points ?? [null, type === "weld" || !points ? [0, 0, 0] : null];
  const start = (side: 0 | 1, point: Vector3): Vector3 => place(motions[side](0), point);
  const other = (side: 0 | 1, point: Vector3): Vector3 =>
    unplace(motions[side](0), start(side === 0 ? 1 : 0, point));
  const first = a ?? other(0, b ?? [0, 0, 0]);
  return [first, b ?? other(1, first)];
}

/// @param bodies  of the page, links among them
export function tiesOf({ header, steps }: RunData, bodies: readonly Place[]): readonly Tie[] {
  const motionOf = (name: string | null): Motion =>
    bodies.find((body) => body.name === name)?.motion ?? world;
  return (header.scene.simulation.ties ?? []).map((tie, k): Tie => {
    const motions = tie.bodies.map(motionOf) as [Motion, Motion];
    const points = pointsOf(tie, motions);
    const { axis } = tie;
    const ends = (t: number): [Vector3, Vector3] => [
      place(motions[0](t), points[0]),
      place(motions[1](t), points[1]),
    ];
    return {
      type: tie.type,
      names: tie.bodies,
      ends,
      axis: axis ? (t) => rotate(motions[0](t).rotation, unit(axis)) : null,
      length: tie.length ?? distance(...ends(0)),
      forces: steps.map((step) => length(step.ties?.[k]?.force ?? [0, 0, 0])),
    };
  });
}
