/// The planned path: its edges with their clearances, and the search for it.

import { element } from "../core/dom";
import { lengthText } from "../core/format";
import { drawnEdges, type SearchTree } from "../data/path_data";
import type { Path } from "../path";
import type { Player } from "../player";
import { clearanceColor, clearanceScale, treeColors } from "../view/path_colors";

const mostEdges = 500; // Rows in the list.
const mostPairs = 10;

const counted = (count: number, one: string): string =>
  `${count.toLocaleString("en").replaceAll(",", " ")} ${one}${count === 1 ? "" : "s"}`;

const clearanceText = (clearance: number | null, grain: number): string =>
  clearance === null ? "no pair is tested" : `≥ ${lengthText(clearance, 4, { grain, down: true })}`;

/// The colours from the least clearance to the greatest one.
function legend({ least, greatest }: Path, grain: number): HTMLElement[] {
  if (least === null) {
    return [];
  }
  const bar = element("div.scale", { "aria-hidden": "true" });
  const even = least === greatest;
  bar.style.background = even
    ? `#${clearanceColor(1).getHexString()}`
    : `linear-gradient(to right, ${clearanceScale.join(", ")})`;
  const ends = [least, ...(even ? [] : [greatest])].map((value) =>
    element("span", {}, clearanceText(value, grain)),
  );
  return [
    element(
      "div.legend",
      { role: "img", "aria-label": "Colours of clearances" },
      bar,
      element("div.ends", {}, ...ends),
    ),
  ];
}

function edgeRow(path: Path, grain: number, player: Player, edge: number): HTMLElement {
  const { clearance, t } = path.data.edges[edge]!;
  const swatch = element("span.swatch", { "aria-hidden": "true" });
  swatch.style.background = `#${clearanceColor(path.share(edge)).getHexString()}`;
  const button = element(
    "button.row-name",
    { type: "button", title: "To the start of this edge" },
    element("span.name", {}, `Edge ${edge + 1}`),
    element("span.value", {}, clearanceText(clearance, grain)),
  );
  button.addEventListener("click", () => player.seek(t[0]));
  return element("li", {}, swatch, button);
}

/// Scrolls a list, but not the panel around it, to one of its rows.
function follow(list: HTMLElement, row: HTMLElement | undefined): void {
  if (row) {
    const above = row.offsetTop;
    const below = above + row.offsetHeight - list.clientHeight;
    list.scrollTop = Math.min(Math.max(list.scrollTop, below), above);
  }
}

/// The edges in their order; that which is played now is marked.
function edgeList(path: Path, grain: number, player: Player): HTMLElement[] {
  const count = path.data.edges.length;
  if (count === 0) {
    return [];
  }
  const now = element("p.now-edge", { "aria-live": "off" });
  const rows = path.data.edges
    .slice(0, mostEdges)
    .map((_, edge) => edgeRow(path, grain, player, edge));
  const list = element("ul.rows.edges", { "aria-label": "Edges" }, ...rows);
  let shown = -1;
  player.t.subscribe((t) => {
    const edge = path.edgeAt(t);
    if (edge !== shown) {
      rows[shown]?.removeAttribute("aria-current");
      rows[edge]?.setAttribute("aria-current", "true");
      follow(list, rows[edge]);
      shown = edge;
      now.textContent = `Edge ${edge + 1} of ${count}: ${clearanceText(path.data.edges[edge]!.clearance, grain)}`;
    }
  });
  const left = count - rows.length;
  return [now, list, ...(left > 0 ? [element("p.hint", {}, `${left} more edges`)] : [])];
}

const treeNames = { start: "From the start", goals: "From the goals", roadmap: "Roadmap" } as const;

function treeRow(tree: SearchTree): HTMLElement {
  const swatch = element("span.swatch", { "aria-hidden": "true" });
  swatch.style.background = treeColors[tree.kind];
  const drawn = drawnEdges(tree);
  const said = [
    counted(tree.places, "place"),
    ...(tree.kind === "roadmap" ? [counted(tree.edges, "free edge")] : []),
    ...(drawn < tree.edges ? [`the first ${counted(drawn, "edge")} drawn`] : []),
  ].join(", ");
  return element(
    "li.tree",
    {},
    swatch,
    element("span.name", {}, treeNames[tree.kind]),
    element("span.value", {}, said),
  );
}

function treeList(path: Path): HTMLElement[] {
  const { trees } = path.data;
  if (trees.length === 0) {
    return [];
  }
  const hint = path.hasTrees
    ? "The button of the search tree shows or hides them (b)."
    : "The first edge that was tried led to the goal.";
  return [
    element("h3", {}, "Search trees"),
    element("ul.rows.trees", { "aria-label": "Search trees" }, ...trees.map(treeRow)),
    element("p.hint", {}, hint),
  ];
}

function blockedList({ data: { blocked } }: Path): HTMLElement[] {
  if (blocked.length === 0) {
    return [];
  }
  const rows = blocked
    .slice(0, mostPairs)
    .map(({ pair, count }) =>
      element(
        "li.blocked",
        {},
        element("span.name", {}, `${pair[0]} · ${pair[1]}`),
        element("span.value", {}, counted(count, "time")),
      ),
    );
  const left = blocked.length - rows.length;
  return [
    element("h3", {}, "Most in the way"),
    element("ul.rows", { "aria-label": "Most in the way" }, ...rows),
    ...(left > 0 ? [element("p.hint", {}, counted(left, "more pair"))] : []),
  ];
}

/// The points whose ways are drawn, in a sentence.
function traced({ data: { movers, edges } }: Path): HTMLElement[] {
  const names = movers.map(({ name }) => name).join(" and ");
  return edges.length > 0
    ? [element("p.hint", {}, `The way of ${names}. Colours: proven clearance of each edge.`)]
    : [];
}

/// @param grain  [m] lengths are not known better
export function pathPanel(path: Path, grain: number, player: Player): HTMLElement {
  const title = path.failed ? "Search" : "Path";
  const count = path.failed ? "" : counted(path.data.edges.length, "edge");
  const before =
    path.data.verdict === "approximate" ? [element("p", {}, "It ends before a goal.")] : [];
  return element(
    "section.card.path",
    { "aria-label": title },
    element("h2", {}, `${title} `, element("span.count", {}, count)),
    ...before,
    ...legend(path, grain),
    ...traced(path),
    ...edgeList(path, grain, player),
    ...blockedList(path),
    ...treeList(path),
  );
}
