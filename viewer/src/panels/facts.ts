/// Names and values, in two columns.

import { element } from "../core/dom";

export const factList = (facts: readonly (readonly [string, string])[]): HTMLElement =>
  element(
    "dl.facts",
    {},
    ...facts.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]),
  );
