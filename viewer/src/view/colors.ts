/// Colours of bodies: they differ in hue, bodies at rest are grey. Red is kept for contacts.

import type { Body } from "../model";

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

export function bodyColor(body: Body, bodies: readonly Body[]): string {
  const alike = bodies.filter((other) => other.index < body.index && other.atRest === body.atRest);
  const palette = body.atRest ? resting : moving;
  return palette[alike.length % palette.length]!;
}
