/// The joints of robots: each coordinate over time with its limits, the contact, and where it is
/// beyond a limit. A click shows one in the large chart.

import { element } from "../core/dom";
import { number } from "../core/format";
import type { Signal } from "../core/signal";
import type { Coordinate, Model } from "../model";
import type { Player } from "../player";
import { badTimes, rangeOf, timesOf, valueText, violationText } from "./joint_chart";

const height = 40; // Of a drawing that is 1000 wide; both are stretched.

const drawn = "http://www.w3.org/2000/svg";

function shape(name: string, kind: string, attributes: Readonly<Record<string, number | string>>) {
  const made = document.createElementNS(drawn, name);
  made.classList.add(kind);
  Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, String(value)));
  return made;
}

const upright = (kind: string, t: number) => shape("path", kind, { d: `M${1000 * t} 0V${height}` });

/// The coordinate as a small picture, and what moves its line of time.
function picture(coordinate: Coordinate, model: Model) {
  const times = timesOf(coordinate);
  const values = times.map(coordinate.at);
  const [least, most] = rangeOf(coordinate, values);
  const y = (value: number): number => (height * (most - value)) / (most - least);
  const { lower, upper } = coordinate;
  const svg = shape("svg", "joint-picture", {
    viewBox: `0 0 1000 ${height}`,
    preserveAspectRatio: "none",
    "aria-hidden": "true",
  });
  const beyond = (from: number, to: number) =>
    shape("rect", "beyond", { x: 0, width: 1000, y: from, height: Math.max(to - from, 0) });
  const parts = [
    ...(upper === null ? [] : [beyond(0, y(upper))]),
    ...(lower === null ? [] : [beyond(y(lower), height)]),
    ...badTimes(coordinate, model.duration).map(([from, to]) =>
      shape("rect", "bad", { x: 1000 * from, width: 1000 * (to - from), y: 0, height }),
    ),
    shape("path", "curve", {
      d: values.map((value, k) => `${k ? "L" : "M"}${1000 * times[k]!} ${y(value)}`).join(""),
    }),
    ...(model.contactTime === null ? [] : [upright("contact", model.contactTime)]),
  ];
  const now = upright("now", 0);
  svg.append(...parts, now);
  return { svg, show: (t: number) => now.setAttribute("d", `M${1000 * t} 0V${height}`) };
}

function seekIn(svg: SVGElement, player: Player): void {
  const seek = (event: PointerEvent): void => {
    const box = svg.getBoundingClientRect();
    player.seek((event.clientX - box.left) / box.width);
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

function limitsText({ lower, upper, unit }: Coordinate): string {
  const end = (value: number | null): string => (value === null ? "∞" : number(value));
  return lower === null && upper === null ? "no limits" : `${end(lower)} … ${end(upper)} ${unit}`;
}

function row(
  coordinate: Coordinate,
  model: Model,
  player: Player,
  selected: Signal<Coordinate | null>,
): HTMLElement {
  const { name, violations, mimics, atRest } = coordinate;
  const now = element("span.joint-now");
  const button = element(
    "button.row-name",
    { type: "button", title: `Show ${name} in the large chart` },
    element("span.name", {}, name),
    now,
  );
  button.addEventListener("click", () => {
    selected.value = selected.value === coordinate ? null : coordinate;
  });
  selected.subscribe((value) => button.setAttribute("aria-pressed", String(value === coordinate)));
  const { svg, show } = picture(coordinate, model);
  seekIn(svg, player);
  player.t.subscribe((t) => {
    now.textContent = valueText(coordinate.at(t), coordinate);
    show(t);
  });
  return element(
    "li.joint",
    { "data-bad": violations.length > 0, "data-rest": atRest },
    button,
    svg,
    element("span.detail", {}, limitsText(coordinate), mimics ? ` · follows ${mimics}` : ""),
    ...violations.map((found) => element("span.joint-bad", {}, violationText(found, coordinate))),
  );
}

/// Null where no joint has a coordinate. Those that move, or are where they should not be, come first.
export function jointsPanel(
  model: Model,
  player: Player,
  selected: Signal<Coordinate | null>,
): HTMLElement | null {
  if (model.coordinates.length === 0) {
    return null;
  }
  const rows = (robot: number, first: boolean): HTMLElement[] =>
    model.coordinates
      .filter((one) => one.robot === robot)
      .filter(({ atRest, violations }) => first === (!atRest || violations.length > 0))
      .map((coordinate) => row(coordinate, model, player, selected));
  const robots = model.robots.flatMap((name, robot) => {
    const list = element("ul.rows", {}, ...rows(robot, true));
    const resting = rows(robot, false);
    const rest = element(
      "details",
      {},
      element("summary", {}, `${resting.length} at rest`),
      element("ul.rows", {}, ...resting),
    );
    return [
      ...(model.robots.length > 1 ? [element("h3", {}, name)] : []),
      list,
      ...(resting.length > 0 ? [rest] : []),
    ];
  });
  return element(
    "section.card",
    { "aria-label": "Joints" },
    element("h2", {}, "Joints ", element("span.count", {}, String(model.coordinates.length))),
    ...robots,
  );
}
