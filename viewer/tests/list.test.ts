/// The data of a page with many results.

import { describe, expect, test } from "vitest";
import { readPageData } from "../src/data/page_data";
import { readResultList } from "../src/data/result_list";
import { resultLink, resultOf } from "../src/link";

const mesh = (x: number) => ({ origin: [x, 0, 0], positions: "AACAvwAAAMAAAAAA", triangles: "" });
const result = (id: string) => ({
  id,
  verdict: "free",
  scene: { id, bodies: [], options: { duration: 1, margin: 0 } },
});
const text = JSON.stringify({
  list: [
    { result: result("one"), view: { bodies: [0], meshes: [0] } },
    { summary: { line: 2, error: "no scene" } },
    { result: result("other"), view: { bodies: [1, 0], meshes: [1, 0] } },
  ],
  meshes: [mesh(7), mesh(8)],
});

describe("a list of results", () => {
  const list = readResultList(text)!;

  test("has what there is to know of each", () => {
    expect(list.summaries.map(({ id, error }) => id ?? error)).toEqual([
      "one",
      "no scene",
      "other",
    ]);
    expect([0, 1, 2, 3].map((index) => list.canPlay(index))).toEqual([true, false, true, false]);
  });

  test("gives each result its meshes, and each mesh once", () => {
    const [one, other] = [list.pageOf(0)!, list.pageOf(2)!];
    expect(one.scene.id).toBe("one");
    expect(other.meshes.map(({ origin }) => origin[0])).toEqual([8, 7]);
    expect(other.meshes[1]).toBe(one.meshes[0]);
    expect(list.pageOf(1)).toBeNull();
    expect(list.pageOf(3)).toBeNull();
  });

  test("is not taken for one result, nor one for it", () => {
    expect(readResultList('{"result":{},"view":{}}')).toBeNull();
    expect(readResultList('"FIRSTCONTACT_RESULT"')).toBeNull();
    expect(() => readPageData(text)).toThrow(/no result/);
  });

  test("is linked to by numbers from 1", () => {
    expect(resultOf(`#${resultLink(11)}&t=0.5`)).toBe(11);
    for (const wrong of ["", "#t=0.5", "#result=0", "#result=x", "#result=1.5"]) {
      expect(resultOf(wrong)).toBeNull();
    }
  });
});
