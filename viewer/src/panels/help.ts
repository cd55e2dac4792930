/// Help: the effect of keys and mouse, and the authors of the code in the page.

import { element, iconButton } from "../core/dom";
import { icons } from "../core/icons";

declare const LICENCES: string;

const keys: readonly (readonly [string, string])[] = [
  ["Space", "play, pause"],
  [
    "← →",
    "step by a hundredth, or a step of a run; with Shift by a thousandth, or a tenth of a step",
  ],
  ["Home End", "start, end"],
  ["Enter", "first contact"],
  ["f", "show everything; or what the page opened on"],
  ["1 … 9", "look at a body; with Shift show or hide it"],
  ["w x k e", "wireframe, x-ray, cut, edges"],
  ["g o c", "ghosts, onion skin, contact points"],
  ["a", "contact forces of a run; forces on haptic devices"],
  ["d", "where haptic devices lead their tools"],
  ["v", "what robots look like, in place of their collision geometry"],
  ["r b", "a planned path, the tree of its search"],
  ["m", "measure: click two points"],
  ["l", "repeat"],
  ["+ - 0", "less of the time in the charts, more, all"],
  ["s t p", "save a picture, dark or light, side panel"],
  ["?", "this help"],
];

const mouse: readonly (readonly [string, string])[] = [
  ["Drag", "turn; with the right button move"],
  ["Wheel", "nearer, farther"],
  ["Click", "coordinates of a point"],
  [
    "On a chart",
    "click: go to a moment; wheel: less or more of the time, with Shift earlier or later",
  ],
];

function table(title: string, rows: readonly (readonly [string, string])[]): HTMLElement {
  return element(
    "dl.keys",
    { "aria-label": title },
    ...rows.flatMap(([key, what]) => [
      element(
        "dt",
        {},
        ...key.split(title === "Keys" ? " " : "\n").map((part) => element("kbd", {}, part)),
      ),
      element("dd", {}, what),
    ]),
  );
}

export function helpDialog(version: string): HTMLDialogElement {
  const dialog = element("dialog", { "aria-label": "Help" });
  const close = iconButton(icons.close, "Close", "Esc", () => dialog.close());
  dialog.append(
    element("header", {}, element("h2", {}, "Keys and mouse"), close),
    table("Keys", keys),
    table("Mouse", mouse),
    element(
      "p.hint",
      {},
      "The address ends in #t=…, the moment that is shown: copy it to link to that moment. " +
        "Green is proven free of contact at every instant; what comes after a contact is shown " +
        "as if nothing stopped the bodies.",
    ),
    element(
      "details",
      {},
      element("summary", {}, `firstcontact ${version}, and what this page contains`),
      element("pre", {}, `firstcontact is under Apache-2.0.\n\n\n${LICENCES}`),
    ),
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) {
      dialog.close();
    }
  });
  return dialog;
}
