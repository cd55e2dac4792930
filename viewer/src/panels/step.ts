/// The current step: its facts, its contacts and its impacts.

import { element } from "../core/dom";
import {
  energyText,
  forceText,
  impulseText,
  lengthText,
  number,
  pointText,
  timeText,
  torqueText,
} from "../core/format";
import { Signal } from "../core/signal";
import type { Vector3 } from "../data/result";
import type { Model } from "../model";
import { add, distance, length, scale } from "../motion/vector";
import type { Player } from "../player";
import type { Run, RunContact, RunImpact } from "../run";
import type { SceneView } from "../view/scene_view";
import { factList } from "./facts";

const mostRows = 8;

const sizeText = (v: Vector3, unit: string): string => `${number(length(v))}\u00a0${unit}`;

/// What a haptic device feels as the step begins.
function deviceFacts({ devices }: Model, index: number): [string, string][] {
  return devices.flatMap(({ name, forces, torques, leads }): [string, string][] => {
    const of = devices.length > 1 ? ` on ${name}` : "";
    return [
      [`Force${of}`, forceText(forces[index]!)],
      [`Torque${of}`, torqueText(torques[index]!)],
      [devices.length > 1 ? `Device to ${name}` : "Device to tool", lengthText(leads[index]!)],
    ];
  });
}

function facts(model: Model, run: Run, index: number): [string, string][] {
  const step = run.steps[index]!;
  return [
    ["Ends at", timeText(step.time)],
    ["Lasts", timeText(step.lasted)],
    ...(step.time_lost > 0 ? [["Lost", timeText(step.time_lost)] as [string, string]] : []),
    ["Contacts", String(run.contactCount(index))],
    [
      "Apart",
      step.clearance === null ? "no pair" : `≥ ${lengthText(step.clearance, 4, { down: true })}`,
    ],
    ...deviceFacts(model, index),
    [run.eventName, String(step.events)],
    ...(run.hasDynamics
      ? ([
          ["Greatest contact force", forceText(run.greatestForces[index]!)],
          ["Kinetic energy", energyText(step.kinetic_energy)],
          ["Potential energy", energyText(step.potential_energy)],
          ["Momentum", sizeText(step.linear_momentum, "kg m/s")],
          ["Angular momentum", sizeText(step.angular_momentum, "kg m²/s")],
          ["Residual", `${number(step.residual, 2)} m/s`],
        ] as [string, string][])
      : []),
  ];
}

/// Where two bodies act on each other, and how.
function row(
  { bodies, point }: RunContact | RunImpact,
  said: string,
  model: Model,
  view: SceneView,
): HTMLElement {
  const [a, b] = bodies.map((body) => model.bodies[body]!);
  const lines = [said, `at ${pointText(point, 4)}`];
  return rowButton(`${a!.name} · ${b!.name}`, lines, () => view.focusPoint(point, [a!, b!]));
}

/// Makes a row of two names and the lines about them.
function rowButton(names: string, lines: readonly string[], look: () => void): HTMLElement {
  const button = element(
    "button.row-name.tall",
    { type: "button", title: `Look at ${names.replace(" · ", " and ")}` },
    element("span.name", {}, names),
    element("span.lines", {}, ...lines.map((line) => element("span", {}, line))),
  );
  button.addEventListener("click", look);
  return element("li", {}, button);
}

/// Calls with each step that comes under way.
function followSteps(run: Run, player: Player, show: (index: number) => void): void {
  const shown = new Signal(run.stepAt(player.t.value));
  shown.subscribe(show);
  player.t.subscribe((t) => (shown.value = run.stepAt(t)));
}

export function stepPanel(model: Model, run: Run, player: Player): HTMLElement {
  const count = element("span.count");
  const table = element("div");
  followSteps(run, player, (index) => {
    count.textContent = `${index + 1} of ${run.steps.length}`;
    table.replaceChildren(factList(facts(model, run, index)));
  });
  return element(
    "section.card",
    { "aria-label": "Step" },
    element("h2", {}, "Step ", count),
    table,
  );
}

/// The rows of a list in the panel, of which the first are shown.
interface Rows {
  readonly name: string;
  readonly less: string; ///< What there is less of in the rows that are left out.
  readonly of: (index: number) => HTMLElement[];
}

function rowsPanel(run: Run, player: Player, { name, less, of }: Rows): HTMLElement {
  const count = element("span.count");
  const list = element("ul.rows");
  const more = element("p.hint");
  followSteps(run, player, (index) => {
    const rows = of(index);
    count.textContent = String(rows.length);
    list.replaceChildren(...rows.slice(0, mostRows));
    more.hidden = rows.length <= mostRows;
    more.textContent = `${rows.length - mostRows} more, of less ${less}`;
  });
  return element(
    "section.card",
    { "aria-label": name },
    element("h2", {}, `${name} `, count),
    list,
    more,
  );
}

/// The contacts that acted at the end of the step, the greatest forces first.
export function stepContactsPanel(
  model: Model,
  run: Run,
  view: SceneView,
  player: Player,
): HTMLElement {
  const of = (index: number): HTMLElement[] =>
    run
      .contactsOf(index)
      .sort((a, b) => length(b.force) - length(a.force))
      .map((contact) => {
        const { force, distance } = contact;
        const said = `${forceText(length(force))}, ${lengthText(distance)} apart`;
        return row(contact, said, model, view);
      });
  return rowsPanel(run, player, { name: "Contacts", less: "force", of });
}

/// The ties of bodies, the greatest forces first; none if the run has no tie.
export function stepTiesPanel(
  model: Model,
  run: Run,
  view: SceneView,
  player: Player,
): HTMLElement[] {
  if (model.ties.length === 0) {
    return [];
  }
  const of = (index: number): HTMLElement[] =>
    [...model.ties]
      .sort((a, b) => b.forces[index]! - a.forces[index]!)
      .map((tie) => {
        const [a, b] = tie.ends(run.ends[index]!);
        const isLine = tie.type === "spring" || tie.type === "cable";
        const said = [
          `${tie.type}: ${forceText(tie.forces[index]!)}`,
          ...(isLine ? [`${lengthText(distance(a, b))} long`] : [`at ${pointText(a, 4)}`]),
        ];
        const bodies = tie.names.flatMap((name) => (name === null ? [] : [model.body(name)]));
        const names = tie.names.map((name) => name ?? "world").join(" · ");
        return rowButton(names, said, () => view.focusPoint(scale(0.5, add(a, b)), bodies));
      });
  return [rowsPanel(run, player, { name: "Ties", less: "force", of })];
}

/// The impacts of the step, the greatest impulses first; none where the run has no impact.
export function stepImpactsPanel(
  model: Model,
  run: Run,
  view: SceneView,
  player: Player,
): HTMLElement[] {
  if (run.impacts.length === 0) {
    return [];
  }
  const of = (index: number): HTMLElement[] =>
    run
      .impactsIn(index)
      .sort((a, b) => length(b.impulse) - length(a.impulse))
      .map((impact) => {
        const said = `${impulseText(length(impact.impulse))}, ${timeText(impact.t * run.duration)}`;
        return row(impact, said, model, view);
      });
  return [rowsPanel(run, player, { name: "Impacts", less: "impulse", of })];
}
