/// One piece of a body on the screen: its surface, and the edges that an eye looks for.

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
  type Plane,
  Points,
  PointsMaterial,
  Quaternion,
  Vector3,
} from "three";
import type { BodyGeometry } from "../model";
import type { Pose } from "../motion/motion";
import type { DrawnShape } from "./drawn_shape";

const pointSize = 2.5; // [px] Of points without a radius.

/// [deg] Of every camera. Sizes of points on the screen depend on it.
export const fieldOfView = 32;
const pointScale = 1 / Math.tan((0.5 * fieldOfView * Math.PI) / 180);

export interface Style {
  readonly wireframe: boolean;
  readonly xray: boolean;
  readonly edges: boolean;
  readonly opacity: number; ///< From 0 to 1.
  readonly cut: Plane[]; ///< What is before one of them is not drawn.
}

const xrayOpacity = 0.28;
const edgeOpacity = 0.75;

export type Surface =
  Mesh<BufferGeometry, MeshPhongMaterial> | Points<BufferGeometry, PointsMaterial>;

/// Puts an object where a pose says; in double precision, as all of its matrices are.
export function setPose(object: Object3D, { position, rotation }: Pose): void {
  const [w, x, y, z] = rotation;
  object.matrix.compose(new Vector3(...position), new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
  object.matrixAutoUpdate = false;
  object.matrixWorldNeedsUpdate = true;
}

/// Moves the vertices of what deforms.
export function deform(part: Object3D, t: number): void {
  if (
    (part instanceof Mesh || part instanceof LineSegments) &&
    part.morphTargetInfluences?.length
  ) {
    part.morphTargetInfluences[0] = t;
  }
}

const edgeColor = (color: string): Color => new Color(color).multiplyScalar(0.32);

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

export class GeometryView {
  readonly group = new Group();
  readonly surface: Surface;
  private edges: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;
  private shownColor: string;
  private style: Style = {
    wireframe: false,
    xray: false,
    edges: true,
    opacity: 1,
    cut: [],
  };

  /// @param body  index of the body, for whoever finds the surface
  constructor(
    readonly shape: BodyGeometry,
    readonly drawn: DrawnShape,
    private readonly color: string,
    body: number,
  ) {
    const { geometry, kind, origin } = drawn;
    this.surface =
      kind === "points"
        ? new Points(geometry, pointMaterial(color, shape.radius))
        : new Mesh(geometry, surfaceMaterial(color, kind === "triangles"));
    this.surface.position.set(...origin);
    this.surface.userData = { body, shape };
    this.shownColor = color;
    setPose(this.group, shape.pose);
    this.group.add(this.surface);
  }

  get drawnColor(): string {
    return this.shownColor;
  }

  get shown(): boolean {
    return this.surface.visible;
  }

  /// Shows or hides the piece, but not what was put beside it.
  set shown(shown: boolean) {
    this.surface.visible = shown;
    this.restyle();
  }

  get hasEdges(): boolean {
    return this.edges !== null;
  }

  /// The edges take a while to find: they come after the first picture.
  setEdges(geometry: BufferGeometry): void {
    const color = edgeColor(this.shownColor);
    this.edges = new LineSegments(
      geometry,
      new LineBasicMaterial({ color, transparent: true, opacity: edgeOpacity }),
    );
    this.edges.position.copy(this.surface.position);
    this.group.add(this.edges);
    this.restyle();
  }

  /// The colour that the piece looks like, if it has one, or that of its body.
  setOwnColor(own: boolean): void {
    this.shownColor = (own ? this.shape.color : null) ?? this.color;
    this.surface.material.color.set(this.shownColor);
    this.edges?.material.color.copy(edgeColor(this.shownColor));
  }

  setStyle(style: Style): void {
    this.style = style;
    this.restyle();
  }

  private restyle(): void {
    const { wireframe, xray, edges, opacity, cut } = this.style;
    const seen = opacity * (xray ? xrayOpacity : 1);
    const { material } = this.surface;
    if (material instanceof MeshPhongMaterial) {
      material.wireframe = wireframe;
    }
    material.transparent = seen < 1;
    material.opacity = seen;
    material.depthWrite = seen === 1;
    material.clippingPlanes = cut;
    material.needsUpdate = true;
    if (this.edges) {
      this.edges.material.opacity = edgeOpacity * opacity;
      this.edges.material.clippingPlanes = cut;
      this.edges.visible = this.surface.visible && edges && !wireframe;
    }
  }

  /// A faint copy of the piece. It cannot be clicked.
  ghost(t: number, opacity: number): Group {
    const look = {
      color: this.shownColor,
      transparent: true,
      opacity,
      depthWrite: false,
      clippingPlanes: this.style.cut,
    };
    const { geometry } = this.surface;
    const copies: Object3D[] =
      this.surface instanceof Points
        ? [
            new Points(
              geometry,
              Object.assign(this.surface.material.clone(), look, {
                color: new Color(this.shownColor),
              }),
            ),
          ]
        : [new Mesh(geometry, new MeshBasicMaterial({ ...look, side: DoubleSide }))];
    if (this.edges) {
      const lines = new LineBasicMaterial({ ...look, opacity: 2 * opacity });
      copies.push(new LineSegments(this.edges.geometry, lines));
    }
    const group = new Group();
    for (const copy of copies) {
      copy.position.copy(this.surface.position);
      copy.raycast = () => {};
      deform(copy, t);
      group.add(copy);
    }
    setPose(group, this.shape.pose);
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
