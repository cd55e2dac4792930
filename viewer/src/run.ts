/// The steps of a run, with the contacts, impacts and ties of each step.

import type { Vector3 } from "./data/result";
import type { RunContactsData, RunData, StepData } from "./data/run_data";
import { scale } from "./motion/vector";
import { firstNotLess } from "./motion/way";

/// An impact at its moment.
export interface RunImpact {
  readonly t: number;
  readonly bodies: readonly [number, number];
  readonly point: Vector3;
  readonly impulse: Vector3; ///< [N s] On the second body.
}

export interface RunContact {
  readonly bodies: readonly [number, number];
  readonly point: Vector3;
  /// [N] On the second body, the mean over the step.
  readonly force: Vector3;
  readonly distance: number; ///< [m]
}

const rounding = 1e-12; // Of a quotient of whole steps.
const near = 1e-9; // In t: a moment this close to the end of a step is its end.

export class Run {
  readonly steps: readonly StepData[];
  readonly masses: readonly number[];
  readonly gravity: Vector3; ///< [m/s²]
  /// [s] That was asked for; more than the last step's time where the run was stopped.
  readonly asked: number;
  /// t at the end of each step.
  readonly ends: Float64Array;
  /// [N] The greatest contact force of each step.
  readonly greatestForces: readonly number[];
  /// Whether forces moved the bodies: a haptic tool has neither energies nor impulses.
  readonly hasDynamics: boolean;
  /// Bodies without the geometries of links, which are behind them.
  readonly linksFrom: number;
  /// The name of a step's events. For a haptic tool they are the rounds of its contact loop.
  readonly eventName: "Impacts" | "Rounds";
  /// [W] Of all motors together in each step, negative where they brake; none without motors.
  readonly motorPowers: readonly number[] | null;

  /// All of them, in the order of time.
  readonly impacts: readonly RunImpact[];

  private readonly all: RunContactsData;
  private readonly askedSteps: number;

  constructor({ header, linksFrom, steps, contacts }: RunData) {
    const { gravity, duration, step } = header.scene.simulation;
    this.linksFrom = linksFrom;
    this.steps = steps;
    this.masses = header.masses;
    this.gravity = gravity;
    this.asked = duration;
    this.askedSteps = Math.ceil((duration / step) * (1 - rounding));
    this.all = contacts;
    this.ends = Float64Array.from(steps, ({ time }) => time / this.duration);
    this.greatestForces = steps.map((_, step) => this.greatestForce(step));
    this.hasDynamics = header.kind !== "haptics";
    this.eventName = this.hasDynamics ? "Impacts" : "Rounds";
    this.impacts = steps.flatMap((_, step) => this.impactsIn(step)).sort((a, b) => a.t - b.t);
    const hasMotors = steps.some(({ robots }) =>
      robots?.some(({ efforts }) => efforts.some(Boolean)),
    );
    this.motorPowers = hasMotors ? steps.map((_, step) => this.motorPower(step)) : null;
  }

  get duration(): number {
    return this.steps.at(-1)!.time;
  }

  /// t of the first impact, or of the end of the first step with a contact if that is earlier.
  get firstTouch(): number | null {
    const step = this.steps.findIndex((_, k) => this.contactCount(k) > 0);
    const times = [
      ...this.impacts.slice(0, 1).map(({ t }) => t),
      ...(step < 0 ? [] : [this.ends[step]!]),
    ];
    return times.length > 0 ? Math.min(...times) : null;
  }

  /// Whether it has all steps that were asked for. Steps that lost time count, too; cycles of a
  /// haptic session last as long as they lasted.
  get isWhole(): boolean {
    return this.hasDynamics
      ? this.steps.length >= this.askedSteps
      : this.duration > this.asked * (1 - 1e-9);
  }

  /// Geometries of links.
  get linkCount(): number {
    return this.masses.length - this.linksFrom;
  }

  get freeCount(): number {
    return this.masses.slice(0, this.linksFrom).filter((mass) => mass > 0).length;
  }

  /// The number, from 0, of the step that is under way or just ends.
  stepAt(t: number): number {
    return Math.min(firstNotLess(this.ends, t - near), this.steps.length - 1);
  }

  /// The next end of a step, or the one before.
  neighbour(t: number, direction: 1 | -1): number {
    const next = firstNotLess(this.ends, direction > 0 ? t + near : t - near);
    return direction > 0 ? (this.ends[next] ?? 1) : (this.ends[next - 1] ?? 0);
  }

  /// In t: as far as asked, but a tenth of the step that is under way at most.
  fineStep(t: number, most: number): number {
    const { lasted } = this.steps[this.stepAt(t)]!;
    return lasted > 0 ? Math.min(most, (0.1 * lasted) / this.duration) : most;
  }

  contactCount(step: number): number {
    return this.all.until[step]! - this.firstContact(step);
  }

  get mostContacts(): number {
    return this.steps.reduce((most, _, step) => Math.max(most, this.contactCount(step)), 0);
  }

  contactsOf(step: number): RunContact[] {
    const { bodies, points, impulses, distances } = this.all;
    const { lasted } = this.steps[step]!;
    const row = (numbers: ArrayLike<number>, k: number): Vector3 => [
      numbers[3 * k]!,
      numbers[3 * k + 1]!,
      numbers[3 * k + 2]!,
    ];
    const first = this.firstContact(step);
    return Array.from({ length: this.contactCount(step) }, (_, i) => first + i).map((k) => ({
      bodies: [bodies[2 * k]!, bodies[2 * k + 1]!],
      point: row(points, k),
      force: scale(lasted > 0 ? 1 / lasted : 0, row(impulses, k)),
      distance: distances[k]!,
    }));
  }

  impactsIn(step: number): RunImpact[] {
    const { time, lasted, impacts = [] } = this.steps[step]!;
    const begin = time - lasted;
    return impacts.map(({ at, bodies, point, impulse }) => ({
      t: Math.min((begin + at) / this.duration, 1),
      bodies,
      point,
      impulse,
    }));
  }

  private greatestForce(step: number): number {
    const { impulses, until } = this.all;
    let most = 0; // [(N s)²]
    for (let k = 3 * this.firstContact(step); k < 3 * until[step]!; k += 3) {
      const [x, y, z] = [impulses[k]!, impulses[k + 1]!, impulses[k + 2]!];
      most = Math.max(most, x * x + y * y + z * z);
    }
    const { lasted } = this.steps[step]!;
    return lasted > 0 ? Math.sqrt(most) / lasted : 0;
  }

  /// [W]  The efforts, means over the step, times the mean of the velocities at its ends.
  private motorPower(step: number): number {
    const before = this.steps[step - 1]?.robots;
    let power = 0;
    this.steps[step]!.robots?.forEach(({ velocities, efforts }, robot) => {
      efforts.forEach((effort, k) => {
        const v = velocities[k]!;
        power += 0.5 * effort * (v + (before?.[robot]?.velocities[k] ?? v));
      });
    });
    return power;
  }

  private firstContact(step: number): number {
    return step > 0 ? this.all.until[step - 1]! : 0;
  }
}
