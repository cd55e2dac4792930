/// The values of every step over time. A click shows one of them in the large chart.

import { element } from "../core/dom";
import {
  energyUnit,
  forceUnit,
  impulseUnit,
  lengthUnit,
  powerUnit,
  quantity,
  timeUnit,
  torqueUnit,
  type Unit,
} from "../core/format";
import type { Signal } from "../core/signal";
import type { StepData } from "../data/run_data";
import type { Device } from "../devices";
import type { Player } from "../player";
import { length } from "../motion/vector";
import type { Run } from "../run";
import { chartButton } from "./chart_button";
import { sketch, type SketchLine } from "./sketch";
import type { ChartContent, ChartLine } from "./time_chart";

export interface RunChart {
  readonly name: string;
  readonly content: ChartContent;
  /// Of each step, in SI units.
  readonly values: readonly (number | null)[];
  readonly unitFor: (value: number) => Unit;
}

/// The unit of counts, which has no name.
const ones = (): Unit => ({ name: "", size: 1 });

const finite = (values: readonly (number | null)[]): number[] =>
  values.filter((value) => value !== null);
const least = (values: readonly number[]): number =>
  values.reduce((a, b) => Math.min(a, b), Infinity);
const most = (values: readonly number[]): number => values.reduce((a, b) => Math.max(a, b), 0);

/// Makes a stepped line: the value of a step holds from its beginning to its end.
function steppedLine({ ends }: Run, values: readonly (number | null)[]): ChartLine {
  const known = values.flatMap((value, k) => (value === null ? [] : [{ t: ends[k]!, value }]));
  const first = known[0] ? [{ t: 0, value: known[0].value }] : [];
  const all = [...first, ...known];
  return {
    t: all.map(({ t }) => t),
    value: all.map(({ value }) => value),
    color: "accent",
    width: 2,
    stepped: true,
  };
}

/// From nothing, or the least below it, to the greatest.
function amount(
  run: Run,
  name: string,
  unitFor: (value: number) => Unit,
  of: (step: StepData, k: number) => number,
): RunChart {
  const values = run.steps.map(of);
  const [low, high] = [least([0, ...values]), most(values)];
  const unit = unitFor(Math.max(-low, high));
  const line = steppedLine(
    run,
    values.map((value) => value / unit.size),
  );
  const content: ChartContent = {
    title: name,
    unit: unit.name,
    range: [(1.08 * low) / unit.size, (1.08 * (high || (low < 0 ? 0 : 1))) / unit.size],
    lines: [line],
    levels: [],
    bands: [],
  };
  return { name, content, values, unitFor };
}

function energy(run: Run): RunChart {
  const kinetic = run.steps.map((step) => step.kinetic_energy);
  const total = run.steps.map((step) => step.kinetic_energy + step.potential_energy);
  const all = [0, ...kinetic, ...total];
  const [low, high] = [least(all), most(all)];
  const unit = energyUnit(Math.max(-low, high));
  const room = (0.08 * (high - low || 1)) / unit.size;
  const t = Array.from(run.ends);
  const line = (values: readonly number[], look: Omit<ChartLine, "t" | "value">): ChartLine => ({
    t,
    value: values.map((value) => value / unit.size),
    ...look,
  });
  const lines = [
    line(total, { color: "text", width: 2, label: "total" }),
    line(kinetic, { color: "accent", width: 2, label: "kinetic" }),
  ];
  const content: ChartContent = {
    title: "energy",
    unit: unit.name,
    range: [low / unit.size - (low < 0 ? room : 0), high / unit.size + room],
    lines,
    levels: [],
    bands: [],
  };
  return { name: "kinetic energy", content, values: kinetic, unitFor: energyUnit };
}

