/// Puts the page of a live session together: the bodies, the forces, and the mouse that moves one.

import { Vector3 as Vector } from "three";
import { element } from "./core/dom";
import { forceText, lengthText, torqueText } from "./core/format";
import type { Vector3 } from "./data/result";
import { Display } from "./display";
import {
  Connection,
  lead,
  poseFrom,
  poseIn,
  type LiveSession,
  type LiveTool,
  type Picture,
} from "./live";
import type { Model } from "./model";
import { add, length, scale, zero } from "./motion/vector";
import { factList } from "./panels/facts";
import { Player } from "./player";
import { Theme } from "./theme";
import { setPose } from "./view/geometry_view";
import { LiveMarkers } from "./view/live_markers";
import { SceneView } from "./view/scene_view";

const turnPerPixel = 0.005; // [rad]
const wheelPixels = 0.2; // Of a drag, for each pixel of the wheel.

/// Drags that begin on the tool move it; with Shift they turn it. The wheel pushes it meanwhile.
function listenToDrags(view: SceneView, tool: LiveTool, connection: Connection): void {
  const { canvas, camera } = view;
  const side = (column: number): Vector3 =>
    new Vector().setFromMatrixColumn(camera.matrixWorld, column).toArray();
  const perPixel = (): number => {
    const depth = camera.position.distanceTo(
      new Vector().setFromMatrixPosition(view.bodies[tool.body]!.group.matrix),
    );
    const slope = Math.tan((0.5 * camera.fov * Math.PI) / 180);
    return (2 * depth * slope) / canvas.clientHeight;
  };
  const along = (right: number, x: number, up: number, y: number): Vector3 =>
    add(scale(x, side(right)), scale(y, side(up)));
  const isTool = ({ x, y }: PointerEvent): boolean => {
    const hit = view.hitAt(x, y)?.object.userData as { body: number } | undefined;
    return hit !== undefined && (hit.body === tool.body || tool.links.includes(hit.body));
  };
  let held = false;
  canvas.parentElement!.addEventListener(
    "pointerdown",
    (event) => {
      if (event.target === canvas && event.button === 0 && isTool(event)) {
        held = true;
        canvas.setPointerCapture(event.pointerId);
        event.stopPropagation(); // The view stands still.
      }
    },
    { capture: true },
  );
  canvas.addEventListener("pointermove", ({ shiftKey, movementX: x, movementY: y }) => {
    if (!held) {
      return;
    }
    if (shiftKey) {
      connection.handle.turnBy(scale(turnPerPixel, along(1, x, 0, y)));
    } else {
      connection.handle.move(scale(perPixel(), along(0, x, 1, -y)));
    }
    connection.send();
  });
  canvas.parentElement!.addEventListener(
    "wheel",
    (event) => {
      if (held) {
        event.stopPropagation();
        event.preventDefault();
        connection.handle.move(scale(wheelPixels * perPixel() * event.deltaY, side(2)));
        connection.send();
      }
    },
    { capture: true, passive: false },
  );
  for (const end of ["pointerup", "pointercancel"] as const) {
    canvas.addEventListener(end, () => (held = false));
  }
}

/// A slider for the fingers of a hand: it closes all grips together.
function gripSlider(connection: () => Connection): HTMLElement {
  const slider = element("input", {
    type: "range",
    min: "0",
    max: "1",
    step: "0.005",
    value: "0",
    "aria-label": "Grip",
  }) as HTMLInputElement;
  slider.addEventListener("input", () => {
    connection().handle.grip = slider.valueAsNumber;
    connection().send();
  });
  return element("label.grip", {}, "Grip ", slider);
}

/// The centre of a tool, in its frame: it follows the handle.
const centreOf = (model: Model, { body }: LiveTool): Vector3 =>
  model.bodies[body]!.course?.centre ?? zero;

/// The forces on the hands, tool by tool.
function forceFacts(model: Model, { tools }: LiveSession, picture: Picture): [string, string][] {
  return tools.flatMap((tool, k): [string, string][] => {
    const { name } = model.bodies[tool.body]!;
    const [on, ahead] =
      tools.length > 1 ? [` on ${name}`, `Hand ahead of ${name} by`] : ["", "The hand is ahead by"];
    const shown = picture.tools[k]!;
    const pose = poseIn(picture, tool.body);
    return [
      [`Force${on}`, forceText(length(shown.force))],
      [`Torque${on}`, torqueText(length(shown.torque))],
      [ahead, lengthText(pose ? lead(shown, pose, centreOf(model, tool)) : 0)],
    ];
  });
}

const hints = (): HTMLElement[] => [
  element("p.hint", {}, "Drag the tool to move it, with Shift to turn it."),
  element("p.hint", {}, "The wheel pushes a held tool away. Drags beside it turn the view."),
];

export function startLive(model: Model, live: LiveSession): void {
  document.title = `${model.title} · firstcontact`;
  const theme = new Theme();
  const stage = element("main.stage");
  const facts = element("div");
  const state = element("p", { role: "status" }, "Connecting …");
  const mouse = live.mouse === undefined ? null : live.tools[live.mouse]!;
  const card = element(
    "section.card",
    { "aria-label": "Live" },
    element("h1", {}, model.title),
    state,
    facts,
    ...(mouse ? hints() : []),
  );
  if (live.grips) {
    card.append(gripSlider(() => connection));
  }
  const panel = element("aside.panel", { "aria-label": "Details" }, card);
  document.body.append(element("div.app.panel-open", {}, stage, panel));
  const view = new SceneView(model, new Player(model.duration, null), new Display(), stage);
  const markers = new LiveMarkers(
    live.tools.map((tool) => ({
      view: view.bodies[tool.body]!,
      links: tool.links.map((link) => view.bodies[link]!),
      centre: centreOf(model, tool),
      size: view.bounds.bodiesAt([model.bodies[tool.body]!], 0).radius,
    })),
  );
  view.scene.add(markers.group);
  const show = (picture: Picture): void => {
    for (const [body, ...pose] of picture.bodies) {
      setPose(view.bodies[body!]!.group, poseFrom(pose));
    }
    markers.show(picture);
    state.textContent =
      live.tools.length > 1
        ? "The tools pass through nothing."
        : "The tool passes through nothing.";
    facts.replaceChildren(
      factList([
        ...forceFacts(model, live, picture),
        ["Contacts", String(picture.contacts.length)],
      ]),
    );
    view.requestFrame();
  };
  const connection = new Connection(show, () => {
    state.textContent = "The session is over, or another page has it.";
  });
  theme.name.subscribe(() => view.setColors(theme.color("stage"), theme.color("grid")));
  view.start();
  setTimeout(() => {
    view.addEdges();
    markers.makeGhosts();
  });
  if (mouse) {
    listenToDrags(view, mouse, connection);
  }
  Object.assign(window, { firstcontact: { model, view, connection, markers } });
}
