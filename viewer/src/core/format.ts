/// Quantities as people read them.

import type { Vector3 } from "../data/result";

export interface Unit {
  readonly name: string;
  readonly size: number;
}

const lengths: readonly Unit[] = [
  { name: "km", size: 1e3 },
  { name: "m", size: 1 },
  { name: "mm", size: 1e-3 },
  { name: "µm", size: 1e-6 },
  { name: "nm", size: 1e-9 },
];
const times: readonly Unit[] = [
  { name: "s", size: 1 },
  { name: "ms", size: 1e-3 },
  { name: "µs", size: 1e-6 },
];

const energies: readonly Unit[] = [
  { name: "GJ", size: 1e9 },
  { name: "MJ", size: 1e6 },
  { name: "kJ", size: 1e3 },
  { name: "J", size: 1 },
  { name: "mJ", size: 1e-3 },
  { name: "µJ", size: 1e-6 },
  { name: "nJ", size: 1e-9 },
];
const forces: readonly Unit[] = [
  { name: "GN", size: 1e9 },
  { name: "MN", size: 1e6 },
  { name: "kN", size: 1e3 },
  { name: "N", size: 1 },
  { name: "mN", size: 1e-3 },
  { name: "µN", size: 1e-6 },
];

const torques: readonly Unit[] = [
  { name: "N m", size: 1 },
  { name: "mN m", size: 1e-3 },
  { name: "µN m", size: 1e-6 },
];

const powers: readonly Unit[] = [
  { name: "GW", size: 1e9 },
  { name: "MW", size: 1e6 },
  { name: "kW", size: 1e3 },
  { name: "W", size: 1 },
  { name: "mW", size: 1e-3 },
  { name: "µW", size: 1e-6 },
];

const impulses: readonly Unit[] = [
  { name: "kN s", size: 1e3 },
  { name: "N s", size: 1 },
  { name: "mN s", size: 1e-3 },
  { name: "µN s", size: 1e-6 },
];

/// As it is shown with so many digits, so that 999.99 µm are 1 mm; what is cut stays as it is.
const shownAs = (value: number, digits: number, { down = false }: Rounding = {}): number =>
  down ? value : Number(value.toPrecision(digits));

const unitFor = (units: readonly Unit[], base: Unit, value: number): Unit =>
  value === 0 ? base : (units.find(({ size }) => Math.abs(value) >= size) ?? units.at(-1)!);

/// The unit in which numbers of this size are best read.
export const lengthUnit = (value: number): Unit => unitFor(lengths, lengths[1]!, value);
export const timeUnit = (value: number): Unit => unitFor(times, times[0]!, value);

export const energyUnit = (value: number): Unit => unitFor(energies, energies[3]!, value);
export const forceUnit = (value: number): Unit => unitFor(forces, forces[3]!, value);
export const torqueUnit = (value: number): Unit => unitFor(torques, torques[0]!, value);
export const impulseUnit = (value: number): Unit => unitFor(impulses, impulses[1]!, value);
export const powerUnit = (value: number): Unit => unitFor(powers, powers[3]!, value);

/// A true minus sign, and no more digits than asked.
export function number(value: number, digits = 4): string {
  if (value === 0) {
    return "0";
  }
  const size = Math.abs(value);
  const text =
    size >= 1e-4 && size < 1e7
      ? String(Number(value.toPrecision(digits)))
      : value.toExponential(digits - 1);
  return text.replace("-", "−");
}

/// How a quantity is rounded, beside the most digits that it has.
export interface Rounding {
  /// In the unit of the quantity: digits below it say nothing, and are left out. 0: none are.
  readonly grain?: number;
  /// Towards zero: what is proven of a number is proven of a smaller one too.
  readonly down?: boolean;
}

/// The power of ten of the last digit that a grain leaves.
const lastPlace = (grain: number): number => Math.ceil(Math.log10(grain) - 1e-9);

/// Towards zero, unless the value is the rounded one but for the rounding of doubles.
function cutTo(value: number, digits: number): number {
  const scale = 10 ** (digits - 1 - Math.floor(Math.log10(Math.abs(value))));
  const near = Math.round(value * scale);
  const same = Math.abs(value * scale - near) <= 1e-12 * Math.abs(near);
  return (same ? near : Math.trunc(value * scale)) / scale;
}

/// Without a value a dash; "< 1 µm" of one that is less than its last digit would be.
export function quantity(
  value: number | null,
  unit: Unit,
  digits: number,
  { grain = 0, down = false }: Rounding = {},
): string {
  const end = unit.name && `\u00a0${unit.name}`;
  if (value === null || value === 0) {
    return value === null ? "—" : `0${end}`;
  }
  const place = grain > 0 ? lastPlace(grain) : -Infinity;
  const kept = Math.min(digits, Math.floor(Math.log10(Math.abs(value))) - place + 1);
  if (kept < 1 && !down) {
    return `< ${number(10 ** place / unit.size, 1)}${end}`;
  }
  const shown = down ? cutTo(value, Math.max(kept, 1)) : value;
  return `${number(shown / unit.size, Math.max(kept, 1))}${end}`;
}

export const lengthText = (value: number | null, digits = 4, rounding: Rounding = {}): string =>
  quantity(
    value,
    lengthUnit(Math.max(Math.abs(shownAs(value ?? 0, digits, rounding)), rounding.grain ?? 0)),
    digits,
    rounding,
  );
export const timeText = (value: number | null, digits = 5, rounding: Rounding = {}): string =>
  quantity(value, timeUnit(shownAs(value ?? 0, digits, rounding)), digits, rounding);

export const energyText = (value: number, digits = 4): string =>
  quantity(value, energyUnit(shownAs(value, digits)), digits);
export const torqueText = (value: number, digits = 3): string =>
  quantity(value, torqueUnit(value), digits);
export const forceText = (value: number, digits = 3): string =>
  quantity(value, forceUnit(shownAs(value, digits)), digits);
export const impulseText = (value: number, digits = 3): string =>
  quantity(value, impulseUnit(shownAs(value, digits)), digits);

/// "(x, y, z) mm", all in the unit of the greatest and with no digit below the grain.
export function pointText(point: Vector3, digits = 6, grain = 0): string {
  const unit = lengthUnit(Math.max(...point.map(Math.abs)));
  const place = grain > 0 ? 10 ** lastPlace(grain) : 0;
  const kept = (x: number): number => (place > 0 ? Math.round(x / place) * place : x);
  return `(${point.map((x) => number(kept(x) / unit.size, digits)).join(", ")}) ${unit.name}`;
}

/// Unit vectors have no unit.
export const directionText = (direction: Vector3): string =>
  `(${direction.map((x) => x.toFixed(3).replace("-0.000", "0.000").replace("-", "−")).join(", ")})`;
