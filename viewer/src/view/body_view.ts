/// One body on the screen: its pieces, and where they stand.

import { Group } from "three";
import type { Body, BodyGeometry } from "../model";
import type { Pose } from "../motion/motion";
import type { DrawnShapes } from "./drawn_shape";
import { deform, GeometryView, setPose, type Style } from "./geometry_view";

export class BodyView {
  readonly group = new Group();
  /// What was tested, and what the body looks like where that differs.
  readonly geometries: readonly GeometryView[];
  readonly looks: readonly GeometryView[];

  constructor(
    readonly body: Body,
    shapes: DrawnShapes,
    readonly color: string,
  ) {
    const view = (shape: BodyGeometry): GeometryView =>
      new GeometryView(shape, shapes.of(shape), color, body.index);
    this.geometries = body.geometries.map(view);
    this.looks = (body.looks ?? []).map(view);
    this.group.name = body.name;
    this.pieces.forEach(({ group }) => this.group.add(group));
    this.showLooks(false);
    this.show(0);
  }

  get pieces(): readonly GeometryView[] {
    return [...this.geometries, ...this.looks];
  }

  /// Those that are drawn now.
  get shownPieces(): readonly GeometryView[] {
    return this.pieces.filter(({ shown }) => shown);
  }

  show(t: number): void {
    setPose(this.group, this.body.motion(t));
    this.group.traverse((part) => deform(part, t));
  }

  /// Shows what the body looks like, or what was tested.
  showLooks(looks: boolean): void {
    const differ = this.looks.length > 0;
    this.geometries.forEach((shape) => (shape.shown = !looks || !differ));
    this.looks.forEach((look) => (look.shown = looks));
    this.pieces.forEach((piece) => piece.setOwnColor(looks));
  }

  setStyle(style: Style): void {
    this.pieces.forEach((piece) => piece.setStyle(style));
  }

  /// A faint copy of the body at another moment, or at another pose.
  ghost(t: number, opacity: number, pose: Pose = this.body.motion(t)): Group {
    const group = new Group();
    this.shownPieces.forEach((piece) => group.add(piece.ghost(t, opacity)));
    setPose(group, pose);
    return group;
  }
}
