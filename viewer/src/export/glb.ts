/// The scene in motion as binary glTF, for other programs.

import {
  AnimationClip,
  Mesh,
  MeshStandardMaterial,
  NumberKeyframeTrack,
  Object3D,
  Points,
  PointsMaterial,
  QuaternionKeyframeTrack,
  Vector3,
  VectorKeyframeTrack,
  type KeyframeTrack,
} from "three";
import { GLTFExporter } from "three/examples/jsm/exporters/GLTFExporter.js";
import type { QuaternionWxyz, Vector3 as Vector3Data } from "../data/result";
import type { Body, Course, Model } from "../model";
import { place } from "../motion/motion";
import { subtract, zero } from "../motion/vector";
import { keysAlong } from "../motion/way";
import type { BodyView } from "../view/body_view";
import type { DrawnShape } from "../view/drawn_shape";
import type { GeometryView } from "../view/geometry_view";

const leastKeys = 61;
const mostKeys = 2401;
const keyAngle = Math.PI / 24; // Between two keys a player turns by the shortest way.

/// Enough keys for the body that turns most, the first contact among them.
function keyTimes(model: Model): number[] {
  const angle = Math.max(...model.bodies.map((body) => body.angle));
  const count = Math.min(Math.max(leastKeys, Math.ceil(angle / keyAngle) + 1), mostKeys);
  const times = new Set(Array.from({ length: count }, (_, k) => k / (count - 1)));
  if (model.contactTime !== null) {
    times.add(model.contactTime);
  }
  return [...times].sort((a, b) => a - b);
}

/// Between two keys the centre of mass moves on a line, and a player turns by the shortest way.
function keysOfRun({ way }: Course, duration: number): number[] {
  return keysAlong(way, mostKeys).map((time) => Math.min(time / duration, 1));
}

/// Of a rotation's two quaternions the one nearer to that before it.
function withoutFlips(rotations: readonly QuaternionWxyz[]): QuaternionWxyz[] {
  const kept: QuaternionWxyz[] = [];
  for (const [w, x, y, z] of rotations) {
    const [a, b, c, d] = kept.at(-1) ?? [w, x, y, z];
    kept.push(a * w + b * x + c * y + d * z < 0 ? [-w, -x, -y, -z] : [w, x, y, z]);
  }
  return kept;
}

function tracksOf(
  body: Body,
  name: string,
  keys: readonly number[],
  duration: number,
): KeyframeTrack[] {
  const seconds = keys.map((t) => t * duration);
  const pivot = body.course?.centre ?? zero;
  if (body.geometries[0]?.to) {
    return [
      new NumberKeyframeTrack(`${name}-surface.morphTargetInfluences[0]`, seconds, [...keys]),
    ];
  }
  const poses = keys.map((t) => body.motion(t));
  const rotations = withoutFlips(poses.map(({ rotation }) => rotation));
  return [
    new VectorKeyframeTrack(
      `${name}.position`,
      seconds,
      poses.flatMap((pose) => [...place(pose, pivot)]),
    ),
    new QuaternionKeyframeTrack(
      `${name}.quaternion`,
      seconds,
      rotations.flatMap(([w, x, y, z]) => [x, y, z, w]),
    ),
  ];
}

/// With materials that other programs know.
function surfaceOf({ geometry, kind }: DrawnShape, color: string): Object3D {
  return kind === "points"
    ? new Points(geometry, new PointsMaterial({ color }))
    : new Mesh(geometry, new MeshStandardMaterial({ color, roughness: 0.6, metalness: 0.1 }));
}

/// @param pivot  [m] Where the node that holds it has its origin, in the body.
function pieceOf(
  { shape, drawn, surface, drawnColor }: GeometryView,
  name: string,
  pivot: Vector3Data,
): Object3D {
  const look = surfaceOf(drawn, drawnColor);
  look.name = name;
  look.position.copy(surface.position);
  const { position, rotation } = shape.pose;
  const node = new Object3D();
  node.position.set(...subtract(position, pivot));
  node.quaternion.set(rotation[1], rotation[2], rotation[3], rotation[0]);
  return node.add(look);
}

export async function animationOf(model: Model, views: readonly BodyView[]): Promise<Blob> {
  const keys = keyTimes(model);
  const root = new Object3D();
  root.name = model.title;
  root.quaternion.setFromUnitVectors(new Vector3(...model.up), new Vector3(0, 1, 0)); // As in glTF.
  const tracks: KeyframeTrack[] = [];
  for (const { body, shownPieces } of views) {
    const name = `body${body.index}`;
    const node = new Object3D();
    node.name = name;
    node.userData = { body: body.name };
    const pivot = body.course?.centre ?? zero;
    const start = body.motion(0);
    const { rotation } = start;
    node.position.set(...place(start, pivot));
    node.quaternion.set(rotation[1], rotation[2], rotation[3], rotation[0]);
    shownPieces.forEach((piece, k) => node.add(pieceOf(piece, `${name}-surface${k || ""}`, pivot)));
    root.add(node);
    if (!body.atRest) {
      const own = body.course ? keysOfRun(body.course, model.duration) : keys;
      tracks.push(...tracksOf(body, name, own, model.duration));
    }
  }
  const animations = tracks.length > 0 ? [new AnimationClip("motion", model.duration, tracks)] : [];
  const glb = await new GLTFExporter().parseAsync(root, { binary: true, animations });
  return new Blob([glb as ArrayBuffer], { type: "model/gltf-binary" });
}
