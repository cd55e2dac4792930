/// Where bodies of a run touch, and the forces there.

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedMesh,
  LatheGeometry,
  Matrix4,
  Points,
  PointsMaterial,
  Quaternion,
  Vector2,
  Vector3,
} from "three";
import type { Vector3 as Triple } from "../data/result";
import { length, scale } from "../motion/vector";
import type { Run, RunContact, RunImpact } from "../run";
import { overlay, roundDot } from "./contact_view";
import { fadeEach, nearness } from "./fading";

const dotSize = 8; // [px]
const many = 100; // Contacts of a step; from here on their dots are small.
const typicalShare = 0.5; // Of the steps with a force: no greater is their greatest one.
export const typicalLength = 1; // An arrow of such a force, by the size of bodies.
export const greatestLength = 5;
const mostImpacts = 1000; // Drawn at a time.

/// Along z, from 0 to 1.
export function arrowGeometry(): BufferGeometry {
  const outline = [
    [0, 0],
    [0.02, 0],
    [0.02, 0.75],
    [0.07, 0.75],
    [0, 1],
  ] as const;
  return new LatheGeometry(outline.map(([x, y]) => new Vector2(x, y))).rotateX(0.5 * Math.PI);
}

/// Of which arrows have the typical length.
export function typical(values: readonly number[]): number {
  const sorted = values.filter((value) => value > 0).sort((a, b) => a - b);
  return sorted[Math.floor(typicalShare * (sorted.length - 1))] ?? 1;
}

/// The pair as a number.
const keyOf = ({ bodies: [a, b] }: RunContact): number => a * 2 ** 26 + b;

/// What is drawn of a contact or an impact.
interface Mark {
  readonly point: Triple;
  readonly arrow: Triple; ///< [m]
  readonly shown: number; ///< From 0 to 1.
}

export class ForceMarkers {
  readonly dots: Points;
  readonly arrows: InstancedMesh;
  readonly group = new Group();
  private readonly room: number; // For so many marks.
  private readonly places: BufferAttribute;
  private readonly shownDots: BufferAttribute;
  private readonly shownArrows: InstancedBufferAttribute;
  private readonly perNewton: number; // [m]
  private readonly perNewtonSecond: number; // [m]
  private step = -1;
  private contacts: readonly RunContact[] = [];
  private before: ReadonlySet<number> = new Set(); // Pairs in contact in the step before.

  /// @param middle  of what is seen: relative to it, single precision is enough
  /// @param size    [m] radius of a body, to which arrows compare
  constructor(
    private readonly run: Run,
    private readonly middle: Vector3,
    private readonly size: number,
  ) {
    const most = run.mostContacts;
    this.room = most + Math.min(run.impacts.length, mostImpacts);
    this.perNewton = (typicalLength * size) / typical(run.greatestForces);
    this.perNewtonSecond =
      (typicalLength * size) / typical(run.impacts.map(({ impulse }) => length(impulse)));
    const numbers = (each: number): Float32Array => new Float32Array(each * this.room);
    this.places = new BufferAttribute(numbers(3), 3).setUsage(DynamicDrawUsage);
    this.shownDots = new BufferAttribute(numbers(1), 1).setUsage(DynamicDrawUsage);
    this.shownArrows = new InstancedBufferAttribute(numbers(1), 1).setUsage(DynamicDrawUsage);
    this.dots = new Points(
      new BufferGeometry()
        .setAttribute("position", this.places)
        .setAttribute("shown", this.shownDots),
      fadeEach(
        new PointsMaterial({
          map: roundDot(),
          size: most < many ? dotSize : 0.5 * dotSize,
          sizeAttenuation: false,
          transparent: true,
          depthTest: false,
          depthWrite: false,
        }),
      ),
    );
    const shape = arrowGeometry().setAttribute("shown", this.shownArrows);
    this.arrows = new InstancedMesh(shape, fadeEach(overlay(0.9)), this.room);
    this.dots.renderOrder = 12;
    this.arrows.renderOrder = 11;
    for (const part of [this.dots, this.arrows]) {
      part.frustumCulled = false;
      part.raycast = () => {};
    }
    this.group.position.copy(middle);
    this.group.add(this.dots, this.arrows);
  }

  /// The contacts of the step that is under way: they fade in with it, unless their bodies were in
  /// contact before it. And the impacts nearby, each brightest at its own time.
  ///
  /// @param window  so near in t are impacts seen, if not farther for the length of the step
  show(t: number, window: number): void {
    this.enter(this.run.stepAt(t));
    const marks = [...this.contactMarks(t), ...this.impactMarks(t, window)].slice(0, this.room);
    marks.forEach(({ point, arrow, shown }, k) => {
      const place = new Vector3(...point).sub(this.middle);
      this.places.setXYZ(k, place.x, place.y, place.z);
      this.shownDots.setX(k, shown);
      this.shownArrows.setX(k, shown);
      this.arrows.setMatrixAt(k, this.arrowMatrix(place, arrow));
    });
    for (const changed of [this.places, this.shownDots, this.shownArrows]) {
      changed.needsUpdate = true;
    }
    this.dots.geometry.setDrawRange(0, marks.length);
    this.arrows.count = marks.length;
    this.arrows.instanceMatrix.needsUpdate = true;
  }

  private enter(step: number): void {
    if (step !== this.step) {
      this.step = step;
      this.contacts = this.run.contactsOf(step);
      this.before = new Set(step > 0 ? this.run.contactsOf(step - 1).map(keyOf) : []);
    }
  }

  private contactMarks(t: number): Mark[] {
    const [from, to] = this.stepTimes();
    const gone = to > from ? Math.min(Math.max((t - from) / (to - from), 0), 1) : 1;
    return this.contacts.map((contact) => ({
      point: contact.point,
      arrow: scale(this.perNewton, this.onFree(contact.bodies, contact.force)),
      shown: this.before.has(keyOf(contact)) ? 1 : gone,
    }));
  }

  private impactMarks(t: number, window: number): Mark[] {
    const [from, to] = this.stepTimes();
    const reach = Math.max(window, 0.25 * (to - from));
    const { impacts } = this.run;
    const near = impacts.slice(firstAfter(impacts, t - reach), firstAfter(impacts, t + reach));
    return near.map(({ t: time, bodies, point, impulse }) => ({
      point,
      arrow: scale(this.perNewtonSecond, this.onFree(bodies, impulse)),
      shown: nearness(t, time, reach),
    }));
  }

  private stepTimes(): [number, number] {
    const { ends } = this.run;
    return [this.step > 0 ? ends[this.step - 1]! : 0, ends[this.step]!];
  }

  /// On the second body, or on the first where nothing can move the second.
  private onFree(bodies: readonly [number, number], onSecond: Triple): Triple {
    return this.run.masses[bodies[1]]! > 0 ? onSecond : scale(-1, onSecond);
  }

  private arrowMatrix(place: Vector3, arrow: Triple): Matrix4 {
    const size = Math.min(length(arrow), greatestLength * this.size);
    const turn = new Quaternion();
    if (size > 0) {
      turn.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...arrow).normalize());
    }
    return new Matrix4().compose(place, turn, new Vector3(size, size, size));
  }
}

/// The number of the first impact after a moment.
function firstAfter(impacts: readonly RunImpact[], t: number): number {
  let [low, high] = [0, impacts.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    [low, high] = impacts[middle]!.t <= t ? [middle + 1, high] : [low, middle];
  }
  return low;
}
