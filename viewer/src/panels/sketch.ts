/// A small picture of a value over time, with a line at the shown moment. A click goes to its
/// moment.

import type { Player } from "../player";

const height = 40; // Of a drawing that is 1000 wide; both are stretched.

const drawn = "http://www.w3.org/2000/svg";

/// A polyline over t in [0, 1].
export interface SketchLine {
  readonly t: ArrayLike<number>;
  readonly value: readonly number[];
  readonly range: readonly [number, number];
}

function shape(name: string, kind: string, attributes: Readonly<Record<string, number | string>>) {
  const made = document.createElementNS(drawn, name);
  made.classList.add(kind);
  Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, String(value)));
  return made;
}

const y = (value: number, [least, most]: SketchLine["range"]): number =>
  (height * (most - value)) / (most - least);

/// A line at a moment.
export const upright = (kind: string, t: number): SVGElement =>
  shape("path", kind, { d: `M${1000 * t} 0V${height}` });

/// From one moment to another.
export const stretch = (kind: string, from: number, to: number): SVGElement =>
  shape("rect", kind, { x: 1000 * from, width: 1000 * (to - from), y: 0, height });

/// From one value to another, over all of the time.
export function layer(kind: string, from: number, to: number, { range }: SketchLine): SVGElement {
  const top = y(to, range);
  return shape("rect", kind, {
    x: 0,
    width: 1000,
    y: top,
    height: Math.max(y(from, range) - top, 0),
  });
}

function seekIn(svg: SVGElement, player: Player): void {
  const seek = (event: PointerEvent): void => {
    const box = svg.getBoundingClientRect();
    player.seek(player.window.at((event.clientX - box.left) / box.width));
  };
  svg.addEventListener("pointerdown", (event) => {
    svg.setPointerCapture(event.pointerId);
    seek(event);
  });
  svg.addEventListener("pointermove", (event) => {
    if (svg.hasPointerCapture(event.pointerId)) {
      seek(event);
    }
  });
}

/// @param below  the drawing under the line
/// @param above  and over it
export function sketch(
  { t, value, range }: SketchLine,
  below: readonly SVGElement[],
  above: readonly SVGElement[],
  player: Player,
): SVGElement {
  const svg = shape("svg", "sketch", {
    preserveAspectRatio: "none",
    "aria-hidden": "true",
  });
  const d = value.map((v, k) => `${k ? "L" : "M"}${1000 * t[k]!} ${y(v, range)}`).join("");
  const now = upright("now", 0);
  svg.append(...below, shape("path", "curve", { d }), ...above, now);
  player.window.shown.subscribe(({ from, to }) =>
    svg.setAttribute("viewBox", `${1000 * from} 0 ${1000 * (to - from)} ${height}`),
  );
  player.t.subscribe((moment) => now.setAttribute("d", `M${1000 * moment} 0V${height}`));
  seekIn(svg, player);
  return svg;
}
