/// The parts that need no browser.

import { describe, expect, test } from "vitest";
import { forceText, lengthText, pointText, timeText } from "../src/core/format";
import { readPageData } from "../src/data/page_data";
import type { Vector3 } from "../src/data/result";
import { momentOf } from "../src/link";
import { sharedBeginnings } from "../src/names";
import { noneOf, pairFacts, untestedText } from "../src/panels/pair_facts";
import { Device } from "../src/devices";
import { runCharts } from "../src/panels/run_charts";
import { verdictOf } from "../src/panels/verdict";
import { Player } from "../src/player";
import { Run } from "../src/run";
import { DrawnShapes } from "../src/view/drawn_shape";
import { featureEdges } from "../src/view/feature_edges";
import { roundNumber } from "../src/view/grid";
import { thickHull } from "../src/view/thick_hull";

describe("quantities", () => {
  test("are read in the unit that suits them", () => {
    expect(lengthText(0.0000098)).toBe("9.8\u00a0µm");
    expect(lengthText(-0.25)).toBe("−250\u00a0mm");
    expect(lengthText(0)).toBe("0\u00a0m");
    expect(lengthText(null)).toBe("—");
    expect(timeText(0.00936776)).toBe("9.3678\u00a0ms");
    expect(pointText([0.001, -0.02, 0])).toBe("(1, −20, 0) mm");
  });

  test("are read in the unit of what is shown", () => {
    expect(lengthText(0.00099999999)).toBe("1\u00a0mm");
    expect(timeText(0.9999999)).toBe("1\u00a0s");
    expect(forceText(999.9)).toBe("1\u00a0kN");
    expect(lengthText(0.00099999999, 4, { down: true })).toBe("999.9\u00a0µm");
  });

  test("have no digits below their grain", () => {
    expect(lengthText(0.00436899, 4, { grain: 1e-6 })).toBe("4.369\u00a0mm");
    expect(lengthText(0.00436899, 4, { grain: 3e-6 })).toBe("4.37\u00a0mm");
    expect(lengthText(0.00436899, 4, { grain: 3e-6, down: true })).toBe("4.36\u00a0mm");
    expect(lengthText(7.8e-7, 4, { grain: 1e-6 })).toBe("< 1\u00a0µm");
    expect(lengthText(1.23456, 4, { grain: 1e-6 })).toBe("1.235\u00a0m");
    expect(timeText(1.122429910063828, 5, { grain: 4e-4 })).toBe("1.122\u00a0s");
    expect(pointText([0.0012345678, -0.02, 0], 6, 1e-6)).toBe("(1.235, −20, 0) mm");
  });

  test("are not more than they are where they are proven to be no less", () => {
    expect(lengthText(0.0043689954, 4, { down: true })).toBe("4.368\u00a0mm");
    expect(lengthText(0.29, 4, { down: true })).toBe("290\u00a0mm");
    expect(lengthText(7.8e-7, 4, { grain: 1e-6, down: true })).toBe("0.7\u00a0µm");
    expect(timeText(0.99999999, 5, { down: true })).toBe("999.99\u00a0ms");
    for (let k = 1; k < 2000; ++k) {
      const value = Math.sqrt(k) * 10 ** ((k % 13) - 9);
      const shown = lengthText(value, 3, { down: true, grain: 1e-9 * (k % 7) });
      const [digits, unit] = shown.split("\u00a0");
      const size = { km: 1e3, m: 1, mm: 1e-3, µm: 1e-6, nm: 1e-9 }[unit!]!;
      expect(Number(digits) * size).toBeLessThanOrEqual(value * (1 + 1e-12));
    }
  });

  test("have round numbers below them", () => {
    expect(roundNumber(0.3)).toBeCloseTo(0.2, 12);
    expect(roundNumber(7)).toBe(5);
    expect(roundNumber(1)).toBe(1);
  });
});

