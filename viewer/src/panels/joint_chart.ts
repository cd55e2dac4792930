/// A joint's coordinate over time, or one of its rates, with its limits.

import { number } from "../core/format";
import type { Limit } from "../data/result";
import type { Coordinate, Rate, RateName } from "../model";
import type { ChartChoice, ChartContent } from "./time_chart";

const samples = 192; // Beside the ends of all segments.

/// Times at which a coordinate is drawn.
export function timesOf({ breaks, atRest }: Coordinate): number[] {
  const even = Array.from({ length: samples + 1 }, (_, k) => k / samples);
  return atRest ? [0, 1] : [...new Set([...even, ...breaks])].sort((a, b) => a - b);
}

/// Returns the range of a chart of a coordinate. It includes the limits and all values.
export function rangeOf({ lower, upper }: Coordinate, values: readonly number[]): [number, number] {
  const all = [...values, ...[lower, upper].filter((end) => end !== null)];
  const [least, most] = [Math.min(...all), Math.max(...all)];
  const room = 0.08 * (most - least || Math.max(Math.abs(most), 1));
  return [least - room, most + room];
}

/// Where it is beyond a limit, in t. The result has proven them [s].
export function badTimes({ violations }: Coordinate, duration: number): [number, number][] {
  return violations.flatMap(({ intervals }) =>
    intervals.map(([from, to]): [number, number] => [from / duration, to / duration]),
  );
}

export function valueText(value: number, { unit }: Coordinate): string {
  const text = number(Math.abs(value) < 5e-7 ? 0 : Number(value.toFixed(4)));
  const degrees =
    unit === "rad" ? ` · ${number(Number(((value * 180) / Math.PI).toFixed(1)))}°` : "";
  return `${text}\u00a0${unit}${degrees}`;
}

const limitNames = {
  lower_position: "lower limit",
  upper_position: "upper limit",
  velocity: "velocity limit",
} as const;

/// "0.025 m beyond the upper limit of 0.04 m".
export function violationText({ limit, value, excess }: Limit, { unit }: Coordinate): string {
  const units = limit === "velocity" ? `${unit}/s` : unit;
  return `${number(excess)} ${units} beyond the ${limitNames[limit]} of ${number(value)} ${units}`;
}

/// What is drawn of a joint.
export type Shown = "position" | RateName;

const perSeconds = { velocity: "/s", acceleration: "/s²", jerk: "/s³" } as const;

export const rateUnit = ({ name }: Rate, { unit }: Coordinate): string =>
  `${unit}${perSeconds[name]}`;

/// Times at which a rate is drawn: on both sides of the ends of segments, where it may jump.
export function rateTimesOf(coordinate: Coordinate): number[] {
  const beside = 1e-9;
  const inner = coordinate.breaks.filter((end) => end < 1);
  return [
    ...new Set([
      ...timesOf(coordinate).filter((t) => !inner.includes(t)),
      ...inner.flatMap((end) => [end - beside, end + beside]),
    ]),
  ].sort((a, b) => a - b);
}

function rateContent(coordinate: Coordinate, rate: Rate, duration: number): ChartContent {
  const t = rateTimesOf(coordinate);
  const value = t.map(rate.at);
  const levels = rate.limit === null ? [] : [-rate.limit, rate.limit];
  const [least, most] = [Math.min(...value, ...levels), Math.max(...value, ...levels)];
  const room = 0.08 * (most - least || 1);
  const violations = coordinate.violations.filter(({ limit }) => limit === rate.name);
  const bad = badTimes({ ...coordinate, violations }, duration);
  return {
    title: `${coordinate.name}, ${rate.name}`,
    unit: rateUnit(rate, coordinate),
    range: [least - room, most + room],
    lines: [{ t, value, color: "accent", width: 2 }],
    levels,
    bands: bad.map(([from, to]) => ({ from, to, color: "chart-bad" })),
  };
}

function positionContent(coordinate: Coordinate, duration: number): ChartContent {
  const { name, unit, lower, upper } = coordinate;
  const t = timesOf(coordinate);
  const value = t.map(coordinate.at);
  return {
    title: name,
    unit,
    range: rangeOf(coordinate, value),
    lines: [{ t, value, color: "accent", width: 2 }],
    levels: [lower, upper].filter((end) => end !== null),
    bands: badTimes(coordinate, duration).map(([from, to]) => ({ from, to, color: "chart-bad" })),
  };
}

/// @param shown  a rate that the coordinate does not have is its position
/// @param close  shows something else again
/// @param pick   shows another one of these
export function jointContent(
  coordinate: Coordinate,
  duration: number,
  {
    shown = "position",
    close,
    pick,
  }: {
    shown?: Shown;
    close?: () => void;
    pick?: (next: Shown) => void;
  } = {},
): ChartContent {
  const rate = coordinate.rates.find(({ name }) => name === shown);
  const content = rate
    ? rateContent(coordinate, rate, duration)
    : positionContent(coordinate, duration);
  const all: Shown[] = ["position", ...coordinate.rates.map(({ name }) => name)];
  const choices = all.map((name): ChartChoice => ({
    name,
    isShown: name === (rate?.name ?? "position"),
    pick: () => pick?.(name),
  }));
  return {
    ...content,
    ...(pick && choices.length > 1 ? { choices } : {}),
    ...(close ? { close } : {}),
  };
}
