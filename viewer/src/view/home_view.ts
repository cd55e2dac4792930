/// From where a scene is looked at first.

import { Box3, Quaternion, Ray, Vector3 } from "three";
import type { Body, Model } from "../model";
import { combine, place, unplace, type Pose } from "../motion/motion";
import { conjugate, rotate } from "../motion/vector";
import { geometryBox } from "./bounds";

/// From the front on the right, then around by turns to both sides; where z is up.
const directions = [0, 1, -1, 2, -2, 3, -3, 4].map((eighth) => {
  const angle = -0.3 * Math.PI + (eighth * Math.PI) / 4;
  return new Vector3(Math.cos(angle), Math.sin(angle), 0.52).normalize();
});

const moments = [0, 0.25, 0.5, 0.75, 1];
const mostRays = 50_000; // In each direction; beyond it nothing counts as hidden.
const alike = 0.02;

interface Wall {
  readonly box: Box3;
  readonly pose: Pose;
}

const wallsOf = ({ geometries, motion }: Body): Wall[] =>
  geometries.map((shape) => ({ box: geometryBox(shape), pose: combine(motion(0), shape.pose) }));

/// The middles of a body's geometries at some moments.
const placesOf = ({ geometries, motion }: Body): Vector3[] =>
  geometries.flatMap((shape) => {
    const middle = place(shape.pose, geometryBox(shape).getCenter(new Vector3()).toArray());
    return moments.map((t) => new Vector3(...place(motion(t), middle)));
  });

function isBehind({ box, pose }: Wall, from: Vector3, direction: Vector3): boolean {
  const origin = new Vector3(...unplace(pose, from.toArray()));
  const way = new Vector3(...rotate(conjugate(pose.rotation), direction.toArray()));
  return new Ray(origin, way).intersectsBox(box);
}

/// How much of what moves is hidden by the boxes of what rests, from 0 to 1.
function hiddenShare({ bodies }: Model): (direction: Vector3) => number {
  const walls = bodies.filter(({ atRest }) => atRest).flatMap(wallsOf);
  const places = bodies.filter(({ atRest }) => !atRest).flatMap(placesOf);
  if (places.length === 0 || walls.length * places.length > mostRays) {
    return () => 0;
  }
  return (direction) =>
    places.filter((from) => walls.some((wall) => isBehind(wall, from, direction))).length /
    places.length;
}

/// From the side of the body that moves, where there is a contact to look at, and not through walls.
export function homeDirection(model: Model): Vector3 {
  const hidden = hiddenShare(model);
  const contact = model.contacts[0];
  const sign = contact && model.body(contact.bodies[0]).atRest ? 1 : -1;
  const normal = contact?.normal ? new Vector3(...contact.normal).multiplyScalar(sign) : null;
  const misfit = (d: Vector3): number => (normal ? Math.max(0, 0.25 - d.dot(normal)) : 0);
  const upright = new Quaternion().setFromUnitVectors(
    new Vector3(0, 0, 1),
    new Vector3(...model.up),
  );
  const all = directions.map((d) => d.clone().applyQuaternion(upright));
  const scores = all.map((d) => misfit(d) + hidden(d));
  const least = Math.min(...scores);
  return all[scores.findIndex((score) => score < least + alike)]!;
}
