/// What was found, in one card.

import { element } from "../core/dom";
import { lengthText, number, timeText } from "../core/format";
import type { Model } from "../model";

const words = {
  free: "Free",
  contact: "Contact",
  contact_at_start: "In contact at the start",
  undecided: "Undecided",
} as const;

function sentence(model: Model): string {
  const { verdict, pair, time, reason } = model.result;
  const who = pair ? `${pair[0]} and ${pair[1]}` : "the bodies";
  switch (verdict) {
    case "free":
      return `Proven: nothing touches during the whole ${timeText(model.duration)}.`;
    case "contact":
      return `Proven free until ${timeText(time)}; then ${who} touch.`;
    case "contact_at_start":
      return `At the start ${who} touch.`;
    case "undecided":
      return `Proven free until ${timeText(time)}; nothing is said of later (${reason}).`;
  }
}

function facts(model: Model): [string, string][] {
  const { result } = model;
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
  list.push(["Triangles", model.triangleCount.toLocaleString("en").replaceAll(",", " ")]);
  return list;
}

export function summaryPanel(model: Model): HTMLElement {
  const { verdict, id } = model.result;
  return element(
    "section.card",
    { "aria-label": "Answer" },
    element("h1", {}, id || "Scene"),
    element("p.verdict", { "data-verdict": verdict }, words[verdict]),
    element("p", {}, sentence(model)),
    element(
      "dl.facts",
      {},
      ...facts(model).flatMap(([name, value]) => [
        element("dt", {}, name),
        element("dd", {}, value),
      ]),
    ),
  );
}
