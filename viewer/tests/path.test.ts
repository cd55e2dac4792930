/// Pages of planned paths: the line with its colours, the trees on demand, and searches without a path.

import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, test } from "vitest";
import { pathOf, type StoredPath } from "../src/data/path_data";
import { Path } from "../src/path";
import { clearanceColor } from "../src/view/path_colors";
import { canLook, Folder, launch, type MadePlan } from "./browser";

const stored = (clearances: readonly (number | null)[]): StoredPath => ({
  verdict: "proven",
  edges: clearances.map((clearance, k) => ({
    clearance,
    t: [k / clearances.length, (k + 1) / clearances.length],
  })),
  movers: [],
  trees: [],
  blocked: [],
  goal: [],
});
const path = (...clearances: (number | null)[]): Path => new Path(pathOf(stored(clearances)));

describe("a path", () => {
  test("knows the edge that is played", () => {
    const three = path(1, 2, 3);
    expect([0, 0.3, 0.4, 0.7, 1].map((t) => three.edgeAt(t))).toEqual([0, 0, 1, 2, 2]);
    expect(path().edgeAt(0.5)).toBe(-1);
  });

  test("measures clearances on a logarithmic scale", () => {
    const three = path(0.1, 0.001, 0.01);
    expect([three.least, three.greatest]).toEqual([0.001, 0.1]);
    expect(three.share(0)).toBeCloseTo(1, 12);
    expect(three.share(1)).toBe(0);
    expect(three.share(2)).toBeCloseTo(0.5, 12);
    const touching = path(0, 0.1, 0.05); // Where nothing is proven a logarithm has no meaning.
    expect([0, 1, 2].map((edge) => touching.share(edge))).toEqual([0, 1, 0.5]);
    expect(path(0.2, 0.2).share(1)).toBe(1);
    expect(path(null, 0.2).share(0)).toBeNull();
  });

  test("has different colours at both ends of the scale", () => {
    const colors = [0, 1, null].map((share) => clearanceColor(share).getHexString());
    expect(new Set(colors).size).toBe(3);
  });
});

const wall = (name: string, size: readonly number[]) => ({ name, shape: { box: { size } } });
const peg = {
  name: "peg",
  shape: { box: { size: [0.1, 0.1, 0.1] } },
  pose: { position: [-0.5, 0, 0] },
};
const plan = {
  body: "peg",
  goal: { position: [0.5, 0, 0] },
  box: [
    [-1, -1, -1],
    [1, 1, 1],
  ],
};
const around = {
  firstcontact: 1,
  id: "around",
  bodies: [wall("wall", [0.01, 0.5, 0.5]), peg],
  plan,
};
const closed = {
  firstcontact: 1,
  id: "closed",
  bodies: [wall("cork", [0.01, 3, 3]), peg],
  plan: { ...plan, time: 0.3 },
};

