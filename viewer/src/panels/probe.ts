/// Coordinates of the points that were clicked, and their distance.

import { element } from "../core/dom";
import { lengthText, pointText } from "../core/format";
import type { Display } from "../display";
import { distance } from "../motion/vector";
import type { Player } from "../player";
import type { SceneView } from "../view/scene_view";

export function probePanel(view: SceneView, display: Display, player: Player): HTMLElement {
  const list = element("div");
  const panel = element(
    "section.card",
    { "aria-label": "Clicked points" },
    element("h2", {}, "Clicked points"),
    list,
  );

  const show = (): void => {
    const points = view.probe.placed(player.t.value);
    panel.hidden = points.length === 0 && !display.measure.value;
    const [a, b] = points;
    list.replaceChildren(
      ...points.map(({ body, triangle, local, world }) =>
        element(
          "div.probe-point",
          {},
          element("strong", {}, `${body.name}, triangle ${triangle}`),
          element("span", {}, `world ${pointText(world)}`),
          element("span", {}, `body ${pointText(local)}`),
        ),
      ),
      ...(a && b
        ? [element("p.distance", {}, `Distance ${lengthText(distance(a.world, b.world), 6)}`)]
        : []),
      ...(display.measure.value && points.length < 2
        ? [element("p.hint", {}, a ? "Click a second point." : "Click two points.")]
        : []),
    );
  };

  [view.probe.points, display.measure, player.t].forEach((signal) =>
    (signal as typeof player.t).subscribe(show),
  );
  return panel;
}
