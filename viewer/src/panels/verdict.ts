/// The verdict, with the number of tested pairs and of warnings.

import { element } from "../core/dom";
import type { Signal } from "../core/signal";
import type { Model } from "../model";

const words = {
  free: "Free",
  contact: "Contact",
  contact_at_start: "In contact at the start",
  undecided: "Undecided",
} as const;

const counted = (count: number, one: string, several: string): string =>
  `${count} ${count === 1 ? one : several}`;

interface Verdict {
  readonly kind: keyof typeof words;
  readonly text: string;
}

export function verdictOf({ result, run, path }: Model): Verdict {
  if (path?.failed) {
    return { kind: "undecided", text: "No path" };
  }
  if (result) {
    return { kind: result.verdict, text: words[result.verdict] };
  }
  if (!run?.isWhole) {
    return { kind: "undecided", text: "Stopped early" };
  }
  return { kind: "free", text: run.hasDynamics ? "Simulated" : "Recorded" };
}

/// "98 pairs tested", "2 warnings"; a result of an earlier version does not count its pairs.
function worth({ pairCounts, warnings, path }: Model): {
  pairs: string | null;
  warnings: string | null;
} {
  return {
    pairs:
      pairCounts && !path?.failed ? `${counted(pairCounts.tested, "pair", "pairs")} tested` : null,
    warnings: warnings.length > 0 ? `⚠ ${counted(warnings.length, "warning", "warnings")}` : null,
  };
}

/// A click on the number of warnings shows the warnings.
export function verdictLine(model: Model): HTMLElement {
  const { kind, text } = verdictOf(model);
  const { pairs, warnings } = worth(model);
  const toWarnings = element(
    "button.worth.warned",
    { type: "button", title: "To the warnings" },
    warnings ?? "",
  );
  toWarnings.addEventListener("click", () =>
    document.querySelector(".card .warnings")?.scrollIntoView({ block: "center" }),
  );
  return element(
    "div.verdict-line",
    {},
    element("p.verdict", { "data-verdict": kind }, text),
    ...(pairs ? [element("span.worth", {}, pairs)] : []),
    ...(warnings ? [toWarnings] : []),
  );
}

/// The same over the picture while the panel is closed; a click opens it.
export function verdictBadge(model: Model, panelOpen: Signal<boolean>): HTMLElement {
  const { kind, text } = verdictOf(model);
  const { pairs, warnings } = worth(model);
  const badge = element(
    "button.badge",
    { type: "button", "data-verdict": kind, title: "Details" },
    element("strong", {}, text),
    ...[pairs, warnings].filter((one) => one !== null).map((one) => element("span", {}, one)),
  );
  badge.addEventListener("click", () => (panelOpen.value = true));
  panelOpen.subscribe((open) => (badge.hidden = open));
  return badge;
}
