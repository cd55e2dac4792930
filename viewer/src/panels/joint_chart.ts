/// A joint's coordinate over time, with its limits.

import { number } from "../core/format";
import type { Limit } from "../data/result";
import type { Coordinate } from "../model";
import type { ChartContent } from "./time_chart";

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

/// @param close  shows something else again
export function jointContent(
  coordinate: Coordinate,
  duration: number,
  close?: () => void,
): ChartContent {
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
    ...(close ? { close } : {}),
  };
}
