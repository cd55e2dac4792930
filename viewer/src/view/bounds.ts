/// Where things are, for cameras that look at them.

import { Box3, Sphere, Vector3 } from "three";
import type { GoalPose } from "../data/path_data";
import type { Vector3 as Point } from "../data/result";
import type { Body, BodyGeometry } from "../model";
import { place, poseOf, type Pose } from "../motion/motion";
import { add, scale } from "../motion/vector";

const moments = 33;
const farApart = 2.5; // By the size of the way to the first touch.

const size = (box: Box3): number => box.getSize(new Vector3()).length();

/// The corners of boxes around the geometries of a body, in its frame, at both ends of the step: in
/// between, what deforms is in the box between them.
interface Corners {
  readonly from: readonly Point[];
  readonly to: readonly Point[];
}

/// Around a geometry, in its frame.
export function geometryBox({ mesh, radius }: BodyGeometry): Box3 {
  return new Box3()
    .setFromArray(mesh.positions)
    .translate(new Vector3(...mesh.origin))
    .expandByScalar(radius);
}

function cornersOf(shape: BodyGeometry): Corners {
  const { pose, radius, to } = shape;
  const around = ({ min, max }: Box3): Point[] =>
    corners(min, max).map((corner) => place(pose, corner.toArray()));
  const from = around(geometryBox(shape));
  if (to === null) {
    return { from, to: from };
  }
  const ends = to.map((p) => new Vector3(...p));
  return { from, to: around(new Box3().setFromPoints(ends).expandByScalar(radius)) };
}

export const corners = (min: Vector3, max: Vector3): Vector3[] =>
  [0, 1, 2, 3, 4, 5, 6, 7].map(
    (k) => new Vector3(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z),
  );

export class Bounds {
  private readonly corners: readonly Corners[];

  /// @param goal  poses of bodies that are seen, too
  constructor(
    private readonly bodies: readonly Body[],
    private readonly goal: readonly GoalPose[] = [],
  ) {
    this.corners = bodies.map(({ geometries, looks }) => {
      const all = [...geometries, ...(looks ?? [])].map(cornersOf);
      return { from: all.flatMap(({ from }) => from), to: all.flatMap(({ to }) => to) };
    });
  }

  bodiesAt(bodies: readonly Body[], t: number): Sphere {
    const box = new Box3();
    bodies.forEach((body) => this.include(body, t, box));
    return box.getBoundingSphere(new Sphere());
  }

  /// All bodies over the whole step; without resting bodies that dwarf those that move.
  sweep(): Box3 {
    return this.sweepUntil(1);
  }

  /// What is looked at first. Where bodies fly far apart after the first touch, only the way to it.
  opening(firstTouch: number | null): Box3 {
    const whole = this.sweep();
    if (firstTouch === null || firstTouch === 0) {
      return whole;
    }
    const before = this.sweepUntil(firstTouch);
    return size(whole) < farApart * size(before) ? whole : before;
  }

  private sweepUntil(end: number): Box3 {
    const moving = this.sweepOf(
      this.bodies.filter(({ atRest }) => !atRest),
      end,
    );
    const all = this.sweepOf(this.bodies, end);
    if (moving.isEmpty() || size(all) < 4 * size(moving)) {
      return all;
    }
    return moving.expandByScalar(0.3 * size(moving)).intersect(all);
  }

  private sweepOf(bodies: readonly Body[], end: number): Box3 {
    const box = new Box3();
    for (const body of bodies) {
      const count = body.atRest ? 1 : moments;
      for (let k = 0; k < count; ++k) {
        this.include(body, count > 1 ? (end * k) / (count - 1) : 0, box);
      }
    }
    this.goal.forEach((pose) => this.include(this.bodies[pose.body]!, 0, box, poseOf(pose)));
    return box;
  }

  private include(body: Body, t: number, box: Box3, pose: Pose = body.motion(t)): void {
    const { from, to } = this.corners[body.index]!;
    from.forEach((p, k) => {
      const corner = add(scale(1 - t, p), scale(t, to[k]!));
      box.expandByPoint(new Vector3(...place(pose, corner)));
    });
  }
}
