/// Where bodies of a run touch, and the forces there.

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
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
import type { Run, RunContact } from "../run";
import { overlay, roundDot } from "./contact_view";

const dotSize = 8; // [px]
const many = 100; // Contacts of a step; from here on their dots are small.
const typicalShare = 0.5; // Of the steps with a force: no greater is their greatest one.
const typicalLength = 1; // An arrow of such a force, by the size of bodies.
const greatestLength = 5;

/// Along z, from 0 to 1.
function arrowGeometry(): BufferGeometry {
  const outline = [
    [0, 0],
    [0.02, 0],
    [0.02, 0.75],
    [0.07, 0.75],
    [0, 1],
  ] as const;
  return new LatheGeometry(outline.map(([x, y]) => new Vector2(x, y))).rotateX(0.5 * Math.PI);
}

/// [N] Of which arrows have the typical length.
function typicalForce({ greatestForces }: Run): number {
  const sorted = greatestForces.filter((force) => force > 0).sort((a, b) => a - b);
  return sorted[Math.floor(typicalShare * (sorted.length - 1))] ?? 1;
}

export class ForceMarkers {
  readonly dots: Points;
  readonly arrows: InstancedMesh;
  readonly group = new Group();
  private readonly places: BufferAttribute;
  private readonly perNewton: number; // [m]
  private step = -1;

  /// @param middle  of what is seen: relative to it, single precision is enough
  /// @param size    [m] radius of a body, to which arrows compare
  constructor(
    private readonly run: Run,
    private readonly middle: Vector3,
    private readonly size: number,
  ) {
    const most = run.mostContacts;
    this.perNewton = (typicalLength * size) / typicalForce(run);
    this.places = new BufferAttribute(new Float32Array(3 * most), 3).setUsage(DynamicDrawUsage);
    this.dots = new Points(
      new BufferGeometry().setAttribute("position", this.places),
      new PointsMaterial({
        map: roundDot(),
        size: most < many ? dotSize : 0.5 * dotSize,
        sizeAttenuation: false,
        transparent: true,
        depthTest: false,
        depthWrite: false,
      }),
    );
    this.arrows = new InstancedMesh(arrowGeometry(), overlay(0.9), most);
    this.dots.renderOrder = 12;
    this.arrows.renderOrder = 11;
    for (const part of [this.dots, this.arrows]) {
      part.frustumCulled = false;
      part.raycast = () => {};
    }
    this.group.position.copy(middle);
    this.group.add(this.dots, this.arrows);
  }

  /// The contacts of the step that is under way.
  show(t: number): void {
    const step = this.run.stepAt(t);
    if (step === this.step) {
      return;
    }
    this.step = step;
    const contacts = this.run.contactsOf(step);
    contacts.forEach((contact, k) => {
      const place = new Vector3(...contact.point).sub(this.middle);
      this.places.setXYZ(k, place.x, place.y, place.z);
      this.arrows.setMatrixAt(k, this.arrowMatrix(place, this.shownForce(contact)));
    });
    this.places.needsUpdate = true;
    this.dots.geometry.setDrawRange(0, contacts.length);
    this.arrows.count = contacts.length;
    this.arrows.instanceMatrix.needsUpdate = true;
  }

  /// On the second body, or on the first where nothing can move the second.
  private shownForce({ bodies, force }: RunContact): Triple {
    return this.run.masses[bodies[1]]! > 0 ? force : scale(-1, force);
  }

  private arrowMatrix(place: Vector3, force: Triple): Matrix4 {
    const size = Math.min(this.perNewton * length(force), greatestLength * this.size);
    const turn = new Quaternion();
    if (size > 0) {
      turn.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...force).normalize());
    }
    return new Matrix4().compose(place, turn, new Vector3(size, size, size));
  }
}