describe("a device", () => {
  const steps = [0.5, 1, 2].map((time, k) => ({ time, lasted: k === 2 ? 1 : 0.5 }));
  const [w, z] = [Math.SQRT1_2, Math.SQRT1_2];
  const device = new Device(
    {
      body: 1,
      steps: new Uint32Array([1, 2]),
      positions: new Float64Array([0, 0, 0, 3, 0, 0]),
      rotations: new Float32Array([w, 0, 0, z, 1, 0, 0, 0]),
      forces: new Float32Array([0, 0, 0, 3, 4, 0]),
      torques: new Float32Array([0, 0, 0.5, 0, 0, 0]),
      links: [
        {
          body: 2,
          positions: new Float64Array([0, 1, 0, 3, 1, 0]),
          rotations: new Float32Array([1, 0, 0, 0, w, 0, 0, z]),
        },
      ],
    },
    { name: "peg", motion: (t) => ({ position: [4 * t, 0, 0], rotation: [1, 0, 0, 0] }) },
    [1, 0, 0],
    { steps } as never,
  );

  test("has a pose and a force from its first step on", () => {
    expect(device.at(0)).toBeNull();
    expect(device.at(2)!.force).toEqual([3, 4, 0]);
    expect(device.forces).toEqual([0, 0, 5]);
    expect(device.torques).toEqual([0, 0.5, 0]);
    expect(device.links).toEqual([2]);
    expect(device.at(2)!.links[0]!.position).toEqual([3, 1, 0]);
    expect(device.at(2)!.links[0]!.rotation[3]).toBeCloseTo(z, 6);
  });

  test("is ahead of its tool by the distance of their centres as a step begins", () => {
    // At 0.5 s the centre of the tool is at x = 1 + 1; the device has it at y = 1.
    expect(device.leads[1]).toBeCloseTo(Math.hypot(2, 1), 6);
    expect(device.leads[2]).toBeCloseTo(1, 6); // x = 4 and x = 3.
    expect(device.leads[0]).toBe(0);
  });
});

describe("a run", () => {
  const run = (
    efforts: number[][],
    velocities: number[][],
    impulses: Vector3[] = [],
    {
      last,
      linksFrom = 0,
      ...more
    }: { last?: number; linksFrom?: number; kind?: "haptics"; masses?: number[] } = {},
  ): Run =>
    new Run({
      header: {
        scene: { simulation: { duration: 2, step: 1, gravity: [0, 0, -9.81] } },
        masses: [],
        ...more,
      } as never,
      linksFrom,
      steps: efforts.map((_, k) => ({
        step: k + 1,
        time: k + 1 === efforts.length ? (last ?? k + 1) : k + 1,
        lasted: 1,
        time_lost: 0,
        clearance: null,
        kinetic_energy: 0,
        potential_energy: 0,
        linear_momentum: [0, 0, 0],
        angular_momentum: [0, 0, 0],
        residual: 0,
        events: 0,
        robots: [{ efforts: efforts[k]!, velocities: velocities[k]! }],
        ...(k === 0 && impulses.length > 0
          ? {
              impacts: impulses.map((impulse, i) => ({
                at: 0.5 / (i + 1),
                bodies: [0, 1] as const,
                point: [0, 0, 0] as const,
                impulse,
              })),
            }
          : {}),
      })),
      ways: [],
      contacts: {
        until: new Uint32Array(efforts.length),
        bodies: new Uint32Array(),
        points: new Float64Array(),
        impulses: new Float32Array(),
        distances: new Float32Array(),
      },
      devices: [],
    });
  const moving = [
    [1, 0],
    [3, -2],
  ];

  test("says what motors give, and take where they brake", () => {
    const driven = run(
      [
        [5, 0],
        [-7, 4],
      ],
      moving,
    );
    expect(driven.motorPowers).toEqual([5, -18]);
    const chart = runCharts(driven, []).find(({ name }) => name === "power of motors")!;
    expect(chart.content.unit).toBe("W");
    expect(chart.content.range[0]).toBeLessThan(-18);
    expect(chart.content.range[1]).toBeGreaterThan(5);
  });

  test("says how hard the hardest impact of each step is", () => {
    const still = [[0], [0]];
    const hit = run(still, still, [
      [0, 3, 4],
      [-1, 0, 0],
    ]);
    const chart = runCharts(hit, []).find(({ name }) => name === "greatest impact")!;
    expect(chart.content.unit).toBe("N s");
    expect(chart.values).toEqual([5, 0]);
    expect(hit.impacts.map(({ t }) => t)).toEqual([0.125, 0.25]); // In the order of time.
    expect(hit.impactsIn(0).map(({ impulse }) => impulse[0])).toEqual([0, -1]);
    expect(hit.impactsIn(1)).toEqual([]);
    expect(hit.firstTouch).toBe(0.125);
    expect(run(still, still).firstTouch).toBeNull();
  });

  test("has no charts of what it does not have", () => {
    const free = run(
      [
        [0, 0],
        [0, 0],
      ],
      moving,
    );
    expect(free.motorPowers).toBeNull();
    const names = runCharts(free, []).map(({ name }) => name);
    expect(names).not.toContain("power of motors");
    expect(names).not.toContain("greatest impact");
    expect(names).toContain("kinetic energy");
  });

  test("of a haptic tool has neither energy nor forces", () => {
    const still = [[0], [0]];
    const felt = run(still, still, [], { kind: "haptics" });
    expect(felt.hasDynamics).toBe(false);
    const names = runCharts(felt, []).map(({ name }) => name);
    expect(names).toContain("contacts");
    expect(names).not.toContain("kinetic energy");
    expect(names).not.toContain("greatest contact force");
    expect(verdictOf({ result: null, run: felt } as never).text).toBe("Recorded");
    expect(felt.eventName).toBe("Rounds");
  });

  test("is simulated though nothing has energy or touches", () => {
    const still = [[0], [0]];
    const simulated = run(still, still);
    expect(simulated.hasDynamics).toBe(true);
    expect(simulated.eventName).toBe("Impacts");
    expect(verdictOf({ result: null, run: simulated } as never).text).toBe("Simulated");
  });

  test("is whole by its steps, which may have lost time", () => {
    const text = (count: number, last: number): string => {
      const still = Array.from({ length: count }, () => [0]);
      const data = run(still, still, [], { last });
      return verdictOf({ result: null, run: data } as never).text;
    };
    expect(text(2, 1.5)).toBe("Simulated");
    expect(text(1, 1)).toBe("Stopped early");
  });

  test("has fine steps of a tenth of a step", () => {
    const still = Array.from({ length: 4 }, () => [0]);
    const four = run(still, still);
    expect(four.fineStep(0.6, 1 / 1000)).toBe(1 / 1000);
    expect(four.fineStep(0.6, 1)).toBeCloseTo(1 / 40, 12);
  });

  test("counts free bodies without links", () => {
    const one = run([[0]], [[0]], [], { masses: [2, 0, 0.4, 0.3], linksFrom: 2 });
    expect(one.freeCount).toBe(1);
    expect(one.linkCount).toBe(2);
  });
});

