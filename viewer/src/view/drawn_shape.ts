/// What is drawn of a shape: its triangles, or what these only stand for.

import { BufferAttribute, BufferGeometry, CapsuleGeometry, SphereGeometry } from "three";
import type { MeshData } from "../data/page_data";
import type { Body } from "../model";

export interface DrawnShape {
  readonly geometry: BufferGeometry;
  readonly origin: readonly [number, number, number];
  readonly kind: "triangles" | "smooth" | "points";
}

interface Round {
  readonly radius: number;
  readonly length?: number;
}

const center = [0, 0, 0] as const;

/// A sphere is a point with a radius, a capsule an edge with one: their own numbers tell.
function roundOf({ data }: Body): Round | null {
  const { sphere, capsule } = data.shape;
  return (sphere ?? capsule ?? null) as Round | null;
}

/// [m] by which the triangles of a shape are thickened.
export function radiusOf(body: Body): number {
  const { radius } = body.data.shape;
  return roundOf(body)?.radius ?? (typeof radius === "number" ? radius : 0);
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

function round({ radius, length }: Round): BufferGeometry {
  return length === undefined
    ? new SphereGeometry(radius, 40, 24)
    : new CapsuleGeometry(radius, length, 10, 32).rotateX(0.5 * Math.PI);
}

/// Draws each mesh, and each round shape of one size, from one buffer however many bodies have it.
export class DrawnShapes {
  private readonly known = new Map<MeshData | string, DrawnShape>();

  of(body: Body): DrawnShape {
    const { mesh, data } = body;
    const { motion } = data;
    if (motion?.type === "vertices") {
      return { geometry: deforming(mesh, motion.to), origin: mesh.origin, kind: "triangles" };
    }
    const shape = roundOf(body);
    const key = shape ? JSON.stringify(shape) : mesh;
    const drawn = this.known.get(key) ?? this.make(mesh, shape);
    this.known.set(key, drawn);
    return drawn;
  }

  private make(mesh: MeshData, shape: Round | null): DrawnShape {
    if (shape) {
      return { geometry: round(shape), origin: center, kind: "smooth" };
    }
    return isCloud(mesh)
      ? { geometry: positionsOnly(mesh), origin: mesh.origin, kind: "points" }
      : { geometry: surface(mesh), origin: mesh.origin, kind: "triangles" };
  }
}
