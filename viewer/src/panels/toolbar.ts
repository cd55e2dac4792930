/// The buttons that switch parts of the picture on, and those that save files.

import { element, iconButton } from "../core/dom";
import { icons } from "../core/icons";
import type { Signal } from "../core/signal";
import type { Commands } from "../commands";
import type { Display } from "../display";
import type { Model } from "../model";
import { cutBar } from "./cut_bar";

function toggle(path: string, label: string, key: string | null, signal: Signal<boolean>) {
  const button = iconButton(path, label, key, () => (signal.value = !signal.value));
  signal.subscribe((on) => button.setAttribute("aria-pressed", String(on)));
  return button;
}

function cutButton(display: Display): HTMLElement {
  const button = iconButton(icons.cutaway, "Cut away what is in front", "k", () =>
    display.toggleCut(),
  );
  display.cut.subscribe((cut) => button.setAttribute("aria-pressed", String(cut !== null)));
  return button;
}

const forcesName = ({ devices }: Model): string =>
  devices.length > 0 ? "Forces on devices" : "Contact forces";

export function toolbar(
  model: Model,
  { display, commands }: Commands,
  panelOpen: Signal<boolean>,
): HTMLElement {
  const panel = toggle(icons.panel, "Side panel", "p", panelOpen);
  const look = element(
    "div.tool-group",
    { role: "group", "aria-label": "Look" },
    iconButton(icons.fit, "Show everything", "f", commands.fit),
    toggle(icons.wireframe, "Wireframe", "w", display.wireframe),
    toggle(icons.xray, "X-ray", "x", display.xray),
    cutButton(display),
    toggle(icons.edges, "Edges", "e", display.edges),
    toggle(icons.ghosts, "Ghosts of start and end", "g", display.ghosts),
    toggle(icons.onion, "Onion skin of the sweep", "o", display.onion),
    ...(model.hasLooks
      ? [toggle(icons.visual, "Visual in place of collision geometry", "v", display.looks)]
      : []),
    toggle(icons.marker, "Contact points", "c", display.contacts),
    ...(model.run ? [toggle(icons.force, forcesName(model), "a", display.forces)] : []),
    ...(model.devices.length > 0
      ? [toggle(icons.hand, "Where devices lead the tools", "d", display.devices)]
      : []),
    ...(model.path && !model.path.failed
      ? [toggle(icons.route, "Path, coloured by clearance", "r", display.path)]
      : []),
    ...(model.path?.hasTrees ? [toggle(icons.tree, "Search tree", "b", display.trees)] : []),
    toggle(icons.measure, "Measure a distance", "m", display.measure),
  );
  const page = element(
    "div.tool-group",
    { role: "group", "aria-label": "Page" },
    iconButton(icons.image, "Save a picture (PNG)", "s", commands.savePicture),
    iconButton(icons.export, "Save the animation (GLB)", null, commands.saveAnimation),
    iconButton(icons.theme, "Dark or light", "t", commands.switchTheme),
    iconButton(icons.help, "Help", "?", commands.help),
    panel,
  );
  return element("div.toolbar", {}, look, page, cutBar(display));
}
