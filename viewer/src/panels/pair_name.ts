/// The names of a pair in one line. If the line is too short, the names lose the beginnings that
/// they share with names of other bodies.

import { element } from "../core/dom";
import type { Names } from "../data/result";
import type { Model } from "../model";
import { sharedBeginnings } from "../names";

export function pairNames(model: Model): (pair: Names) => HTMLElement {
  const shared = sharedBeginnings(model.bodies.map(({ name }) => model.shortName(name)));
  const halves = (name: string): HTMLElement[] => {
    const short = model.shortName(name);
    const beginning = shared.get(short) ?? "";
    return [
      ...(beginning ? [element("span.shared", {}, beginning)] : []),
      element("span.telling", {}, short.slice(beginning.length)),
    ];
  };
  return ([a, b]) =>
    element("span.pair-name", {}, ...halves(a), element("span.between", {}, " · "), ...halves(b));
}
