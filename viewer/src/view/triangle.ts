/// Where a triangle of a body is as its body sees it.

import type { Vector3 } from "../data/result";
import type { Body } from "../model";

/// The corners of a triangle, relative to the origin of the body's mesh.
///
/// @param t  when; a deforming body has them elsewhere at each moment
export function cornersAt(body: Body, triangle: number, t: number): Float32Array {
  const { positions, triangles, origin } = body.mesh;
  const { motion } = body.data;
  const corners = new Float32Array(9);
  for (let k = 0; k < 3; ++k) {
    const vertex = triangles[3 * triangle + k]!;
    const corner = positions.slice(3 * vertex, 3 * vertex + 3);
    if (motion?.type === "vertices") {
      motion.to[vertex]!.forEach((x, i) => (corner[i]! += t * (x - origin[i]! - corner[i]!)));
    }
    corners.set(corner, 3 * k);
  }
  return corners;
}

/// The point of a triangle with these weights of its corners, in the frame of the body.
export function pointAt(body: Body, triangle: number, weights: Vector3, t: number): Vector3 {
  const corners = cornersAt(body, triangle, t);
  const coordinate = (i: number): number =>
    body.mesh.origin[i]! +
    weights[0] * corners[i]! +
    weights[1] * corners[3 + i]! +
    weights[2] * corners[6 + i]!;
  return [coordinate(0), coordinate(1), coordinate(2)];
}
