/// The contacts of a live session, where devices lead the tools, and the forces on the hands.

import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  Mesh,
  Points,
  PointsMaterial,
  Quaternion,
  Vector3,
} from "three";
import type { Vector3 as Triple } from "../data/result";
import { poseFrom, poseIn, type Picture } from "../live";
import { place } from "../motion/motion";
import { length } from "../motion/vector";
import type { BodyView } from "./body_view";
import { overlay, roundDot } from "./contact_view";
import { ghostOfHand } from "./device_view";
import { arrowGeometry } from "./force_view";
import { dispose, setPose } from "./geometry_view";

const dotSize = 8; // [px]
const perSize = 0.3; // Of an arrow of a newton, in radii of the tool.
const mostLength = 2; // In radii of the tool.

/// A tool that is drawn with its device.
export interface MarkedTool {
  readonly view: BodyView;
  readonly links: readonly BodyView[];
  readonly centre: Triple; ///< In the frame of the tool: the force acts there.
  readonly size: number; ///< [m] Radius of the tool.
}

export class LiveMarkers {
  readonly group = new Group();
  readonly ghosts = new Group();
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
  private readonly arrows: readonly Mesh[];

  constructor(private readonly tools: readonly MarkedTool[]) {
    this.dots.frustumCulled = false;
    this.dots.raycast = () => {};
    this.dots.renderOrder = 12;
    this.arrows = tools.map(() => {
      const arrow = new Mesh(arrowGeometry(), overlay(0.9));
      arrow.renderOrder = 11;
      arrow.raycast = () => {};
      arrow.visible = false;
      return arrow;
    });
    this.group.add(this.dots, ...this.arrows, this.ghosts);
    this.makeGhosts();
  }

  /// Makes the ghosts anew, as their bodies look now.
  makeGhosts(): void {
    dispose(this.ghosts);
    this.ghosts.add(...this.tools.map(({ view, links }) => ghostOfHand([view, ...links])));
  }

  show(picture: Picture): void {
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry().setAttribute(
      "position",
      new Float32BufferAttribute(picture.contacts.flat(), 3),
    );
    this.tools.forEach((tool, k) => {
      const { view, centre, size } = tool;
      const { target, force, links } = picture.tools[k]!;
      const ghost = this.ghosts.children[k]!;
      setPose(ghost.children[0]!, poseFrom(target));
      for (const [body, ...pose] of links) {
        const at = tool.links.findIndex((link) => link.body.index === body);
        setPose(ghost.children[at + 1]!, poseFrom(pose));
      }
      const pose = poseIn(picture, view.body.index);
      const strength = length(force);
      const arrow = this.arrows[k]!;
      arrow.visible = pose !== null && strength > 0;
      if (arrow.visible) {
        arrow.position.set(...place(pose!, centre));
        const along = new Vector3(...force).divideScalar(strength);
        arrow.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), along));
        arrow.scale.setScalar(size * Math.min(perSize * strength, mostLength));
      }
    });
  }
}
