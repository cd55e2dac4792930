/// The stretch of time that charts and the slider show: all of it, or a part that is looked at.

import { Signal } from "./core/signal";

/// In t, from 0 to 1.
export interface Stretch {
  readonly from: number;
  readonly to: number;
}

const least = 1e-6; // In t.
const margin = 0.1; // Of the stretch: so far inside is a moment that comes into it.

export class TimeWindow {
  readonly shown = new Signal<Stretch>({ from: 0, to: 1 });

  get isWhole(): boolean {
    const { from, to } = this.shown.value;
    return from === 0 && to === 1;
  }

  /// Where in the window a moment is: from 0 to 1, if it is inside.
  shareOf(t: number): number {
    const { from, to } = this.shown.value;
    return (t - from) / (to - from);
  }

  /// The moment at a share of the window.
  at(share: number): number {
    const { from, to } = this.shown.value;
    return from + share * (to - from);
  }

  /// @param t       stays where it is in the window
  /// @param factor  by which the window gets shorter
  zoom(t: number, factor: number): void {
    const { from, to } = this.shown.value;
    const size = Math.min(Math.max((to - from) / factor, least), 1);
    this.place(t - this.shareOf(t) * size, size);
  }

  /// @param share  of the window, later where it is positive
  move(share: number): void {
    const { from, to } = this.shown.value;
    this.place(from + share * (to - from), to - from);
  }

  showAll(): void {
    this.place(0, 1);
  }

  /// Moves on where a moment is outside.
  include(t: number): void {
    const { from, to } = this.shown.value;
    const size = to - from;
    if (t < from || t > to) {
      this.place(t < from ? t - (1 - margin) * size : t - margin * size, size);
    }
  }

  private place(from: number, size: number): void {
    const begin = Math.min(Math.max(from, 0), 1 - size);
    this.shown.value = { from: begin, to: size === 1 ? 1 : begin + size };
  }
}
