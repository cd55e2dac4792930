/// A list of results: how many of each kind, and a row for each. A click plays one.

import { element } from "../core/dom";
import { timeText } from "../core/format";
import { Signal } from "../core/signal";
import type { ResultList, Summary } from "../data/result_list";
import type { Verdict } from "../data/result";

type Kind = Verdict | "error";

const kinds: readonly (readonly [Kind, string])[] = [
  ["contact", "contact"],
  ["contact_at_start", "contact at start"],
  ["undecided", "undecided"],
  ["error", "error"],
  ["free", "free"],
];
const words: Readonly<Record<Kind, string>> = Object.fromEntries(kinds) as Record<Kind, string>;
const rowsAtOnce = 500;

const kindOf = ({ verdict }: Summary): Kind => verdict ?? "error";

interface Row {
  readonly index: number;
  readonly summary: Summary;
}

interface Column {
  readonly title: string;
  readonly key: (row: Row) => number | string;
  readonly text: (row: Row) => string;
}

const nameOf = ({ index, summary }: Row): string =>
  summary.id ?? `line ${summary.line ?? index + 1}`;

/// Errors have their text in the place of the pair.
const pairOf = ({ summary: { pair, error, reason } }: Row): string =>
  error ?? pair?.join(" · ") ?? reason ?? "";

const isTimed = ({ verdict }: Summary): boolean => verdict !== undefined && verdict !== "free";

const columns: readonly Column[] = [
  {
    title: "Line",
    key: ({ index, summary }) => summary.line ?? index + 1,
    text: ({ index, summary }) => String(summary.line ?? index + 1),
  },
  { title: "Scene", key: nameOf, text: nameOf },
  {
    title: "Verdict",
    key: ({ summary }) => kinds.findIndex(([kind]) => kind === kindOf(summary)),
    text: ({ summary }) => words[kindOf(summary)],
  },
  { title: "Pair", key: pairOf, text: pairOf },
  {
    title: "Time",
    key: ({ summary }) => (isTimed(summary) ? (summary.time ?? 0) : Infinity),
    text: ({ summary }) =>
      isTimed(summary) ? timeText(summary.time ?? null, 4, { down: true }) : "",
  },
  {
    title: "Pairs tested",
    key: ({ summary }) => summary.pair_counts?.tested ?? -1,
    text: ({ summary }) => String(summary.pair_counts?.tested ?? ""),
  },
  {
    title: "Warnings",
    key: ({ summary }) => summary.warnings?.length ?? 0,
    text: ({ summary }) => (summary.warnings?.length ? `⚠ ${summary.warnings.length}` : ""),
  },
];

const compare = (a: number | string, b: number | string): number => (a < b ? -1 : a > b ? 1 : 0);

/// Which rows there are to see, and in which order.
interface Choice {
  readonly kind: Kind | null;
  readonly text: string;
  readonly column: number;
  readonly down: boolean;
  readonly most: number;
}

function chosen(rows: readonly Row[], { kind, text, column, down }: Choice): Row[] {
  const wanted = text.toLowerCase();
  const { key } = columns[column]!;
  return rows
    .filter(({ summary }) => kind === null || kindOf(summary) === kind)
    .filter((row) => `${nameOf(row)} ${pairOf(row)}`.toLowerCase().includes(wanted))
    .sort((a, b) => (down ? -1 : 1) * compare(key(a), key(b)));
}

/// One button for each kind that there is: it shows no other.
function kindButtons(rows: readonly Row[], choice: Signal<Choice>): HTMLElement[] {
  return kinds.flatMap(([kind, word]) => {
    const count = rows.filter(({ summary }) => kindOf(summary) === kind).length;
    const button = element(
      "button.kind",
      { type: "button", "data-verdict": kind },
      element("strong", {}, String(count)),
      ` ${word}`,
    );
    button.addEventListener("click", () => {
      const { value } = choice;
      choice.value = { ...value, kind: value.kind === kind ? null : kind, most: rowsAtOnce };
    });
    choice.subscribe((value) => button.setAttribute("aria-pressed", String(value.kind === kind)));
    return count > 0 ? [button] : [];
  });
}

function tableHead(choice: Signal<Choice>): HTMLElement {
  const heads = columns.map(({ title }, column) => {
    const button = element("button.sort", { type: "button" }, title);
    button.addEventListener("click", () => {
      const { value } = choice;
      choice.value = { ...value, column, down: value.column === column && !value.down };
    });
    const head = element("th", { scope: "col" }, button);
    choice.subscribe((value) => {
      const direction = value.down ? "descending" : "ascending";
      head.setAttribute("aria-sort", value.column === column ? direction : "none");
    });
    return head;
  });
  return element("thead", {}, element("tr", {}, ...heads));
}

/// @param play  shows one of the results
export function resultTable(list: ResultList, play: (index: number) => void): HTMLElement {
  const rows = list.summaries.map((summary, index): Row => ({ index, summary }));
  const choice = new Signal<Choice>({
    kind: null,
    text: "",
    column: 0,
    down: false,
    most: rowsAtOnce,
  });
  const body = element("tbody");
  const more = element("button.link", { type: "button" });
  const none = element("p.hint", {}, "No result is like that.");

  const rowElement = (row: Row): HTMLElement => {
    const cells = columns.map(({ title, text }) =>
      element("td", { "data-column": title }, text(row)),
    );
    if (list.canPlay(row.index)) {
      const button = element("button.link", { type: "button", title: "Play" }, nameOf(row));
      button.addEventListener("click", () => play(row.index));
      cells[1]!.replaceChildren(button);
    }
    return element("tr", { "data-verdict": kindOf(row.summary) }, ...cells);
  };

  choice.subscribe((value) => {
    const found = chosen(rows, value);
    body.replaceChildren(...found.slice(0, value.most).map(rowElement));
    more.hidden = found.length <= value.most;
    more.textContent = `Show more of ${found.length}`;
    none.hidden = found.length > 0;
  });
  more.addEventListener("click", () => {
    choice.value = { ...choice.value, most: choice.value.most + rowsAtOnce };
  });
  const search = element("input.filter", {
    type: "search",
    placeholder: "Find a scene or a body",
    "aria-label": "Find a scene or a body",
  });
  search.addEventListener("input", () => {
    choice.value = { ...choice.value, text: search.value, most: rowsAtOnce };
  });
  const unplayable = rows.filter(({ index }) => !list.canPlay(index)).length;
  return element(
    "main.results",
    { "aria-label": "Results" },
    element("h1", {}, rows.length === 1 ? "1 result" : `${rows.length} results`),
    element("div.kinds", {}, ...kindButtons(rows, choice), search),
    ...(unplayable > 0
      ? [
          element(
            "p.hint",
            {},
            `${unplayable} of them cannot be played here: errors, scenes whose files could not be read again, and those beyond the size of a page.`,
          ),
        ]
      : []),
    element("table", {}, tableHead(choice), body),
    none,
    more,
  );
}
