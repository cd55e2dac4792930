/// Where things are, for cameras that look at them.

import { Box3, Sphere, Vector3 } from "three";
import type { Body } from "../model";
import { place } from "../motion/motion";

const moments = 33;

/// Around a mesh, in the body frame.
export function localSphere(body: Body): Sphere {
  const { origin, positions } = body.mesh;
  const box = new Box3().setFromArray(positions);
  const sphere = box.getBoundingSphere(new Sphere());
  return new Sphere(sphere.center.add(new Vector3(...origin)), sphere.radius + radiusOf(body));
}

/// [m] by which a shape is thickened.
export function radiusOf(body: Body): number {
  const { radius } = body.data.shape;
  return typeof radius === "number" ? radius : 0;
}

export function sphereAt(body: Body, local: Sphere, t: number): Sphere {
  const { x, y, z } = local.center;
  return new Sphere(new Vector3(...place(body.motion(t), [x, y, z])), local.radius);
}

function boxOf(spheres: readonly Sphere[]): Box3 {
  const box = new Box3();
  spheres.forEach((sphere) => box.union(sphere.getBoundingBox(new Box3())));
  return box;
}

export class Bounds {
  private readonly local: readonly Sphere[];

  constructor(private readonly bodies: readonly Body[]) {
    this.local = bodies.map(localSphere);
  }

  bodyAt(body: Body, t: number): Sphere {
    return sphereAt(body, this.local[body.index]!, t);
  }

  /// All bodies over the whole step; without resting bodies that dwarf those that move.
  sweep(): Box3 {
    const moving = boxOf(this.sweepOf(this.bodies.filter(({ atRest }) => !atRest)));
    const all = boxOf(this.sweepOf(this.bodies));
    const size = (box: Box3): number => box.getSize(new Vector3()).length();
    if (moving.isEmpty() || size(all) < 4 * size(moving)) {
      return all;
    }
    return moving.expandByScalar(0.3 * size(moving)).intersect(all);
  }

  private sweepOf(bodies: readonly Body[]): Sphere[] {
    return bodies.flatMap((body) =>
      Array.from({ length: body.atRest ? 1 : moments }, (_, k) =>
        this.bodyAt(body, k / (moments - 1)),
      ),
    );
  }
}
