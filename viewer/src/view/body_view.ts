/// One body on the screen: its triangles, the edges that an eye looks for, and where it stands.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshPhongMaterial,
  Object3D,
  Quaternion,
  Vector3,
} from "three";
import type { MeshData } from "../data/page_data";
import type { Body } from "../model";
import type { Pose } from "../motion/motion";
import { edgesUpTo, featureEdges } from "./feature_edges";

/// Puts an object where a pose says; in double precision, as all of its matrices are.
export function setPose(object: Object3D, { position, rotation }: Pose): void {
  const [w, x, y, z] = rotation;
  object.matrix.compose(new Vector3(...position), new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
  object.matrixAutoUpdate = false;
  object.matrixWorldNeedsUpdate = true;
}

export class BodyView {
  readonly group = new Group();
  readonly surface: Mesh<BufferGeometry, MeshPhongMaterial>;
  private edges: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;

  get edgeGeometry(): BufferGeometry | null {
    return this.edges?.geometry ?? null;
  }

  /// @param geometry  shared by all bodies of one mesh
  constructor(
    readonly body: Body,
    geometry: BufferGeometry,
    readonly color: string,
  ) {
    const material = new MeshPhongMaterial({
      color,
      specular: 0x222222,
      shininess: 40,
      flatShading: true,
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
    this.surface = new Mesh(geometry, material);
    this.surface.position.set(...body.mesh.origin);
    this.surface.userData.body = body.index;
    this.group.name = body.name;
    this.group.add(this.surface);
    this.show(0);
  }

  show(t: number): void {
    setPose(this.group, this.body.motion(t));
    if (this.surface.morphTargetInfluences) {
      this.surface.morphTargetInfluences[0] = t;
    }
  }

  setEdges(geometry: BufferGeometry | null): void {
    if (geometry === null || this.edges !== null) {
      return;
    }
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
    material.wireframe = style.wireframe;
    material.transparent = style.xray;
    material.opacity = style.xray ? 0.28 : 1;
    material.depthWrite = !style.xray;
    material.needsUpdate = true;
    if (this.edges) {
      this.edges.visible = style.edges && !style.wireframe;
    }
  }
}

/// @param to  where every vertex of a deforming body ends, in the world
export function surfaceGeometry(mesh: MeshData, to: readonly (readonly number[])[] | null) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(mesh.positions, 3));
  geometry.setIndex(new BufferAttribute(mesh.triangles, 1));
  if (to) {
    const way = new Float32Array(mesh.positions.length);
    to.forEach((vertex, i) =>
      vertex.forEach((x, k) => {
        way[3 * i + k] = x - mesh.origin[k]! - mesh.positions[3 * i + k]!;
      }),
    );
    geometry.morphAttributes.position = [new BufferAttribute(way, 3)];
    geometry.morphTargetsRelative = true;
  }
  return geometry;
}

/// Null where there are too many triangles to look for edges.
export function edgeGeometry(mesh: MeshData, surface: BufferGeometry): BufferGeometry | null {
  if (mesh.triangles.length / 3 > edgesUpTo) {
    return null;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", surface.getAttribute("position"));
  geometry.setIndex(new BufferAttribute(featureEdges(mesh), 1));
  return geometry;
}
