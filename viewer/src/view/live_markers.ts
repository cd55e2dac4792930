/// The contacts of a live session, and the force on the hand.

import {
  ArrowHelper,
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  type LineBasicMaterial,
  type MeshBasicMaterial,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import type { Picture } from "../live";
import { roundDot } from "./contact_view";

const dotSize = 8; // [px]
const perSize = 0.5; // Of an arrow of a newton, in radii of the tool.
const mostLength = 3; // In radii of the tool.
const color = 0xd9480f;

export class LiveMarkers {
  readonly group = new Group();
  private readonly dots = new Points(
    new BufferGeometry(),
    new PointsMaterial({
      map: roundDot(),
      size: dotSize,
      sizeAttenuation: false,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    }),
  );
  private readonly arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, color);

  /// @param size  [m] radius of the tool
  constructor(private readonly size: number) {
    this.dots.frustumCulled = false;
    this.dots.raycast = () => {};
    this.dots.renderOrder = 12;
    this.group.add(this.dots, this.arrow);
    this.arrow.visible = false;
    this.arrow.traverse((part) => {
      part.renderOrder = 11;
      part.raycast = () => {};
    });
    for (const part of [this.arrow.line, this.arrow.cone]) {
      const material = part.material as LineBasicMaterial | MeshBasicMaterial;
      material.depthTest = false; // It may begin inside the tool.
      material.transparent = true; // Drawn behind what is solid.
    }
  }

  show({ contacts, force, target: [x, y, z] }: Picture): void {
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry().setAttribute(
      "position",
      new Float32BufferAttribute(contacts.flat(), 3),
    );
    const strength = Math.hypot(...force);
    this.arrow.visible = strength > 0;
    if (strength > 0) {
      this.arrow.position.set(x!, y!, z!);
      this.arrow.setDirection(new Vector3(...force).divideScalar(strength));
      this.arrow.setLength(this.size * Math.min(perSize * strength, mostLength));
    }
  }
}