describe("the clock", () => {
  test("pauses at the contact, and goes on from there", () => {
    const player = new Player(2, 0.25);
    player.speed.value = 1;
    player.toggle();
    player.advance(0.4);
    expect(player.t.value).toBeCloseTo(0.2, 12);
    player.advance(0.4);
    expect(player.t.value).toBe(0.25);
    expect(player.playing.value).toBe(false);
    player.toggle();
    player.advance(0.5);
    expect(player.t.value).toBeCloseTo(0.5, 12);
  });

  test("ends at the end, or repeats", () => {
    const player = new Player(1, null);
    player.speed.value = 1;
    player.toggle();
    player.advance(5);
    expect(player.t.value).toBe(1);
    player.loop.value = true;
    player.toggle();
    expect(player.t.value).toBe(0);
    player.advance(5);
    expect(player.t.value).toBe(0);
    expect(player.playing.value).toBe(true);
  });

  test("starts at a speed at which a step can be watched", () => {
    expect(new Player(0.025, null).speed.value).toBe(0.005);
    expect(new Player(5, null).speed.value).toBe(1);
  });

  test("stays inside the step", () => {
    const player = new Player(1, null);
    player.seek(7);
    expect(player.t.value).toBe(1);
    player.seek(NaN);
    expect(player.t.value).toBe(0);
  });
});

describe("a link", () => {
  test("names a moment of the step, or none", () => {
    expect(momentOf("#t=0.42")).toBe(0.42);
    expect(momentOf("#t=1")).toBe(1);
    for (const wrong of ["", "#", "#t=", "#t=x", "#t=1.5", "#t=-1"]) {
      expect(momentOf(wrong)).toBeNull();
    }
  });
});

describe("edges", () => {
  const mesh = (positions: number[], triangles: number[]) => ({
    origin: [0, 0, 0] as const,
    positions: new Float32Array(positions),
    triangles: new Uint32Array(triangles),
  });

  test("leave out the diagonal of a flat square", () => {
    const square = mesh([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], [0, 1, 2, 0, 2, 3]);
    expect(featureEdges(square).length / 2).toBe(4);
  });

  test("keep the diagonal of a bent one", () => {
    const bent = mesh([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1], [0, 1, 2, 0, 2, 3]);
    expect(featureEdges(bent).length / 2).toBe(5);
  });
});

