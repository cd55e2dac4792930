/// Which pairs an answer is about.

import { element } from "../core/dom";
import type { PairCounts, UntestedPairs, WhyUntested } from "../data/reports";
import { factList } from "./facts";

const reasons: Readonly<Record<WhyUntested, string>> = {
  joined_links: "of links that joints connect",
  srdf: "by the SRDF",
  allowed_collisions: "by allowed collisions",
  held: "of what a link holds",
  rule: "by the scene's rules",
  both_rest: "of which neither moves",
  both_scripted: "of which neither is free (they may pass through each other)",
};

/// "2 by the scene's rules: a and b, a and c"
export function untestedText({ why, count, first }: UntestedPairs): string {
  const named = first.map(([one, other]) => `${one} and ${other}`);
  const more = count > first.length ? [`and ${count - first.length} more`] : [];
  return `${count} ${reasons[why]}: ${[...named, ...more].join(", ")}`;
}

const isLeftOut = ({ why }: UntestedPairs): boolean =>
  why === "both_rest" || why === "both_scripted";

/// Nothing of results that were made before pairs were counted.
export const pairFacts = (counts: PairCounts | null): [string, string][] =>
  (counts?.untested ?? []).map((pairs) => [
    isLeftOut(pairs) ? "Left out" : "Ignored",
    untestedText(pairs),
  ]);

/// The pairs that were not tested, and why; closed at first, as the names are long.
export function untestedPairs(counts: PairCounts | null): HTMLElement[] {
  const facts = pairFacts(counts);
  const count = (counts?.ignored ?? 0) + (counts?.left_out ?? 0);
  return facts.length === 0
    ? []
    : [
        element(
          "details",
          {},
          element("summary", {}, `${count} ${count === 1 ? "pair" : "pairs"} not tested`),
          factList(facts),
        ),
      ];
}

/// Returns a sentence such as "none of the 3 tested pairs touches", for a verb such as "touches".
export function noneOf(counts: PairCounts | null, verb: string): string {
  switch (counts?.tested) {
    case undefined:
      return `none of the tested pairs ${verb}`;
    case 1:
      return `the one tested pair never ${verb}`;
    default:
      return `none of the ${counts!.tested} tested pairs ${verb}`;
  }
}

export const noPair = "No pair was tested: this says nothing about contact.";
