/// The bodies: show, hide, look at one.

import { element, icon } from "../core/dom";
import { icons } from "../core/icons";
import type { Display } from "../display";
import type { Model } from "../model";
import type { SceneView } from "../view/scene_view";

const mostRows = 200;
const filterFrom = 12; // Bodies; fewer are seen at a glance.

const motionNames: Readonly<Record<string, string>> = {
  constant_velocity: "constant velocity",
  screw: "screw",
  waypoints: "waypoints",
  vertices: "deforms",
  fixed: "at rest",
};

export function bodiesPanel(model: Model, view: SceneView, display: Display): HTMLElement {
  const list = element("ul.rows");
  const more = element("p.hint", { hidden: true });
  const buttons = new Map<number, HTMLButtonElement>();

  const row = (index: number): HTMLElement => {
    const { body, color } = view.bodies[index]!;
    const eye = element(
      "button.icon-button.small",
      { type: "button", "aria-label": `Show ${body.name}`, title: `Show or hide ${body.name}` },
      icon(icons.eye),
    );
    eye.addEventListener("click", () => display.setVisible(index, !display.isVisible(index)));
    buttons.set(index, eye);
    const key = index < 9 ? ` (${index + 1})` : "";
    const name = element(
      "button.row-name",
      { type: "button", title: `Look at ${body.name}${key}` },
      element("span.swatch", { style: `background:${color}` }),
      element("span.name", {}, body.name),
      element("span.detail", {}, motionNames[body.data.motion?.type ?? "fixed"] ?? ""),
    );
    name.addEventListener("click", () => view.focusBody(body));
    return element("li", {}, name, eye);
  };

  const fill = (filter: string): void => {
    buttons.clear();
    const found = model.bodies.filter(({ name }) =>
      name.toLowerCase().includes(filter.toLowerCase()),
    );
    list.replaceChildren(...found.slice(0, mostRows).map(({ index }) => row(index)));
    more.hidden = found.length <= mostRows;
    more.textContent = `${found.length - mostRows} more; type to find one`;
    showHidden(display.hidden.value);
  };

  const showHidden = (hidden: ReadonlySet<number>): void => {
    buttons.forEach((button, index) => {
      button.setAttribute("aria-pressed", String(!hidden.has(index)));
      button.replaceChildren(icon(hidden.has(index) ? icons.hidden : icons.eye));
    });
  };

  const search = element("input.filter", {
    type: "search",
    placeholder: "Find a body",
    "aria-label": "Find a body",
    hidden: model.bodies.length < filterFrom,
  });
  search.addEventListener("input", () => fill(search.value));
  fill("");
  display.hidden.subscribe(showHidden);
  return element(
    "section.card",
    { "aria-label": "Bodies" },
    element("h2", {}, "Bodies ", element("span.count", {}, String(model.bodies.length))),
    search,
    list,
    more,
  );
}
