/// The answer, in one card.

import { element } from "../core/dom";
import { lengthText, quantity, timeText } from "../core/format";
import type { Result } from "../data/result";
import type { Model } from "../model";
import { factList } from "./facts";
import { noneOf, noPair, untestedPairs } from "./pair_facts";
import { verdictLine } from "./verdict";

const one = { name: "", size: 1 };

function sentence(model: Model, result: Result): string {
  if (model.path?.failed) {
    const goal = model.path.data.goal.length > 0 ? ", and the goal as a ghost" : "";
    return `No path was found. The page shows the start${goal}.`;
  }
  const { duration, pairCounts } = model;
  const { verdict, pair, time, reason } = result;
  const until = timeText(time, 5, { grain: model.timeGrain(result), down: true });
  const who = pair ? `${pair[0]} and ${pair[1]}` : "the bodies";
  switch (verdict) {
    case "free":
      return pairCounts?.tested === 0
        ? noPair
        : `Proven: ${noneOf(pairCounts, "touches")} during the whole ${timeText(duration)}.`;
    case "contact":
      return `Proven free until ${until}; then ${who} touch.`;
    case "contact_at_start":
      return `At the start ${who} touch.`;
    case "undecided":
      return `Proven free until ${until}; nothing is said of later (${reason}).`;
  }
}

function facts(model: Model, result: Result): [string, string][] {
  if (model.path?.failed) {
    return [];
  }
  const { margin } = result.scene.options;
  const { grain } = model;
  const list: [string, string][] = [];
  if (result.verdict !== "free") {
    list.push([
      "Proven free",
      `t < ${quantity(result.t, one, 6, { grain: model.timeGrain(result) / model.duration, down: true })}`,
    ]);
  }
  if (result.clearance !== null && result.clearance > 0) {
    list.push(["Clearance", `≥ ${lengthText(result.clearance, 4, { grain, down: true })}`]);
  }
  if (result.closest) {
    list.push([
      "Closest",
      `${lengthText(result.closest.distance, 4, { grain })} at ${timeText(result.closest.time, 4)}`,
    ]);
  }
  if (margin > 0) {
    list.push(["Margin", lengthText(margin)]);
  }
  if (grain > 0) {
    const enclosure = result.enclosure_error ?? 0;
    const curved = enclosure > 0 ? `, and ${lengthText(enclosure, 2)} of curved shapes` : "";
    list.push(["Tolerance", `${lengthText(grain - enclosure, 2)}${curved}`]);
  }
  list.push(["Duration", timeText(model.duration)]);
  list.push(["Triangles", model.triangleCount.toLocaleString("en").replaceAll(",", " ")]);
  return list;
}

export function summaryPanel(model: Model, result: Result): HTMLElement {
  return element(
    "section.card",
    { "aria-label": "Answer" },
    element("h1", {}, model.title),
    verdictLine(model),
    element("p", {}, sentence(model, result)),
    factList(facts(model, result)),
    ...(model.path?.failed ? [] : untestedPairs(model.pairCounts)),
  );
}
