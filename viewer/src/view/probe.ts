/// Points that were clicked. They stick to their bodies, so that their distance can be followed.

import {
  BufferGeometry,
  Group,
  Line,
  LineDashedMaterial,
  Points,
  PointsMaterial,
  Triangle,
  Vector3 as V3,
} from "three";
import { Signal } from "../core/signal";
import type { Vector3 } from "../data/result";
import type { Body, BodyGeometry } from "../model";
import { place } from "../motion/motion";
import { distance } from "../motion/vector";
import { cornersAt, pointAt } from "./triangle";

export interface ProbePoint {
  readonly body: Body;
  readonly triangle: number;
  /// In the body frame.
  readonly local: (t: number) => Vector3;
}

export interface PlacedPoint {
  readonly body: Body;
  readonly triangle: number;
  readonly local: Vector3;
  readonly world: Vector3;
}

/// @param local  where it was clicked, in the body frame
/// @param t      when
export function probePoint(
  body: Body,
  shape: BodyGeometry,
  triangle: number,
  local: Vector3,
  t: number,
): ProbePoint {
  if (shape.to === null) {
    return { body, triangle, local: () => local };
  }
  const corners = cornersAt(shape, triangle, t);
  const corner = (k: number): V3 => new V3().fromArray(corners, 3 * k);
  const relative = new V3(...local).sub(new V3(...shape.mesh.origin));
  const weights = Triangle.getBarycoord(relative, corner(0), corner(1), corner(2), new V3());
  const kept = weights?.toArray() ?? [1, 0, 0]; // A triangle without area is a line.
  return { body, triangle, local: (now) => pointAt(shape, triangle, kept, now) };
}

export class Probe {
  readonly points = new Signal<readonly ProbePoint[]>([]);
  readonly group = new Group();
  private readonly line = new Line(
    new BufferGeometry().setFromPoints([new V3(), new V3()]),
    new LineDashedMaterial({ color: "#ffcf40", depthTest: false, transparent: true }),
  );
  private readonly dots = new Points(
    new BufferGeometry().setFromPoints([new V3(), new V3()]),
    new PointsMaterial({
      color: "#ffcf40",
      size: 9,
      sizeAttenuation: false,
      depthTest: false,
      transparent: true,
    }),
  );

  constructor() {
    this.line.renderOrder = this.dots.renderOrder = 13;
    this.line.frustumCulled = this.dots.frustumCulled = false;
    this.group.add(this.line, this.dots);
  }

  /// @param measure  the second of two points, where there is a first one alone
  add(point: ProbePoint, measure: boolean): void {
    const { value } = this.points;
    this.points.value = measure && value.length === 1 ? [value[0]!, point] : [point];
  }

  clear(): void {
    this.points.value = [];
  }

  placed(t: number): PlacedPoint[] {
    return this.points.value.map(({ body, triangle, local }) => ({
      body,
      triangle,
      local: local(t),
      world: place(body.motion(t), local(t)),
    }));
  }

  show(t: number): void {
    const worlds = this.placed(t).map(({ world }) => world);
    this.group.visible = worlds.length > 0;
    if (worlds.length === 0) {
      return;
    }
    const [a, b = a] = worlds as [Vector3, Vector3?];
    this.group.position.set(...a); // Relative to it, single precision is enough.
    const ends = [new V3(), new V3(b[0] - a[0], b[1] - a[1], b[2] - a[2])];
    this.line.geometry.setFromPoints(ends);
    this.dots.geometry.setFromPoints(ends);
    const material = this.line.material;
    material.dashSize = material.gapSize = Math.max(distance(a, b) / 24, 1e-12);
    this.line.computeLineDistances();
  }
}
