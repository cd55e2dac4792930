/// Where a body of a run is at every instant: by its recorded pieces.

import type { QuaternionWxyz, Vector3 } from "../data/result";
import type { WayData } from "../data/run_data";
import type { Motion } from "./motion";
import {
  add,
  compose,
  length,
  rotate,
  scale,
  subtract,
  turn,
  unit,
  unitQuaternion,
} from "./vector";

/// The number of the first that is not less; as many as there are where all are less.
export function firstNotLess(sorted: ArrayLike<number>, value: number): number {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    [low, high] = sorted[middle]! < value ? [middle + 1, high] : [low, middle];
  }
  return low;
}

const vectorAt = (row: ArrayLike<number>, k: number): Vector3 => [
  row[3 * k]!,
  row[3 * k + 1]!,
  row[3 * k + 2]!,
];

function rotationAt({ rotations }: WayData, k: number): QuaternionWxyz {
  const [w, x, y, z] = rotations.subarray(4 * k, 4 * k + 4);
  return unitQuaternion([w!, x!, y!, z!]);
}

/// Between two places the centre of mass moves on a line, while the body turns about it at a
/// constant rate.
///
/// @param centre    of mass, in the body frame
/// @param duration  [s] of the run
export function motionAlong(way: WayData, centre: Vector3, duration: number): Motion {
  const { times, places, turns } = way;
  const last = times.length - 1;
  return (t) => {
    const time = t * duration;
    const next = Math.min(Math.max(firstNotLess(times, time), 1), last);
    const from = next - 1;
    const lasts = times[next]! - times[from]!;
    const share = lasts > 0 ? Math.min(Math.max((time - times[from]!) / lasts, 0), 1) : 1;
    const [a, b] = [vectorAt(places, from), vectorAt(places, next)];
    const turned = vectorAt(turns, from);
    const rotation = compose(turn(unit(turned), share * length(turned)), rotationAt(way, from));
    const middle = add(a, scale(share, subtract(b, a)));
    return { position: subtract(middle, rotate(rotation, centre)), rotation };
  };
}

/// [rad] How far a body turns to and fro.
export const angleAlong = ({ turns }: WayData): number =>
  Array.from({ length: turns.length / 3 }, (_, k) => length(vectorAt(turns, k))).reduce(
    (sum, angle) => sum + angle,
    0,
  );

const quarter = 0.5 * Math.PI;

/// [s] Moments between which a body turns by a quarter at most, so that the shortest turn from one
/// to the next is the body's; at the ends of its pieces and within fast ones.
///
/// @param most  Of longer ways pieces are left out that turn by less than a quarter together.
export function keysAlong({ times, turns }: WayData, most: number): number[] {
  const last = times.length - 1;
  const every = Math.ceil(last / most);
  const keys: number[] = [];
  // Files have them in single precision, and they increase.
  const add = (time: number): void => {
    if (keys.length > 0 && Math.fround(time) <= Math.fround(keys.at(-1)!)) {
      keys.pop();
    }
    keys.push(time);
  };
  let turned = 0; // Since the last key.
  for (let k = 0; k < last; ++k) {
    const angle = length(vectorAt(turns, k));
    const parts = Math.max(1, Math.ceil(angle / quarter));
    if (k % every === 0 || turned + angle > quarter) {
      add(times[k]!);
      turned = 0;
    }
    for (let part = 1; part < parts; ++part) {
      add(times[k]! + (part / parts) * (times[k + 1]! - times[k]!));
    }
    turned = parts > 1 ? angle / parts : turned + angle;
  }
  add(times[last]!);
  return keys;
}