describe.skipIf(!canLook)("the page of a path", () => {
  let browser: Browser;
  let made: MadePlan;
  let failed: MadePlan;
  let viewed: string;
  const folder = new Folder();
  const complaints: string[] = [];
  const open: Page[] = [];

  const show = async (url: string): Promise<Page> => {
    const page = await browser.newPage({ viewport: { width: 1100, height: 720 } });
    page.on("console", (message) => {
      if (message.type() === "error" || message.text().startsWith("THREE")) {
        complaints.push(message.text());
      }
    });
    page.on("pageerror", (error) => complaints.push(String(error)));
    open.push(page);
    await page.goto(url);
    await page.waitForFunction(() => "firstcontact" in window);
    return page;
  };
  const timeOf = (page: Page) => page.evaluate(() => window.firstcontact.player.t.value);
  const treesOf = (page: Page) =>
    page.evaluate(() => {
      const { trees } = window.firstcontact.view.path!;
      return {
        visible: trees.visible,
        kinds: trees.children.map(({ name }) => name),
        places: trees.children.map(({ geometry }) => geometry.attributes.position.count),
      };
    });

  beforeAll(async () => {
    made = await folder.plan("around", around);
    failed = await folder.plan("closed", closed);
    viewed = await folder.view("around.json");
    browser = await launch();
  });

  afterEach(async () => {
    await Promise.all(open.splice(0).map((page) => page.close()));
  });

  afterAll(async () => {
    await browser?.close();
    folder.remove();
  });

  test("has the clearances of the file, with a scale of colours", async () => {
    const page = await show(made.url);
    const panel = page.getByRole("region", { name: "Path" });
    await panel.getByRole("img", { name: "Colours of clearances" }).waitFor();
    const edges = made.path!.edges;
    expect(edges.length).toBeGreaterThan(1);
    expect(await panel.getByRole("list", { name: "Edges" }).getByRole("listitem").count()).toBe(
      edges.length,
    );
    expect(await panel.locator(".now-edge").textContent()).toMatch(`Edge 1 of ${edges.length}: ≥ `);
  });

  test("draws a line through the waypoints", async () => {
    const page = await show(made.url);
    const dots = await page.evaluate(() => {
      const { group, waypoints } = window.firstcontact.view.path!;
      const { array } = waypoints.geometry.attributes.position;
      const middle = group.position.toArray();
      return [...array].map((x, k) => x + middle[k % 3]!);
    });
    const expected = made.path!.waypoints.flatMap((q) => q.slice(0, 3));
    expect(dots.length).toBe(expected.length);
    dots.forEach((x, k) => expect(x).toBeCloseTo(expected[k]!, 5));
    // Its colours are seen, and are gone without it.
    const isVisible = () => page.evaluate(() => window.firstcontact.view.path!.line.parent.visible);
    expect(await isVisible()).toBe(true);
    await page.keyboard.press("r");
    expect(await isVisible()).toBe(false);
  });

  test("goes to the edge that is clicked, in the list and on the line", async () => {
    const page = await show(made.url);
    await page.getByRole("button", { name: "Edge 2" }).click();
    const begin = await timeOf(page);
    expect(begin).toBeGreaterThan(0);
    expect(await page.locator(".edges [aria-current]").textContent()).toContain("Edge 2");
    // Somewhere on a row of pixels through the picture there is the line.
    const stage = (await page.locator(".stage canvas").boundingBox())!;
    const hits = await page.evaluate(({ x, y, width, height }) => {
      const { view } = window.firstcontact;
      const found: { x: number; y: number; edge: number }[] = [];
      for (let k = 0; k < 120; ++k) {
        for (let j = 0; j < 60; ++j) {
          const at = { x: x + ((k + 0.5) * width) / 120, y: y + ((j + 0.5) * height) / 60 };
          const edge = view.edgeAt(at.x, at.y);
          if (edge !== null) {
            found.push({ ...at, edge });
          }
        }
      }
      return found;
    }, stage);
    const first = hits.find(({ edge, y }) => edge === 0 && y > stage.y + 80);
    expect(first).toBeDefined();
    await page.mouse.click(first!.x, first!.y);
    expect(await timeOf(page)).toBe(0);
    expect(await page.locator(".edges [aria-current]").textContent()).toContain("Edge 1");
  });

  test("shows the trees on demand", async () => {
    const page = await show(made.url);
    const button = page.getByRole("button", { name: "Search tree" });
    expect(await button.getAttribute("aria-pressed")).toBe("false");
    expect((await treesOf(page)).kinds).toEqual([]);
    await button.click();
    const { visible, kinds, places } = await treesOf(page);
    expect(visible).toBe(true);
    expect(kinds).toEqual(["start", "goals"]);
    expect(Math.max(...places)).toBeGreaterThan(0);
    await page.keyboard.press("b");
    expect((await treesOf(page)).visible).toBe(false);
  });

  test("of a path file has no trees", async () => {
    const page = await show(viewed);
    expect(await page.getByRole("button", { name: "Search tree" }).count()).toBe(0);
    expect(await page.getByRole("button", { name: "Path, coloured" }).count()).toBe(1);
    await page.getByRole("region", { name: "Path" }).getByText("Edge 1 of").waitFor();
  });

  test("of a search without a path shows its trees, its goal and what was in the way", async () => {
    expect(failed.path).toBeNull();
    const page = await show(failed.url);
    expect(await page.getByRole("region", { name: "Answer" }).textContent()).toContain("No path");
    const blocked = page.getByRole("list", { name: "Most in the way" });
    expect(await blocked.textContent()).toMatch(/^cork · peg[\d ]+ times/);
    expect((await treesOf(page)).visible).toBe(true);
    expect(await page.getByRole("button", { name: "Search tree" }).count()).toBe(1);
    expect(await page.locator(".transport").count()).toBe(0); // There is nothing to play.
    const ghosts = await page.evaluate(() =>
      window.firstcontact.view.ghosts.group.children.map(({ matrix }) =>
        matrix.elements.slice(12, 15),
      ),
    );
    expect(ghosts).toEqual([[0.5, 0, 0]]);
  });

  test("complained about nothing", () => {
    expect(complaints).toEqual([]);
  });
});
