/// What stands first in a row of something over time: its name, which shows it in the large chart,
/// and what it is now.

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
