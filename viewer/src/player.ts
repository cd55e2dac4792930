/// The clock: which moment is shown, and how it runs.

import { Signal } from "./core/signal";
import { TimeWindow } from "./time_window";

/// Seconds of the scene for each second of the person who looks.
export const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10] as const;

const comfortable = 6; // [s] in which a step is watched

export class Player {
  readonly t: Signal<number>;
  readonly playing = new Signal(false);
  readonly speed: Signal<number>;
  readonly loop = new Signal(false);
  /// The part of the time that charts show; it follows t.
  readonly window = new TimeWindow();

  /// @param duration   [s] of the scene
  /// @param contact    t of the first contact, where there is one: playing pauses there
  constructor(
    readonly duration: number,
    readonly contact: number | null,
    t = 0,
  ) {
    this.t = new Signal(clamp(t));
    this.t.subscribe((moment) => this.window.include(moment));
    this.speed = new Signal<number>(
      speeds.reduce((best, speed) =>
        misfit(speed, duration) < misfit(best, duration) ? speed : best,
      ),
    );
  }

  /// Shows a moment and stays there.
  seek(t: number): void {
    this.playing.value = false;
    this.t.value = clamp(t);
  }

  step(by: number): void {
    this.seek(this.t.value + by);
  }

  toContact(): void {
    if (this.contact !== null) {
      this.seek(this.contact);
    }
  }

  toggle(): void {
    if (!this.playing.value && this.t.value >= 1) {
      this.t.value = 0;
    }
    this.playing.value = !this.playing.value;
  }

  /// @param seconds  that went by since the last call
  advance(seconds: number): void {
    if (!this.playing.value) {
      return;
    }
    const before = this.t.value;
    const after = before + (seconds * this.speed.value) / this.duration;
    if (this.contact !== null && before < this.contact && after >= this.contact) {
      this.seek(this.contact);
    } else if (after >= 1 && this.loop.value) {
      this.t.value = 0;
    } else if (after >= 1) {
      this.seek(1);
    } else {
      this.t.value = after;
    }
  }
}

const clamp = (t: number): number => Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), 1);

/// How far a speed is from a comfortable one, by ratio.
const misfit = (speed: number, duration: number): number =>
  Math.abs(Math.log(duration / speed / comfortable));
