/// What the person who looks has switched on.

import { Signal } from "./core/signal";

export class Display {
  readonly wireframe = new Signal(false);
  readonly xray = new Signal(false);
  readonly edges = new Signal(true);
  readonly ghosts = new Signal(false);
  readonly onion = new Signal(false);
  readonly contacts = new Signal(true);
  /// Arrows of contact forces, in runs.
  readonly forces = new Signal(true);
  /// What links look like, in place of what was tested.
  readonly looks = new Signal(false);
  /// Cuts away what stands before the point that the camera looks at.
  readonly cutaway = new Signal(false);
  readonly measure = new Signal(false);
  /// Indices of the bodies that are hidden.
  readonly hidden = new Signal<ReadonlySet<number>>(new Set());

  setVisible(body: number, visible: boolean): void {
    this.setAllVisible([body], visible);
  }

  setAllVisible(bodies: readonly number[], visible: boolean): void {
    const hidden = new Set(this.hidden.value);
    bodies.forEach((body) => (visible ? hidden.delete(body) : hidden.add(body)));
    this.hidden.value = hidden;
  }

  isVisible(body: number): boolean {
    return !this.hidden.value.has(body);
  }
}
