/// The pairs of bodies with their verdicts. A click on a column sorts them; a click on a pair
/// looks at it.

import { element } from "../core/dom";
import { lengthText, timeText } from "../core/format";
import type { PairAnswer } from "../data/result";
import type { Model } from "../model";
import type { Player } from "../player";
import type { SceneView } from "../view/scene_view";
import { pairNames } from "./pair_name";

interface Column {
  readonly title: string;
  readonly key: (pair: PairAnswer) => number | string;
  readonly text: (pair: PairAnswer, model: Model) => string;
}

const order = ["contact_at_start", "contact", "undecided", "free"] as const;
const shortWords = {
  contact_at_start: "at start",
  contact: "contact",
  undecided: "undecided",
  free: "free",
} as const;

/// The proven least distance, if more is known of it than that it is not negative.
const clearanceOf = (pair: PairAnswer): number =>
  (pair.closest?.lower_bound ?? pair.clearance) || Infinity;

const columns: readonly Column[] = [
  { title: "Pair", key: ({ pair }) => pair.join(" "), text: () => "" }, // Names have a look of their own.
  {
    title: "Verdict",
    key: ({ verdict }) => order.indexOf(verdict),
    text: ({ verdict }) => shortWords[verdict],
  },
  {
    title: "Time",
    key: ({ verdict, t }) => (verdict === "free" ? 2 : t),
    text: (pair, model) =>
      pair.verdict === "free"
        ? "—"
        : timeText(pair.time, 4, { grain: model.timeGrain(pair), down: true }),
  },
  {
    title: "Clear",
    key: clearanceOf,
    text: (pair, { grain }) => lengthText(finite(clearanceOf(pair)), 3, { grain, down: true }),
  },
];

const firstRows = 12; // Of lists that are longer than this by a few.
const mostRows = 300;

const finite = (x: number): number | null => (Number.isFinite(x) ? x : null);

function compare(a: number | string, b: number | string): number {
  return a < b ? -1 : a > b ? 1 : 0;
}

/// Null where the result says nothing of its pairs.
export function pairsPanel(model: Model, view: SceneView, player: Player): HTMLElement | null {
  if (model.pairs.length === 0) {
    return null;
  }
  const body = element("tbody");
  const namesOf = pairNames(model);
  const heads = columns.map(({ title }, index) => {
    const button = element("button.sort", { type: "button" }, title);
    button.addEventListener("click", () => sortBy(index));
    return element("th", { scope: "col" }, button);
  });
  const isFree = model.result?.verdict === "free" && model.pairs.some(({ closest }) => closest);
  let sorted = { column: isFree ? 3 : 2, down: false }; // By time, or by how near they come.

  const focus = (pair: PairAnswer): void => {
    if (pair.verdict !== "free") {
      player.seek(pair.t);
    } else if (pair.closest) {
      player.seek(pair.closest.t);
    }
    view.showContacts(pair.contacts, pair.t);
    const contact = pair.contacts[0];
    if (contact) {
      view.focusContact(contact);
    } else {
      view.focusBodies(pair.pair.map((name) => model.body(name)));
    }
  };

  const row = (pair: PairAnswer): HTMLElement => {
    const [, ...others] = columns.map(({ text }) => text(pair, model));
    const title = `Look at ${pair.pair.join(" and ")}`;
    const label = pair.pair.map((name) => model.shortName(name)).join(" · ");
    const button = element(
      "button.row-name",
      { type: "button", title, "aria-label": label },
      namesOf(pair.pair),
    );
    button.addEventListener("click", () => focus(pair));
    return element(
      "tr",
      { "data-verdict": pair.verdict },
      element("td", {}, button),
      ...others.map((text) => element("td", {}, text)),
    );
  };

  let shown = model.pairs.length > 1.5 * firstRows ? firstRows : mostRows;
  const more = element("button.link", { type: "button", hidden: shown === mostRows });
  more.textContent = `Show ${Math.min(model.pairs.length, mostRows)} of ${model.pairs.length}`;
  more.addEventListener("click", () => {
    shown = mostRows;
    more.hidden = true;
    show();
  });

  const show = (): void => {
    const { key } = columns[sorted.column]!;
    const sign = sorted.down ? -1 : 1;
    const rows = [...model.pairs].sort((a, b) => sign * compare(key(a), key(b)));
    body.replaceChildren(...rows.slice(0, shown).map(row));
    heads.forEach((head, index) => {
      const direction = sorted.down ? "descending" : "ascending";
      head.setAttribute("aria-sort", index === sorted.column ? direction : "none");
    });
  };

  const sortBy = (column: number): void => {
    sorted = { column, down: column === sorted.column && !sorted.down };
    show();
  };

  show();
  return element(
    "section.card",
    { "aria-label": "Pairs" },
    element("h2", {}, "Pairs ", element("span.count", {}, String(model.pairs.length))),
    element("table.pairs", {}, element("thead", {}, element("tr", {}, ...heads)), body),
    more,
  );
}
