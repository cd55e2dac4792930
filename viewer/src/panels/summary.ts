/// What was found, in one card.

import { element } from "../core/dom";
import { lengthText, number, timeText } from "../core/format";
import type { Result } from "../data/result";
import type { Model } from "../model";
import { factList } from "./facts";
import { noneOf, noPair, pairFacts } from "./pair_facts";

const words = {
  free: "Free",
  contact: "Contact",
  contact_at_start: "In contact at the start",
  undecided: "Undecided",
} as const;

function sentence(
  { duration, pairCounts }: Model,
  { verdict, pair, time, reason }: Result,
): string {
  const who = pair ? `${pair[0]} and ${pair[1]}` : "the bodies";
  switch (verdict) {
    case "free":
      return pairCounts?.tested === 0
        ? noPair
        : `Proven: ${noneOf(pairCounts, "touches")} during the whole ${timeText(duration)}.`;
    case "contact":
      return `Proven free until ${timeText(time)}; then ${who} touch.`;
    case "contact_at_start":
      return `At the start ${who} touch.`;
    case "undecided":
      return `Proven free until ${timeText(time)}; nothing is said of later (${reason}).`;
  }
}

function facts(model: Model, result: Result): [string, string][] {
  const { margin } = result.scene.options;
  const list: [string, string][] = [];
  if (result.verdict !== "free") {
    list.push(["Proven free", `t < ${number(result.t, 9)}`]);
  }
  if (result.clearance !== null && result.clearance > 0) {
    list.push(["Clearance", `≥ ${lengthText(result.clearance)}`]);
  }
  if (result.closest) {
    list.push([
      "Closest",
      `${lengthText(result.closest.distance)} at ${timeText(result.closest.time)}`,
    ]);
  }
  if (margin > 0) {
    list.push(["Margin", lengthText(margin)]);
  }
  list.push(["Duration", timeText(model.duration)]);
  list.push(...pairFacts(model.pairCounts));
  list.push(["Triangles", model.triangleCount.toLocaleString("en").replaceAll(",", " ")]);
  return list;
}

export function summaryPanel(model: Model, result: Result): HTMLElement {
  const { verdict } = result;
  return element(
    "section.card",
    { "aria-label": "Answer" },
    element("h1", {}, model.title),
    element("p.verdict", { "data-verdict": verdict }, words[verdict]),
    element("p", {}, sentence(model, result)),
    factList(facts(model, result)),
  );
}
