/// Springs as coils, cables as lines, joints as balls. The more a tie bears, the redder it is.

import {
  Color,
  Curve,
  CylinderGeometry,
  Group,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  TubeGeometry,
  Vector3,
  type BufferGeometry,
} from "three";
import { distance } from "../motion/vector";
import type { Run } from "../run";
import type { Tie } from "../ties";
import { contactColor } from "./colors";

const coils = 8;
const springHeight = 12; // In its radii; others are stretched.
const thickness = 0.03; // Of a cable, by the size of bodies.
const coilRadius = 0.1; // Of a spring; likewise.
const ballRadius = 0.07; // Of a joint; likewise.
const axisLength = 0.3; // Of a hinge; likewise.
const unloaded = new Color("#8d99a6");
const loaded = new Color(contactColor);
const slackShare = 0.999; // Of the length of a cable: a shorter one hangs loose.
const z = new Vector3(0, 0, 1);

/// A helix about z, of radius 1.
class Helix extends Curve<Vector3> {
  constructor() {
    super(); // Which is protected there.
  }

  override getPoint(share: number): Vector3 {
    const angle = 2 * Math.PI * coils * share;
    const radius = Math.min(1, 12 * share, 12 * (1 - share)); // Its ends are on the axis.
    return new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), springHeight * share);
  }
}

/// Along z from 0 to 1, of radius 1.
const rod = (): BufferGeometry =>
  new CylinderGeometry(1, 1, 1, 8, 1).rotateX(0.5 * Math.PI).translate(0, 0, 0.5);

class TieView {
  readonly group = new Group();
  private readonly material = new MeshStandardMaterial({ roughness: 0.6 });
  private readonly line: Mesh | null;
  private readonly ball: Mesh | null;
  private readonly most: number; // [N]

  constructor(
    private readonly tie: Tie,
    private readonly middle: Vector3,
    private readonly size: number,
    shapes: TieShapes,
  ) {
    const isLine = tie.type === "spring" || tie.type === "cable";
    const isHinge = tie.type === "hinge";
    this.line =
      isLine || isHinge ? new Mesh(tie.type === "spring" ? shapes.coil : shapes.rod) : null;
    this.ball = isLine ? null : new Mesh(shapes.ball);
    this.ball?.scale.setScalar(ballRadius * size);
    this.most = tie.forces.reduce((most, force) => Math.max(most, force), 0);
    for (const part of [this.line, this.ball]) {
      if (part) {
        part.material = this.material;
        part.raycast = () => {};
        part.frustumCulled = false;
        this.group.add(part);
      }
    }
  }

  show(t: number, step: number): void {
    const [a, b] = this.tie.ends(t);
    const share = this.most > 0 ? this.tie.forces[step]! / this.most : 0;
    this.material.color.lerpColors(unloaded, loaded, share);
    this.ball?.position.set(...a).sub(this.middle);
    const { axis, type, length } = this.tie;
    if (axis) {
      const half = new Vector3(...axis(t)).multiplyScalar(0.5 * axisLength * this.size);
      const at = new Vector3(...a);
      this.layLine(at.clone().sub(half), at.add(half), 0.6 * thickness);
    } else if (this.line) {
      const isSlack = type === "cable" && distance(a, b) < slackShare * length;
      this.material.transparent = isSlack;
      this.material.opacity = isSlack ? 0.35 : 1;
      const radius = type === "spring" ? coilRadius : thickness;
      this.layLine(new Vector3(...a), new Vector3(...b), radius);
    }
  }

  private layLine(from: Vector3, to: Vector3, radius: number): void {
    const along = to.clone().sub(from);
    const line = this.line!;
    line.position.copy(from).sub(this.middle);
    line.quaternion.copy(
      along.lengthSq() > 0
        ? new Quaternion().setFromUnitVectors(z, along.clone().normalize())
        : new Quaternion(),
    );
    line.scale.set(radius * this.size, radius * this.size, Math.max(along.length(), 1e-9));
  }
}

/// Shared by all ties.
interface TieShapes {
  readonly coil: BufferGeometry;
  readonly rod: BufferGeometry;
  readonly ball: BufferGeometry;
}

export class TieMarkers {
  readonly group = new Group();
  private readonly views: readonly TieView[];

  /// @param middle  of what is seen: relative to it, single precision is enough
  /// @param size    [m] radius of a body, to which ties compare
  constructor(
    private readonly run: Run,
    ties: readonly Tie[],
    middle: Vector3,
    size: number,
  ) {
    const shapes = {
      coil: new TubeGeometry(new Helix(), 24 * coils, 0.2, 6).scale(1, 1, 1 / springHeight),
      rod: rod(),
      ball: new SphereGeometry(1, 16, 12),
    };
    this.views = ties.map((tie) => new TieView(tie, middle, size, shapes));
    this.group.position.copy(middle);
    this.views.forEach(({ group }) => this.group.add(group));
    this.show(0);
  }

  show(t: number): void {
    const step = this.run.stepAt(t);
    this.views.forEach((view) => view.show(t, step));
  }
}