describe("a curved body", () => {
  /// A prism of 24 sides without ends.
  const sides = 24;
  const corners = [...Array(2 * sides).keys()].flatMap((k) => {
    const angle = (2 * Math.PI * (k >> 1)) / sides;
    return [Math.cos(angle), Math.sin(angle), k & 1];
  });
  const triangles = [...Array(sides).keys()].flatMap((k) => {
    const [a, b] = [2 * k, (2 * k + 2) % (2 * sides)];
    return [a, b, b + 1, a, b + 1, a + 1];
  });
  const prism = {
    origin: [0, 0, 0] as const,
    positions: new Float32Array(corners),
    triangles: new Uint16Array(triangles),
  };
  const drawn = (smooth: boolean) =>
    new DrawnShapes().of({
      mesh: { ...prism, smooth },
      radius: 0,
      to: null,
      color: null,
      pose: { position: [0, 0, 0], rotation: [1, 0, 0, 0] },
    });

  test("has the normals of its surface at the corners", () => {
    const { geometry, kind } = drawn(true);
    expect(kind).toBe("smooth");
    const [position, normal] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
    expect(position.count).toBe(3 * 2 * sides);
    for (let k = 0; k < position.count; ++k) {
      expect(normal.getX(k)).toBeCloseTo(position.getX(k), 1);
      expect(normal.getY(k)).toBeCloseTo(position.getY(k), 1);
      expect(normal.getZ(k)).toBeCloseTo(0, 6);
    }
    expect(drawn(false).kind).toBe("triangles");
  });
});

describe("a rounded box", () => {
  test("reaches the radius beyond its corners, edges and sides, and no farther", () => {
    const corners = [...Array(8).keys()].map((k) => [k & 1, (k >> 1) & 1, (k >> 2) & 1]);
    const sides = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4];
    const box = {
      origin: [0, 0, 0] as const,
      positions: new Float32Array(corners.flat()),
      triangles: new Uint16Array([...sides, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6]),
    };
    const position = thickHull(box, 0.25).getAttribute("position");
    let [least, most, high] = [Infinity, 0, 0];
    for (let k = 0; k < position.count; ++k) {
      const out = [position.getX(k), position.getY(k), position.getZ(k)].map((x) =>
        Math.max(0, -x, x - 1),
      );
      least = Math.min(least, Math.hypot(...out));
      most = Math.max(most, Math.hypot(...out));
      high = Math.max(high, position.getZ(k));
    }
    expect(least).toBeCloseTo(0.25, 6);
    expect(most).toBeCloseTo(0.25, 6);
    expect(high).toBeCloseTo(1.25, 6);
  });
});

describe("the data of a page", () => {
  test("come as numbers", () => {
    const text = JSON.stringify({
      result: { id: "x" },
      view: {
        bodies: [0],
        meshes: [{ origin: [9, 2, 0], positions: "AACAvwAAAMAAAAAA", triangles: "AAABAAIA" }],
        gap: { t: [], distance: [] },
        gap_bound: { t: [], distance: [] },
      },
    });
    const { meshes } = readPageData(text);
    expect([...meshes[0]!.positions]).toEqual([-1, -2, 0]);
    expect([...meshes[0]!.triangles]).toEqual([0, 1, 2]);
  });

  test("are missed with a word on how to make them", () => {
    expect(() => readPageData('"FIRSTCONTACT_RESULT"')).toThrow(/firstcontact check/);
  });
});

describe("names", () => {
  test("share the beginnings that tell nothing", () => {
    const names = ["panda_link1", "panda_leftfinger", "Can1", "shelf_top", "shelf_left_1", "a_b"];
    expect([...sharedBeginnings(names).values()]).toEqual([
      "panda_",
      "panda_",
      "",
      "shelf_",
      "shelf_",
      "",
    ]);
    expect(sharedBeginnings(["arm/left_1", "arm/left_2"]).get("arm/left_2")).toBe("arm/left_");
    expect(sharedBeginnings(["a_", "a_", "a_b"]).get("a_")).toBe("");
  });
});

describe("the pairs that an answer is about", () => {
  const counts = {
    tested: 3,
    ignored: 5,
    left_out: 1,
    untested: [
      {
        why: "srdf",
        count: 5,
        first: [
          ["a", "b"],
          ["a", "c"],
        ],
      },
      { why: "both_scripted", count: 1, first: [["d", "e"]] },
    ],
  } as const;

  test("are told with a count, the first few names and a reason", () => {
    expect(untestedText(counts.untested[0])).toBe("5 by the SRDF: a and b, a and c, and 3 more");
    expect(pairFacts(counts)).toEqual([
      ["Ignored", "5 by the SRDF: a and b, a and c, and 3 more"],
      ["Left out", "1 of which neither is free (they may pass through each other): d and e"],
    ]);
    expect(pairFacts(null)).toEqual([]);
  });

  test("are the subject of what is claimed", () => {
    expect(noneOf(counts, "touches")).toBe("none of the 3 tested pairs touches");
    expect(noneOf({ ...counts, tested: 1 }, "touches")).toBe("the one tested pair never touches");
    expect(noneOf(null, "touches")).toBe("none of the tested pairs touches");
  });
});
