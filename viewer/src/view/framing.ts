/// How far a camera stands from what it looks at.

import { type PerspectiveCamera, type Sphere, Vector3 } from "three";

/// From where all of the points are seen, in a direction.
export function rangeFor(
  camera: PerspectiveCamera,
  points: readonly Vector3[],
  target: Vector3,
  direction: Vector3,
): number {
  const right = new Vector3().crossVectors(camera.up, direction).normalize();
  const up = new Vector3().crossVectors(direction, right);
  const slope = Math.tan((0.5 * camera.fov * Math.PI) / 180);
  const room = 1.12;
  return Math.max(
    ...points.map((point) => {
      const d = point.clone().sub(target);
      const across = Math.abs(d.dot(right)) / (slope * camera.aspect);
      return d.dot(direction) + room * Math.max(across, Math.abs(d.dot(up)) / slope);
    }),
    1e-9,
  );
}

/// From where a ball fills the picture.
export function rangeTo(camera: PerspectiveCamera, { radius }: Sphere): number {
  const half = (0.5 * camera.fov * Math.PI) / 180;
  const narrow = Math.atan(Math.tan(half) * Math.min(1, camera.aspect));
  return (1.08 * Math.max(radius, 1e-9)) / Math.sin(narrow);
}
