/// One body on the screen: its surface, the edges that an eye looks for, and where it stands.

import {
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Material,
  Mesh,
  MeshBasicMaterial,
  MeshPhongMaterial,
  Object3D,
  Points,
  PointsMaterial,
  Quaternion,
  Vector3,
} from "three";
import type { Body } from "../model";
import type { Pose } from "../motion/motion";
import { radiusOf, type DrawnShape } from "./drawn_shape";

const pointSize = 2.5; // [px] Of points without a radius.

/// [deg] Of every camera. Sizes of points on the screen depend on it.
export const fieldOfView = 32;
const pointScale = 1 / Math.tan((0.5 * fieldOfView * Math.PI) / 180);

/// Puts an object where a pose says; in double precision, as all of its matrices are.
function setPose(object: Object3D, { position, rotation }: Pose): void {
  const [w, x, y, z] = rotation;
  object.matrix.compose(new Vector3(...position), new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
  object.matrixAutoUpdate = false;
  object.matrixWorldNeedsUpdate = true;
}

function surfaceMaterial(color: string, flatShading: boolean): MeshPhongMaterial {
  const material = new MeshPhongMaterial({
    color,
    specular: 0x222222,
    shininess: 40,
    flatShading,
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  // The back of a triangle is darker, so that what is cut open can be told from what is not.
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <color_fragment>",
      "#include <color_fragment>\n  if (!gl_FrontFacing) diffuseColor.rgb *= 0.6;",
    );
  };
  return material;
}

function pointMaterial(color: string, radius: number): PointsMaterial {
  const thick = radius > 0;
  const material = new PointsMaterial({
    color,
    size: thick ? 2 * radius * pointScale : pointSize,
    sizeAttenuation: thick,
  });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <color_fragment>",
      "#include <color_fragment>\n  if (length(gl_PointCoord - 0.5) > 0.5) discard;",
    );
  };
  return material;
}

export class BodyView {
  readonly group = new Group();
  readonly surface:
    Mesh<BufferGeometry, MeshPhongMaterial> | Points<BufferGeometry, PointsMaterial>;
  private edges: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;

  constructor(
    readonly body: Body,
    readonly drawn: DrawnShape,
    readonly color: string,
  ) {
    const { geometry, kind, origin } = drawn;
    this.surface =
      kind === "points"
        ? new Points(geometry, pointMaterial(color, radiusOf(body)))
        : new Mesh(geometry, surfaceMaterial(color, kind === "triangles"));
    this.surface.position.set(...origin);
    this.surface.userData.body = body.index;
    this.group.name = body.name;
    this.group.add(this.surface);
    this.show(0);
  }

  show(t: number): void {
    setPose(this.group, this.body.motion(t));
    this.group.traverse((part) => deform(part, t));
  }

  /// The edges take a while to find: they come after the first picture.
  setEdges(geometry: BufferGeometry): void {
    const color = new Color(this.color).multiplyScalar(0.32);
    this.edges = new LineSegments(
      geometry,
      new LineBasicMaterial({ color, transparent: true, opacity: 0.75 }),
    );
    this.edges.position.copy(this.surface.position);
    this.group.add(this.edges);
  }

  setStyle(style: { wireframe: boolean; xray: boolean; edges: boolean }): void {
    const { material } = this.surface;
    if (material instanceof MeshPhongMaterial) {
      material.wireframe = style.wireframe;
    }
    material.transparent = style.xray;
    material.opacity = style.xray ? 0.28 : 1;
    material.depthWrite = !style.xray;
    material.needsUpdate = true;
    if (this.edges) {
      this.edges.visible = style.edges && !style.wireframe;
    }
  }

  /// A faint copy of the body at another moment. It cannot be clicked.
  ghost(t: number, opacity: number): Group {
    const look = { color: this.color, transparent: true, opacity, depthWrite: false } as const;
    const { geometry } = this.surface;
    const parts: Object3D[] =
      this.surface instanceof Points
        ? [
            new Points(
              geometry,
              Object.assign(this.surface.material.clone(), look, { color: new Color(this.color) }),
            ),
          ]
        : [new Mesh(geometry, new MeshBasicMaterial({ ...look, side: DoubleSide }))];
    if (this.edges) {
      const lines = new LineBasicMaterial({ ...look, opacity: 2 * opacity });
      parts.push(new LineSegments(this.edges.geometry, lines));
    }
    const group = new Group();
    for (const part of parts) {
      part.position.copy(this.surface.position);
      part.raycast = () => {};
      deform(part, t);
      group.add(part);
    }
    setPose(group, this.body.motion(t));
    return group;
  }
}

/// Frees what ghosts made for themselves; their geometry is shared.
export function dispose(group: Group): void {
  group.traverse((part) => {
    if ("material" in part) {
      (part.material as Material).dispose();
    }
  });
  group.clear();
}

/// Moves the vertices of a deforming body.
function deform(part: Object3D, t: number): void {
  if (
    (part instanceof Mesh || part instanceof LineSegments) &&
    part.morphTargetInfluences?.length
  ) {
    part.morphTargetInfluences[0] = t;
  }
}
