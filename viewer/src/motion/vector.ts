/// Vectors and quaternions in double precision, without a library: motions are checked against C++.

import type { QuaternionWxyz, Vector3 } from "../data/result";

export const zero: Vector3 = [0, 0, 0];

export const add = (a: Vector3, b: Vector3): Vector3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vector3, b: Vector3): Vector3 => [
  a[0] - b[0],
  a[1] - b[1],
  a[2] - b[2],
];
export const scale = (s: number, a: Vector3): Vector3 => [s * a[0], s * a[1], s * a[2]];
export const dot = (a: Vector3, b: Vector3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector3, b: Vector3): Vector3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vector3): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Vector3, b: Vector3): number => length(subtract(a, b));

/// Zero stays zero.
export function unit(a: Vector3): Vector3 {
  const size = length(a);
  return size > 0 ? scale(1 / size, a) : zero;
}

export function unitQuaternion([w, x, y, z]: QuaternionWxyz): QuaternionWxyz {
  const size = Math.hypot(w, x, y, z);
  return [w / size, x / size, y / size, z / size];
}

/// First b, then a.
export function compose(a: QuaternionWxyz, b: QuaternionWxyz): QuaternionWxyz {
  const [aw, ...av] = a;
  const [bw, ...bv] = b;
  const v = add(add(scale(aw, bv), scale(bw, av)), cross(av, bv));
  return [aw * bw - dot(av, bv), ...v];
}

export const conjugate = ([w, x, y, z]: QuaternionWxyz): QuaternionWxyz => [w, -x, -y, -z];

/// @param axis  unit
export function turn(axis: Vector3, angle: number): QuaternionWxyz {
  return [Math.cos(0.5 * angle), ...scale(Math.sin(0.5 * angle), axis)];
}

/// @param q  unit
export function rotate(q: QuaternionWxyz, p: Vector3): Vector3 {
  const [w, ...v] = q;
  const vxp = cross(v, p);
  return add(p, scale(2, add(scale(w, vxp), cross(v, vxp))));
}
