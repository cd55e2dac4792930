/// One body on the screen: its pieces, and where they stand.

import { Group } from "three";
import type { Body, Part } from "../model";
import type { DrawnShapes } from "./drawn_shape";
import { deform, PartView, setPose, type Style } from "./part_view";

export class BodyView {
  readonly group = new Group();
  /// What was tested, and what the body looks like where that differs.
  readonly parts: readonly PartView[];
  readonly looks: readonly PartView[];

  constructor(
    readonly body: Body,
    shapes: DrawnShapes,
    readonly color: string,
  ) {
    const view = (part: Part): PartView => new PartView(part, shapes.of(part), color, body.index);
    this.parts = body.parts.map(view);
    this.looks = (body.looks ?? []).map(view);
    this.group.name = body.name;
    this.pieces.forEach(({ group }) => this.group.add(group));
    this.showLooks(false);
    this.show(0);
  }

  get pieces(): readonly PartView[] {
    return [...this.parts, ...this.looks];
  }

  /// Those that are drawn now.
  get shownPieces(): readonly PartView[] {
    return this.pieces.filter(({ shown }) => shown);
  }

  show(t: number): void {
    setPose(this.group, this.body.motion(t));
    this.group.traverse((part) => deform(part, t));
  }

  /// Shows what the body looks like, or what was tested.
  showLooks(looks: boolean): void {
    const differ = this.looks.length > 0;
    this.parts.forEach((part) => (part.shown = !looks || !differ));
    this.looks.forEach((look) => (look.shown = looks));
    this.pieces.forEach((piece) => piece.setOwnColor(looks));
  }

  setStyle(style: Style): void {
    this.pieces.forEach((piece) => piece.setStyle(style));
  }

  /// A faint copy of the body at another moment.
  ghost(t: number, opacity: number): Group {
    const group = new Group();
    this.shownPieces.forEach((piece) => group.add(piece.ghost(t, opacity)));
    setPose(group, this.body.motion(t));
    return group;
  }
}
