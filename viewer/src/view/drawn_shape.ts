/// What is drawn of a geometry: its triangles, or what these only stand for.

import {
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { MeshData } from "../data/page_data";
import type { BodyGeometry } from "../model";
import { sharpAngle } from "./feature_edges";
import { thickHull } from "./thick_hull";

export interface DrawnShape {
  readonly geometry: BufferGeometry;
  readonly origin: readonly [number, number, number];
  readonly kind: "triangles" | "smooth" | "points";
}

/// The corners of a mesh that is one point or one edge: with a radius, a sphere or a capsule.
function roundOf({ mesh, radius }: BodyGeometry): readonly [Vector3, Vector3] | null {
  const { positions, triangles } = mesh;
  const ends = [...new Set(triangles)];
  if (radius === 0 || triangles.length !== 3 || ends.length === 3) {
    return null;
  }
  const corner = (k: number): Vector3 => new Vector3().fromArray(positions, 3 * k);
  return [corner(ends[0]!), corner(ends.at(-1)!)];
}

/// Whether each triangle is one point, as those of a cloud are.
function isCloud({ triangles }: MeshData): boolean {
  for (let i = 0; i < triangles.length; i += 3) {
    if (triangles[i] !== triangles[i + 1] || triangles[i] !== triangles[i + 2]) {
      return false;
    }
  }
  return true;
}

function positionsOnly(mesh: MeshData): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(mesh.positions, 3));
  return geometry;
}

function surface(mesh: MeshData): BufferGeometry {
  return positionsOnly(mesh).setIndex(new BufferAttribute(mesh.triangles, 1));
}

/// The triangles around a curved body, shaded as that body. Each has corners of its own.
function curved(mesh: MeshData): BufferGeometry {
  return toCreasedNormals(surface(mesh), sharpAngle);
}

/// @param to  where every vertex ends, in the world; the body frame is the world here
function deforming(mesh: MeshData, to: readonly (readonly number[])[]): BufferGeometry {
  const way = new Float32Array(mesh.positions.length);
  to.forEach((vertex, i) =>
    vertex.forEach((x, k) => {
      way[3 * i + k] = x - mesh.origin[k]! - mesh.positions[3 * i + k]!;
    }),
  );
  const geometry = surface(mesh);
  geometry.morphAttributes.position = [new BufferAttribute(way, 3)];
  geometry.morphTargetsRelative = true;
  return geometry;
}

function round([a, b]: readonly [Vector3, Vector3], radius: number): BufferGeometry {
  const way = b.clone().sub(a);
  const geometry =
    way.length() === 0
      ? new SphereGeometry(radius, 40, 24)
      : new CapsuleGeometry(radius, way.length(), 10, 32);
  const along = way.length() === 0 ? new Vector3(0, 0, 1) : way.normalize();
  const middle = a.clone().add(b).multiplyScalar(0.5);
  return geometry
    .applyQuaternion(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along))
    .translate(...middle.toArray());
}

/// Draws each mesh, and each round shape of one size, from one buffer however many bodies have it.
export class DrawnShapes {
  private readonly known = new Map<MeshData | string, DrawnShape>();

  of(shape: BodyGeometry): DrawnShape {
    const { mesh, radius, to } = shape;
    if (to) {
      return { geometry: deforming(mesh, to), origin: mesh.origin, kind: "triangles" };
    }
    const ends = roundOf(shape);
    const key = ends ? JSON.stringify([ends, radius, mesh.origin]) : mesh;
    const drawn = this.known.get(key) ?? this.make(mesh, ends, radius);
    this.known.set(key, drawn);
    return drawn;
  }

  private make(
    mesh: MeshData,
    ends: readonly [Vector3, Vector3] | null,
    radius: number,
  ): DrawnShape {
    const { origin } = mesh;
    if (ends) {
      return { geometry: round(ends, radius), origin, kind: "smooth" };
    }
    if (mesh.convex && radius > 0) {
      return { geometry: thickHull(mesh, radius), origin, kind: "smooth" };
    }
    if (mesh.smooth) {
      return { geometry: curved(mesh), origin, kind: "smooth" };
    }
    return isCloud(mesh)
      ? { geometry: positionsOnly(mesh), origin, kind: "points" }
      : { geometry: surface(mesh), origin, kind: "triangles" };
  }
}
