/// The joints of robots: each coordinate over time with its limits, the contact, and where it is
/// beyond a limit. A click shows one in the large chart.

import { element } from "../core/dom";
import { number } from "../core/format";
import type { Signal } from "../core/signal";
import type { Turn } from "../data/result";
import type { Coordinate, Model } from "../model";
import type { Player } from "../player";
import { chartButton } from "./chart_button";
import {
  badTimes,
  rangeOf,
  rateTimesOf,
  rateUnit,
  timesOf,
  valueText,
  violationText,
} from "./joint_chart";
import { layer, sketch, stretch, upright } from "./sketch";

/// Makes a small picture of the coordinate, and the function that moves its time line.
function picture(coordinate: Coordinate, model: Model, player: Player) {
  const t = timesOf(coordinate);
  const value = t.map(coordinate.at);
  const line = { t, value, range: rangeOf(coordinate, value) };
  const { lower, upper } = coordinate;
  const [least, most] = line.range;
  return sketch(
    line,
    [
      ...(upper === null ? [] : [layer("beyond", upper, most, line)]),
      ...(lower === null ? [] : [layer("beyond", least, lower, line)]),
      ...badTimes(coordinate, model.duration).map(([from, to]) => stretch("bad", from, to)),
    ],
    model.contactTime === null ? [] : [upright("contact", model.contactTime)],
    player,
  );
}

function limitsText({ lower, upper, unit }: Coordinate): string {
  const end = (value: number | null): string => (value === null ? "∞" : number(value));
  return lower === null && upper === null ? "no limits" : `${end(lower)} … ${end(upper)} ${unit}`;
}

/// "velocity to 1.9 of 2.2 rad/s, acceleration to 3.7 of 3.8 rad/s²", as far as there are limits.
export function ratesText(coordinate: Coordinate): string {
  const t = rateTimesOf(coordinate);
  return coordinate.rates
    .filter(({ limit }) => limit !== null)
    .map((rate) => {
      const most = Math.max(...t.map((moment) => Math.abs(rate.at(moment))));
      const share = Number(most.toPrecision(3));
      return `${rate.name} to ${number(share)} of ${number(rate.limit!)}\u00a0${rateUnit(rate, coordinate)}`;
    })
    .join(", ");
}

/// "turned by 12.57 rad · 720°, as its numbers say: from 0 to 12.57 rad"
function turnText({ turned, turning, from, to }: Turn): string {
  const degrees = number(Number(((turned * 180) / Math.PI).toFixed(1)));
  const way = turning === "short" ? "the short way" : "as its numbers say";
  return `turned by ${number(turned)}\u00a0rad · ${degrees}°, ${way}: from ${number(from)} to ${number(to)}\u00a0rad`;
}

function row(
  coordinate: Coordinate,
  model: Model,
  player: Player,
  selected: Signal<Coordinate | null>,
): HTMLElement {
  const { name, violations, mimics, atRest, turn } = coordinate;
  const hasRates = coordinate.rates.some((one) => one.name !== "velocity" && one.limit !== null);
  const button = chartButton(name, coordinate, selected, player, {
    textAt: (t) => valueText(coordinate.at(t), coordinate),
    pick: () => (selected.value = selected.value === coordinate ? null : coordinate),
  });
  return element(
    "li.joint",
    { "data-bad": violations.length > 0, "data-rest": atRest },
    button,
    picture(coordinate, model, player),
    element("span.detail", {}, limitsText(coordinate), mimics ? ` · follows ${mimics}` : ""),
    ...(hasRates ? [element("span.detail.rates", {}, ratesText(coordinate))] : []),
    ...(turn ? [element("span.detail.turn", {}, turnText(turn))] : []),
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
