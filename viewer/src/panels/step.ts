/// The step that is under way: its facts, and what touches.

import { element } from "../core/dom";
import { energyText, forceText, lengthText, number, pointText, timeText } from "../core/format";
import { Signal } from "../core/signal";
import type { Vector3 } from "../data/result";
import type { Model } from "../model";
import { length } from "../motion/vector";
import type { Player } from "../player";
import type { Run, RunContact } from "../run";
import type { SceneView } from "../view/scene_view";
import { factList } from "./facts";

const mostRows = 8;

const sizeText = (v: Vector3, unit: string): string => `${number(length(v))}\u00a0${unit}`;

function facts(run: Run, index: number): [string, string][] {
  const step = run.steps[index]!;
  return [
    ["Ends at", timeText(step.time)],
    ["Lasts", timeText(step.lasted)],
    ...(step.time_lost > 0 ? [["Lost", timeText(step.time_lost)] as [string, string]] : []),
    ["Contacts", String(run.contactCount(index))],
    [
      "Apart",
      step.clearance === null ? "one body" : `≥ ${lengthText(step.clearance, 4, { down: true })}`,
    ],
    ["Impacts", String(step.events)],
    ["Greatest force", forceText(run.greatestForces[index]!)],
    ["Kinetic energy", energyText(step.kinetic_energy)],
    ["Potential energy", energyText(step.potential_energy)],
    ["Momentum", sizeText(step.linear_momentum, "kg m/s")],
    ["Angular momentum", sizeText(step.angular_momentum, "kg m²/s")],
    ["Residual", `${number(step.residual, 2)} m/s`],
  ];
}

function row(contact: RunContact, model: Model, view: SceneView): HTMLElement {
  const [a, b] = contact.bodies.map((body) => model.bodies[body]!);
  const lines = [
    `${forceText(length(contact.force))}, ${lengthText(contact.distance)} apart`,
    `at ${pointText(contact.point, 4)}`,
  ];
  const button = element(
    "button.row-name.tall",
    { type: "button", title: `Look at ${a!.name} and ${b!.name}` },
    element("span.name", {}, `${a!.name} · ${b!.name}`),
    element("span.lines", {}, ...lines.map((line) => element("span", {}, line))),
  );
  button.addEventListener("click", () => view.focusPoint(contact.point, [a!, b!]));
  return element("li", {}, button);
}

/// Calls with each step that comes under way.
function followSteps(run: Run, player: Player, show: (index: number) => void): void {
  const shown = new Signal(run.stepAt(player.t.value));
  shown.subscribe(show);
  player.t.subscribe((t) => (shown.value = run.stepAt(t)));
}

export function stepPanel(run: Run, player: Player): HTMLElement {
  const count = element("span.count");
  const table = element("div");
  followSteps(run, player, (index) => {
    count.textContent = `${index + 1} of ${run.steps.length}`;
    table.replaceChildren(factList(facts(run, index)));
  });
  return element(
    "section.card",
    { "aria-label": "Step" },
    element("h2", {}, "Step ", count),
    table,
  );
}

/// What acted in the step, the greatest forces first.
export function stepContactsPanel(
  model: Model,
  run: Run,
  view: SceneView,
  player: Player,
): HTMLElement {
  const count = element("span.count");
  const list = element("ul.rows");
  const more = element("p.hint");
  followSteps(run, player, (index) => {
    const contacts = run.contactsOf(index).sort((a, b) => length(b.force) - length(a.force));
    count.textContent = String(contacts.length);
    list.replaceChildren(...contacts.slice(0, mostRows).map((one) => row(one, model, view)));
    more.hidden = contacts.length <= mostRows;
    more.textContent = `${contacts.length - mostRows} more, of less force`;
  });
  return element(
    "section.card",
    { "aria-label": "Contacts" },
    element("h2", {}, "Contacts ", count),
    list,
    more,
  );
}
