/// The edges of a mesh that an eye looks for: open ones, and those where the surface bends.

import { BufferAttribute, BufferGeometry } from "three";
import type { MeshData } from "../data/page_data";

/// [rad]  Where a surface bends by more, an edge is drawn.
export const sharpAngle = (28 * Math.PI) / 180;
const sharp = Math.cos(sharpAngle);

/// Beyond this the lines take longer to find than they are worth.
const edgesUpTo = 300_000; // triangles

function normals({ positions, triangles }: MeshData): Float32Array {
  const out = new Float32Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!];
    const ux = positions[b]! - positions[a]!;
    const uy = positions[b + 1]! - positions[a + 1]!;
    const uz = positions[b + 2]! - positions[a + 2]!;
    const vx = positions[c]! - positions[a]!;
    const vy = positions[c + 1]! - positions[a + 1]!;
    const vz = positions[c + 2]! - positions[a + 2]!;
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const size = Math.hypot(x, y, z) || 1;
    out.set([x / size, y / size, z / size], i);
  }
  return out;
}

/// Pairs of vertex indices.
export function featureEdges(mesh: MeshData): Uint32Array {
  const { positions, triangles } = mesh;
  const vertexCount = positions.length / 3;
  const normal = normals(mesh);
  const first = new Map<number, number>(); // Edge to the triangle that has it so far; -1: seen twice.
  const edges: number[] = [];
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[i + k]!;
      const b = triangles[i + ((k + 1) % 3)]!;
      if (a === b) {
        continue;
      }
      const key = Math.min(a, b) * vertexCount + Math.max(a, b);
      const other = first.get(key);
      if (other === undefined) {
        first.set(key, i);
        continue;
      }
      first.set(key, -1);
      if (other < 0) {
        continue;
      }
      const cosine =
        normal[i]! * normal[other]! +
        normal[i + 1]! * normal[other + 1]! +
        normal[i + 2]! * normal[other + 2]!;
      if (cosine < sharp) {
        edges.push(a, b);
      }
    }
  }
  for (const [key, triangle] of first) {
    if (triangle >= 0) {
      edges.push(Math.floor(key / vertexCount), key % vertexCount);
    }
  }
  return new Uint32Array(edges);
}

/// Lines over the vertices of a surface; null where there are too many triangles to look for them.
export function edgeGeometry(mesh: MeshData, surface: BufferGeometry): BufferGeometry | null {
  if (mesh.triangles.length / 3 > edgesUpTo) {
    return null;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", surface.getAttribute("position"));
  geometry.morphAttributes = surface.morphAttributes;
  geometry.morphTargetsRelative = surface.morphTargetsRelative;
  geometry.setIndex(new BufferAttribute(featureEdges(mesh), 1));
  return geometry;
}
