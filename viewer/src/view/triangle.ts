/// Where a triangle of a geometry is as the geometry's frame sees it.

import type { Vector3 } from "../data/result";
import type { BodyGeometry } from "../model";

/// The corners of a triangle, relative to the origin of the geometry's mesh.
///
/// @param t  when; a deforming body has them elsewhere at each moment
export function cornersAt({ mesh, to }: BodyGeometry, triangle: number, t: number): Float32Array {
  const { positions, triangles, origin } = mesh;
  const corners = new Float32Array(9);
  for (let k = 0; k < 3; ++k) {
    const vertex = triangles[3 * triangle + k]!;
    const corner = positions.slice(3 * vertex, 3 * vertex + 3);
    to?.[vertex]!.forEach((x, i) => (corner[i]! += t * (x - origin[i]! - corner[i]!)));
    corners.set(corner, 3 * k);
  }
  return corners;
}

/// The point of a triangle with these weights of its corners, in the frame of the geometry.
export function pointAt(
  shape: BodyGeometry,
  triangle: number,
  weights: Vector3,
  t: number,
): Vector3 {
  const corners = cornersAt(shape, triangle, t);
  const coordinate = (i: number): number =>
    shape.mesh.origin[i]! +
    weights[0] * corners[i]! +
    weights[1] * corners[3 + i]! +
    weights[2] * corners[6 + i]!;
  return [coordinate(0), coordinate(1), coordinate(2)];
}
