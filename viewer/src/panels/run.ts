/// The summary of a run, in one card.

import { element } from "../core/dom";
import {
  energyText,
  forceText,
  impulseText,
  lengthText,
  number,
  timeText,
  torqueText,
} from "../core/format";
import type { Model } from "../model";
import { length } from "../motion/vector";
import type { Run } from "../run";
import { factList } from "./facts";
import { noneOf, noPair, untestedPairs } from "./pair_facts";
import { verdictLine } from "./verdict";

const sum = (values: readonly number[]): number => values.reduce((total, x) => total + x, 0);
const least = (values: readonly number[]): number => values.reduce((a, b) => Math.min(a, b));
const most = (values: readonly number[]): number => values.reduce((a, b) => Math.max(a, b));

function facts(model: Model, run: Run): [string, string][] {
  const { steps } = run;
  const clearances = steps.flatMap(({ clearance }) => (clearance === null ? [] : [clearance]));
  const energies = steps.map((step) => step.kinetic_energy + step.potential_energy);
  const impulses = run.impacts.map(({ impulse }) => length(impulse));
  const lost = sum(steps.map(({ time_lost }) => time_lost));
  return [
    ["Steps", `${steps.length}, ${timeText(run.duration)}`],
    ["Bodies", `${run.linksFrom}, ${run.freeCount} free`],
    ...(run.linkCount > 0 ? [["Links", String(run.linkCount)] as [string, string]] : []),
    [
      "Apart",
      clearances.length > 0
        ? `≥ ${lengthText(least(clearances), 4, { down: true })}`
        : "no pair to keep apart",
    ],
    [run.eventName, String(sum(steps.map(({ events }) => events)))],
    ...(impulses.length > 0
      ? [["Greatest impact", impulseText(most(impulses))] as [string, string]]
      : []),
    ...(run.hasDynamics
      ? ([
          ["Greatest contact force", forceText(most(run.greatestForces))],
          ["Energy after step 1", energyText(energies[0]!)],
          ["Energy at the end", energyText(energies.at(-1)!)],
        ] as [string, string][])
      : []),
    ...model.devices.flatMap(({ name, forces, torques }): [string, string][] => {
      const of = model.devices.length > 1 ? ` on ${name}` : "";
      return [
        [`Greatest force${of}`, forceText(most(forces))],
        [`Greatest torque${of}`, torqueText(most(torques))],
      ];
    }),
    ["Time lost", lost > 0 ? timeText(lost) : "none"],
    ...(run.hasDynamics
      ? [
          ["Residual", `≤ ${number(most(steps.map(({ residual }) => residual)), 2)} m/s`] as [
            string,
            string,
          ],
        ]
      : []),
    ["Triangles", model.triangleCount.toLocaleString("en").replaceAll(",", " ")],
  ];
}

/// Of a whole run, or of one that was stopped.
function sentence({ pairCounts }: Model, run: Run): string {
  if (pairCounts?.tested === 0) {
    return noPair;
  }
  const claim = noneOf(pairCounts, "interpenetrates");
  return run.isWhole
    ? `During all of it ${claim}.`
    : `After ${timeText(run.duration)} of ${timeText(run.asked)}; until then ${claim}.`;
}

export function runPanel(model: Model, run: Run): HTMLElement {
  return element(
    "section.card",
    { "aria-label": "Run" },
    element("h1", {}, model.title),
    verdictLine(model),
    element("p", {}, sentence(model, run)),
    factList(facts(model, run)),
    ...untestedPairs(model.pairCounts),
  );
}
