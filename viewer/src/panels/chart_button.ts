/// The head of a row over time: its present value, and its name. A click on the name shows the row
/// in the large chart.

import { element } from "../core/dom";
import type { Signal } from "../core/signal";
import type { Player } from "../player";

export function chartButton<T>(
  name: string,
  item: T,
  shown: Signal<T | null>,
  player: Player,
  { textAt, pick }: { textAt: (t: number) => string; pick: () => void },
): HTMLElement {
  const now = element("span.row-now");
  const button = element(
    "button.row-name",
    { type: "button", title: `Show ${name} in the large chart` },
    element("span.name", {}, name),
    now,
  );
  button.addEventListener("click", pick);
  shown.subscribe((value) => button.setAttribute("aria-pressed", String(value === item)));
  player.t.subscribe((t) => (now.textContent = textAt(t)));
  return button;
}
