/// The surface of a convex polyhedron that a radius thickens: a rounded box, or a rounded hull.

import { BufferGeometry, IcosahedronGeometry, Vector3 } from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { MeshData } from "../data/page_data";
import { sharpAngle } from "./feature_edges";

/// Directions evenly around, and the normals of the triangles, so that these stay flat.
function directions(corner: (k: number) => Vector3, triangles: ArrayLike<number>): Vector3[] {
  const ball = new IcosahedronGeometry(1, 5).getAttribute("position");
  const all: Vector3[] = [];
  for (let k = 0; k < ball.count; ++k) {
    all.push(new Vector3().fromBufferAttribute(ball, k).normalize());
  }
  for (let i = 0; i < triangles.length; i += 3) {
    const at = corner(triangles[i]!);
    const side = corner(triangles[i + 1]!).sub(at);
    const normal = side.cross(corner(triangles[i + 2]!).sub(at)).normalize();
    all.push(normal, normal.clone().negate());
  }
  const known = new Map(
    all.map((way) => [
      way
        .toArray()
        .map((x) => x.toFixed(5))
        .join(),
      way,
    ]),
  );
  return [...known.values()];
}

/// The hull of balls about the corners.
export function thickHull(mesh: MeshData, radius: number): BufferGeometry {
  const { positions, triangles } = mesh;
  const corner = (k: number): Vector3 => new Vector3().fromArray(positions, 3 * k);
  const corners = [...new Set(triangles)].map(corner);
  const size = Math.max(...corners.map((at) => at.length()));
  const points: Vector3[] = [];
  for (const way of directions(corner, triangles)) {
    const most = Math.max(...corners.map((at) => at.dot(way)));
    for (const at of corners) {
      if (at.dot(way) > most - 1e-6 * size) {
        points.push(at.clone().addScaledVector(way, radius)); // Others are inside.
      }
    }
  }
  return toCreasedNormals(new ConvexGeometry(points).deleteAttribute("normal"), sharpAngle);
}