/// By powers of ten: bodies that rest come nearer than those that fly by orders of magnitude.
function clearance(run: Run): RunChart[] {
  const values = run.steps.map((step) => step.clearance);
  const known = finite(values).filter((value) => value > 0);
  if (known.length === 0) {
    return [];
  }
  const unit = lengthUnit(least(known));
  const drawn = values.map((value) => (value === null || value <= 0 ? null : value / unit.size));
  const power = (value: number, round: (x: number) => number): number =>
    10 ** round(Math.log10(value / unit.size));
  const low = power(least(known), Math.floor);
  const content: ChartContent = {
    title: "apart by at least",
    unit: unit.name,
    range: [low, Math.max(power(most(known), Math.ceil), 10 * low)],
    logarithmic: true,
    lines: [steppedLine(run, drawn)],
    levels: [],
    bands: [],
  };
  return [{ name: "apart by at least", content, values, unitFor: lengthUnit }];
}

function impulse(run: Run): RunChart[] {
  const greatest = ({ impacts }: StepData): number =>
    most((impacts ?? []).map((impact) => length(impact.impulse)));
  return run.steps.some(({ impacts }) => impacts?.length)
    ? [amount(run, "greatest impact", impulseUnit, greatest)]
    : [];
}

function power(run: Run): RunChart[] {
  const powers = run.motorPowers;
  return powers ? [amount(run, "power of motors", powerUnit, (_, k) => powers[k]!)] : [];
}

const dynamic = (run: Run): RunChart[] =>
  run.hasDynamics
    ? [
        energy(run),
        amount(run, "greatest contact force", forceUnit, (_, k) => run.greatestForces[k]!),
      ]
    : [];

/// Charts of a haptic device.
///
/// @param of  what tells it from others
function deviceCharts(run: Run, { forces, torques, leads }: Device, of: string): RunChart[] {
  return [
    amount(run, `force on the device${of}`, forceUnit, (_, k) => forces[k]!),
    amount(run, `torque on the device${of}`, torqueUnit, (_, k) => torques[k]!),
    amount(run, `from the device to the tool${of}`, lengthUnit, (_, k) => leads[k]!),
  ];
}

export const runCharts = (run: Run, devices: readonly Device[]): RunChart[] => [
  ...dynamic(run),
  ...devices.flatMap((device) =>
    deviceCharts(run, device, devices.length > 1 ? `: ${device.name}` : ""),
  ),
  amount(run, "contacts", ones, (_, k) => run.contactCount(k)),
  amount(run, run.eventName.toLowerCase(), ones, ({ events }) => events),
  ...impulse(run),
  ...power(run),
  ...clearance(run),
  amount(run, "time lost", timeUnit, ({ time_lost }) => time_lost),
];

/// A chart's line as a small picture has it.
function sketchLine(
  { t, value, stepped }: ChartLine,
  { range, logarithmic }: ChartContent,
): SketchLine {
  const scaled = (x: number): number => (logarithmic ? Math.log10(x) : x);
  const from = (k: number): number[] => (stepped && k > 0 ? [t[k - 1]!, t[k]!] : [t[k]!]);
  return {
    t: t.flatMap((_, k) => from(k)),
    value: value.flatMap((x, k) => from(k).map(() => scaled(x))),
    range: [scaled(range[0]), scaled(range[1])],
  };
}

function row(
  chart: RunChart,
  run: Run,
  player: Player,
  shown: Signal<RunChart | null>,
): HTMLElement {
  const { name, content, values, unitFor } = chart;
  const button = chartButton(name, chart, shown, player, {
    textAt: (t) => {
      const value = values[run.stepAt(t)] ?? null;
      return quantity(value, unitFor(value ?? 0), 4);
    },
    pick: () => (shown.value = chart),
  });
  const line = content.lines.at(-1)!;
  return element("li.run-chart", {}, button, sketch(sketchLine(line, content), [], [], player));
}

export function runChartsPanel(
  run: Run,
  charts: readonly RunChart[],
  player: Player,
  shown: Signal<RunChart | null>,
): HTMLElement {
  return element(
    "section.card",
    { "aria-label": "Over time" },
    element("h2", {}, "Over time"),
    element("ul.rows", {}, ...charts.map((chart) => row(chart, run, player, shown))),
  );
}
