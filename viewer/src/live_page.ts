/// Puts the page of a live session together: the bodies, the mouse that moves one, the forces.

import { Vector3 as Vector } from "three";
import { element } from "./core/dom";
import { forceText, lengthText, number } from "./core/format";
import type { Vector3 } from "./data/result";
import { Display } from "./display";
import { Connection, lead, poseFrom, type LiveTool, type Picture } from "./live";
import type { Model } from "./model";
import { add, length, scale } from "./motion/vector";
import { factList } from "./panels/facts";
import { Player } from "./player";
import { Theme } from "./theme";
import { setPose } from "./view/geometry_view";
import { LiveMarkers } from "./view/live_markers";
import { SceneView } from "./view/scene_view";

const turnPerPixel = 0.005; // [rad]
const wheelPixels = 0.2; // Of a drag, for each pixel of the wheel.

/// Drags that begin on the tool move it; with Shift they turn it. The wheel pushes it meanwhile.
function listenToDrags(view: SceneView, live: LiveTool, connection: Connection): void {
  const { tool, links = [] } = live;
  const { canvas, camera } = view;
  const side = (column: number): Vector3 =>
    new Vector().setFromMatrixColumn(camera.matrixWorld, column).toArray();
  const perPixel = (): number => {
    const depth = camera.position.distanceTo(
      new Vector().setFromMatrixPosition(view.bodies[tool]!.group.matrix),
    );
    const slope = Math.tan((0.5 * camera.fov * Math.PI) / 180);
    return (2 * depth * slope) / canvas.clientHeight;
  };
  const along = (right: number, x: number, up: number, y: number): Vector3 =>
    add(scale(x, side(right)), scale(y, side(up)));
  const isTool = ({ x, y }: PointerEvent): boolean => {
    const hit = view.hitAt(x, y)?.object.userData as { body: number } | undefined;
    return hit !== undefined && (hit.body === tool || links.includes(hit.body));
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

/// @param live  what follows the mouse
export function startLive(model: Model, live: LiveTool): void {
  const { tool } = live;
  document.title = `${model.title} · firstcontact`;
  const theme = new Theme();
  const display = new Display();
  const stage = element("main.stage");
  const facts = element("div");
  const state = element("p", { role: "status" }, "Connecting …");
  const card = element(
    "section.card",
    { "aria-label": "Live" },
    element("h1", {}, model.title),
    state,
    facts,
    element("p.hint", {}, "Drag the tool to move it, with Shift to turn it."),
    element("p.hint", {}, "The wheel pushes a held tool away. Drags beside it turn the view."),
  );
  if (live.grips) {
    card.append(gripSlider(() => connection));
  }
  const panel = element("aside.panel", { "aria-label": "Details" }, card);
  document.body.append(element("div.app.panel-open", {}, stage, panel));
  const view = new SceneView(model, new Player(model.duration, null), display, stage);
  const markers = new LiveMarkers(view.bounds.bodiesAt([model.bodies[tool]!], 0).radius);
  view.scene.add(markers.group);
  const show = (picture: Picture): void => {
    for (const [body, ...pose] of picture.bodies) {
      setPose(view.bodies[body!]!.group, poseFrom(pose));
    }
    markers.show(picture);
    state.textContent = "The tool passes through nothing.";
    facts.replaceChildren(
      factList([
        ["Force", forceText(length(picture.force))],
        ["Torque", `${number(length(picture.torque), 3)} N m`],
        ["Contacts", String(picture.contacts.length)],
        ["The hand is ahead by", lengthText(lead(picture, tool))],
      ]),
    );
    view.requestFrame();
  };
  const connection = new Connection(show, () => {
    state.textContent = "The session is over, or another page has it.";
  });
  theme.name.subscribe(() => view.setColors(theme.color("stage"), theme.color("grid")));
  view.start();
  setTimeout(() => view.addEdges());
  listenToDrags(view, live, connection);
  Object.assign(window, { firstcontact: { model, view, connection } });
}
