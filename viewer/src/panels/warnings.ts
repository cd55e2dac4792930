/// The warnings of the answer.

import { element } from "../core/dom";
import type { Model } from "../model";

const mostRows = 20;

/// Null where there is nothing.
export function warningsPanel({ warnings }: Model): HTMLElement | null {
  if (warnings.length === 0) {
    return null;
  }
  const shown = warnings.slice(0, mostRows).map((text) => element("li", {}, text));
  const left = warnings.length - shown.length;
  return element(
    "section.card",
    { "aria-label": "Warnings" },
    element("h2", {}, "Warnings ", element("span.count", {}, String(warnings.length))),
    element("ul.warnings", {}, ...shown, ...(left > 0 ? [element("li", {}, `${left} more`)] : [])),
  );
}
