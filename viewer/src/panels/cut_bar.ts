/// Where bodies are cut: along the view or an axis, by a slider.

import { element, iconButton } from "../core/dom";
import { icons } from "../core/icons";
import type { Cut, Display } from "../display";

const directions: readonly (readonly [Cut["along"], string])[] = [
  ["view", "along the view"],
  ["x", "along x"],
  ["y", "along y"],
  ["z", "along z"],
];

/// Shown while something is cut.
export function cutBar(display: Display): HTMLElement {
  const along = element(
    "select",
    { "aria-label": "Direction of the cut" },
    ...directions.map(([value, text]) => element("option", { value }, text)),
  );
  const depth = element("input", {
    type: "range",
    min: 0,
    max: 1,
    step: 0.002,
    "aria-label": "Depth of the cut",
  });
  const change = (part: Partial<Cut>): void => {
    const { value: cut } = display.cut;
    if (cut) {
      display.cut.value = { ...cut, ...part, byItself: false };
    }
  };
  along.addEventListener("change", () => change({ along: along.value as Cut["along"] }));
  depth.addEventListener("input", () => change({ share: Number(depth.value) }));
  const flip = iconButton(icons.flip, "Cut away the other side", null, () =>
    change({ otherSide: !display.cut.value?.otherSide }),
  );
  const close = iconButton(icons.close, "Cut nothing", "k", () => (display.cut.value = null));
  const bar = element(
    "div.tool-group.cut-bar",
    { role: "group", "aria-label": "Cut" },
    along,
    depth,
    flip,
    close,
  );
  display.cut.subscribe((cut) => {
    bar.hidden = cut === null;
    if (cut) {
      along.value = cut.along;
      depth.value = String(cut.share);
      flip.setAttribute("aria-pressed", String(cut.otherSide));
    }
  });
  return bar;
}
