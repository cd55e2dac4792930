/// Keys that do what buttons do.

import type { Commands } from "./commands";
import type { Signal } from "./core/signal";
import type { Model } from "./model";

const flip = (signal: Signal<boolean>): void => {
  signal.value = !signal.value;
};

const ofRanges = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End"];

/// Whether a key belongs to what has the focus. Time goes by the same keys on its own slider.
function isTyping(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLInputElement && target.type === "range") {
    return ofRanges.includes(key) && !target.closest(".slider");
  }
  return target instanceof HTMLInputElement || target instanceof HTMLSelectElement;
}

export function listenToKeys(model: Model, { player, display, commands }: Commands): void {
  const actions: Readonly<Record<string, () => void>> = {
    " ": () => player.toggle(),
    Home: () => player.seek(0),
    End: () => player.seek(1),
    Enter: commands.toContact,
    f: commands.fit,
    w: () => flip(display.wireframe),
    x: () => flip(display.xray),
    k: () => display.toggleCut(),
    e: () => flip(display.edges),
    g: () => flip(display.ghosts),
    o: () => flip(display.onion),
    c: () => flip(display.contacts),
    a: () => model.run && flip(display.forces),
    d: () => model.devices.length > 0 && flip(display.devices),
    v: () => model.hasLooks && flip(display.looks),
    m: () => flip(display.measure),
    r: () => model.path && !model.path.failed && flip(display.path),
    b: () => model.path?.hasTrees && flip(display.trees),
    l: () => flip(player.loop),
    "+": () => player.window.zoom(player.t.value, 2),
    "-": () => player.window.zoom(player.t.value, 0.5),
    "0": () => player.window.showAll(),
    s: commands.savePicture,
    t: commands.switchTheme,
    p: commands.togglePanel,
    "?": commands.help,
  };

  const digit = ({ code }: KeyboardEvent): number =>
    Number(/^(?:Digit|Numpad)([1-9])$/.exec(code)?.[1]);

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target, event.key)) {
      return;
    }
    // A button that has the focus is pressed by these keys, as everywhere.
    const onButton =
      event.target instanceof HTMLButtonElement ||
      (event.target instanceof HTMLElement && event.target.tagName === "SUMMARY");
    if (
      (onButton && (event.key === " " || event.key === "Enter")) ||
      document.querySelector("dialog[open]")
    ) {
      return;
    }
    const body = digit(event) - 1;
    if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      commands.step(event.key === "ArrowLeft" ? -1 : 1, event.shiftKey);
    } else if (body >= 0 && event.shiftKey) {
      display.setVisible(body, !display.isVisible(body));
    } else if (body >= 0) {
      commands.focusBody(body);
    } else if (actions[event.key]) {
      actions[event.key]!();
    } else {
      return;
    }
    event.preventDefault();
  });
}
