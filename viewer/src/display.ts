/// The parts of the picture that the user has switched on.

import { Signal } from "./core/signal";

/// A plane that cuts: geometry in front of it is not drawn.
export interface Cut {
  readonly along: "view" | "x" | "y" | "z";
  /// How far along, from 0 to 1. Of the view, 0.5 is at the point that the camera looks at.
  readonly share: number;
  /// True if the geometry behind the plane is not drawn, in place of that in front.
  readonly otherSide: boolean;
  /// True if the page made the cut for a hidden contact. Then the page also removes it.
  readonly byItself: boolean;
}

export class Display {
  readonly wireframe = new Signal(false);
  readonly xray = new Signal(false);
  readonly edges = new Signal(true);
  readonly ghosts = new Signal(false);
  readonly onion = new Signal(false);
  readonly contacts = new Signal(true);
  /// Arrows of contact forces, in runs.
  readonly forces = new Signal(true);
  /// Ghosts of tools where haptic devices lead them.
  readonly devices = new Signal(true);
  /// Shows the visual geometry of links in place of the tested geometry.
  readonly looks = new Signal(false);
  /// Where bodies are cut; null where they are whole.
  readonly cut = new Signal<Cut | null>(null);
  readonly measure = new Signal(false);
  /// The line of a planned path.
  readonly path = new Signal(true);
  /// The trees of a search.
  readonly trees = new Signal(false);
  /// Indices of the bodies that are hidden.
  readonly hidden = new Signal<ReadonlySet<number>>(new Set());
  /// By index of a body, from 0 to 1; 1 of those that are not named.
  readonly opacities = new Signal<ReadonlyMap<number, number>>(new Map());

  setVisible(body: number, visible: boolean): void {
    this.setAllVisible([body], visible);
  }

  setAllVisible(bodies: readonly number[], visible: boolean): void {
    const hidden = new Set(this.hidden.value);
    bodies.forEach((body) => (visible ? hidden.delete(body) : hidden.add(body)));
    this.hidden.value = hidden;
  }

  setOpacity(bodies: readonly number[], opacity: number): void {
    this.opacities.value = new Map([
      ...this.opacities.value,
      ...bodies.map((body) => [body, opacity] as const),
    ]);
  }

  opacityOf(body: number): number {
    return this.opacities.value.get(body) ?? 1;
  }

  /// Cuts away the geometry in front of the point that the camera looks at, or removes the cut.
  toggleCut(): void {
    const first: Cut = { along: "view", share: 0.5, otherSide: false, byItself: false };
    this.cut.value = this.cut.value ? null : first;
  }

  /// Ends a cut that came with a contact; one that was asked for stays.
  endOwnCut(): void {
    if (this.cut.value?.byItself) {
      this.cut.value = null;
    }
  }

  isVisible(body: number): boolean {
    return !this.hidden.value.has(body);
  }
}
