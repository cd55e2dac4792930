/// The gap over time: samples, and the proven bound below them.

import { lengthUnit } from "../core/format";
import type { GapLine } from "../data/page_data";
import type { Model } from "../model";
import type { ChartContent, ChartLine } from "./time_chart";

/// Null where nothing is tested.
export function gapContent({ gap, gapBound, pairs }: Model): ChartContent | null {
  if (gap.t.length < 2) {
    return null;
  }
  const greatest = Math.max(...gap.distance, 0);
  const unit = lengthUnit(greatest);
  const line = ({ t, distance }: GapLine, look: Omit<ChartLine, "t" | "value">): ChartLine => ({
    t,
    value: distance.map((d) => d / unit.size),
    ...look,
  });
  return {
    title: "gap",
    unit: unit.name,
    range: [0, (1.08 * (greatest || 1)) / unit.size],
    lines: [
      line(gap, { color: "accent", width: 2 }),
      line(gapBound, { color: "proven", width: 1, fill: "chart-bound" }),
    ],
    levels: [],
    // The intervals of contact of a pair, if the result has all of them.
    bands: pairs
      .flatMap(({ intervals = [] }) => intervals)
      .map(({ enter, leave }) => ({ from: enter, to: leave, color: "chart-contact" })),
  };
}
