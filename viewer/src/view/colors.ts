/// Colours of bodies: they differ in hue, bodies at rest are grey. A robot has one hue, its links two
/// tones of it by turns. Red is kept for contacts.

import { Color } from "three";
import { isDrawn, type Body } from "../model";

const moving = [
  "#4c8dff",
  "#e0a136",
  "#3fb68b",
  "#b67be6",
  "#39b3c6",
  "#c9b83c",
  "#7f8cf5",
  "#6cb33f",
];
const resting = ["#9aa7b5", "#b3a998", "#8fa69d", "#a79bb3"];

export const contactColor = "#ff4a3d";

function linkColor(body: Body, bodies: readonly Body[]): string {
  const before = bodies.filter(
    (other) => other.robot === body.robot && other.index < body.index && isDrawn(other),
  );
  const color = new Color(moving[body.robot! % moving.length]);
  return `#${(before.length % 2 ? color.lerp(new Color("#fff"), 0.4) : color).getHexString()}`;
}

export function bodyColor(body: Body, bodies: readonly Body[]): string {
  if (body.robot !== null) {
    return linkColor(body, bodies);
  }
  const robots = new Set(bodies.map(({ robot }) => robot)).size - 1;
  const alike = bodies.filter(
    (other) => other.robot === null && other.index < body.index && other.atRest === body.atRest,
  );
  const palette = body.atRest ? resting : moving;
  return palette[(alike.length + (body.atRest ? 0 : robots)) % palette.length]!;
}
