/// The viewer's robots against poses that the library also reproduces (tests/scene), and their joints.

import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import { readPageData } from "../src/data/page_data";
import type { QuaternionWxyz, Vector3 } from "../src/data/result";
import { Model } from "../src/model";
import { coordinateAt, derivativeAt, restsAt } from "../src/motion/robot";
import { distance, length, rotate } from "../src/motion/vector";
import { gapContent } from "../src/panels/gap_chart";
import { badTimes, jointContent, rangeOf, rateTimesOf, valueText } from "../src/panels/joint_chart";
import { ratesText } from "../src/panels/joints";

interface StoredPose {
  readonly body: string;
  readonly t: number;
  readonly position: Vector3;
  readonly quaternion_wxyz: QuaternionWxyz;
}

const stored = JSON.parse(
  readFileSync(new URL("data/robot_poses.json", import.meta.url), "utf8"),
) as { page: object; poses: StoredPose[] };
const model = new Model(readPageData(JSON.stringify(stored.page)));

describe.each(model.bodies.map(({ name }) => name))("the motion of %s", (name) => {
  const poses = stored.poses.filter(({ body }) => body === name);

  test("is that of the library", () => {
    expect(poses.length).toBe(8);
    for (const pose of poses) {
      const { position, rotation } = model.body(name).motion(pose.t);
      expect(distance(position, pose.position)).toBeLessThan(1e-13 * (1 + length(position)));
      for (const axis of [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ] as const) {
        const off = distance(rotate(rotation, axis), rotate(pose.quaternion_wxyz, axis));
        expect(off).toBeLessThan(1e-13);
      }
    }
  });
});

describe("a robot", () => {
  test("has its links after the bodies, each with its name", () => {
    expect(model.bodies.map(({ name }) => name).slice(0, 3)).toEqual([
      "load",
      "zoo/ground",
      "zoo/cart",
    ]);
    expect(model.body("zoo/hook").kind).toBe("prismatic");
    expect(model.body("load").kind).toBe("carried by hook");
    expect(model.bodies.every(({ atRest }) => !atRest)).toBe(true); // Its base moves.
  });

  test("knows how far its links turn", () => {
    const turns = (name: string): number => model.body(name).angle;
    expect(turns("zoo/mast")).toBeGreaterThan(turns("zoo/cart"));
    expect(turns("zoo/bit")).toBeGreaterThan(40); // The screw alone goes 40 rad and back.
  });
});

describe("a coordinate", () => {
  const segments = [
    { until: 0.25, a: [1] },
    { until: 0.75, a: [1, 0, 4] },
    { until: 1, a: [5, -5] },
  ];

  test("follows its polynomials", () => {
    expect([0, 0.1, 0.25, 0.5, 0.75, 0.875, 1].map((t) => coordinateAt(segments, t))).toEqual([
      1, 1, 1, 2, 5, 2.5, 0,
    ]);
  });

  test("has the derivatives of its polynomials", () => {
    // 1, then 1 + 4 s² over half of the time, then 5 - 5 s over a quarter.
    expect([0.1, 0.5, 0.75, 0.9].map((t) => derivativeAt(segments, t, 1))).toEqual([0, 8, 16, -20]);
    expect([0.1, 0.5, 0.9].map((t) => derivativeAt(segments, t, 2))).toEqual([0, 32, 0]);
    expect(derivativeAt(segments, 0.5, 3)).toBe(0);
  });

  test("rests or does not", () => {
    expect(restsAt(segments)).toBe(false);
    expect(restsAt([{ until: 1, a: [2] }])).toBe(true);
    expect(
      restsAt([
        { until: 0.5, a: [2] },
        { until: 1, a: [2, 0] },
      ]),
    ).toBe(true);
    expect(
      restsAt([
        { until: 0.5, a: [2] },
        { until: 1, a: [3] },
      ]),
    ).toBe(false);
  });

  test("of every joint has a name, a unit and limits", () => {
    const one = (name: string) => model.coordinates.find((found) => found.name === name)!;
    expect(model.coordinates.length).toBe(8);
    expect(one("rail/x").unit).toBe("m");
    expect(one("rail/theta").unit).toBe("rad");
    expect([one("lift").lower, one("lift").upper, one("rotor").upper]).toEqual([-1, 1, null]);
    expect(one("follow").mimics).toBe("lift");
    expect(one("follow").at(0.6)).toBeCloseTo(0.5 * one("lift").at(0.6) + 0.1, 14);
  });
});

describe("the chart of a joint", () => {
  const joint = {
    ...model.coordinates.find(({ name }) => name === "lift")!,
    violations: [
      {
        robot: "zoo",
        joint: "lift",
        limit: "upper_position",
        value: 1,
        excess: 0.1,
        time: 1.8,
        intervals: [[1.5, 2]],
      } as const,
    ],
  };

  test("reaches around limits and way", () => {
    const [least, most] = rangeOf(joint, [-0.7, 1.1]);
    expect(least).toBeLessThan(-1);
    expect(most).toBeGreaterThan(1.1);
    expect(rangeOf({ ...joint, lower: null, upper: null }, [3, 3])[1]).toBeGreaterThan(3);
  });

  test("marks limits, and where they are left", () => {
    const { levels, bands, lines, unit } = jointContent(joint, 2);
    expect([levels, unit]).toEqual([[-1, 1], "m"]);
    expect(bands).toEqual([{ from: 0.75, to: 1, color: "chart-bad" }]);
    expect(badTimes(joint, 4)).toEqual([[0.375, 0.5]]);
    const [line] = lines;
    expect(line!.t).toContain(0.9); // The end of a segment.
    expect(line!.value[line!.t.indexOf(0.5)]).toBeCloseTo(-0.7, 12);
  });

  test("tells values in units, angles in degrees too", () => {
    expect(valueText(0.065, joint)).toBe("0.065\u00a0m");
    expect(valueText(-Math.PI / 2, { ...joint, unit: "rad" })).toBe("−1.571\u00a0rad · −90°");
  });
});

describe("the rates of a joint", () => {
  const page = JSON.parse(JSON.stringify(stored.page)) as {
    view: { rates?: object[]; robots: { joints: { name: string; coordinates?: object[] }[] }[] };
  };
  const lift = page.view.robots[0]!.joints.find(({ name }) => name === "lift")!;
  // 1 - 3 s² + 2 s³ down and up again: cubics at rest at both ends.
  lift.coordinates = [
    {
      name: "lift",
      segments: [
        { until: 0.5, a: [1, 0, -3, 2] },
        { until: 1, a: [0, 0, 3, -2] },
      ],
    },
  ];
  page.view.rates = [
    { robot: "zoo", coordinate: "lift", velocity: 2.5, acceleration: 5, jerk: 60 },
  ];
  const moved = new Model(readPageData(JSON.stringify(page)));
  const joint = moved.coordinates.find(({ name }) => name === "lift")!;

  test("are those of its polynomials in seconds", () => {
    expect(joint.rates.map(({ name, limit }) => [name, limit])).toEqual([
      ["velocity", 2.5],
      ["acceleration", 5],
      ["jerk", 60],
    ]);
    const half = moved.duration / 2; // Of each cubic, in seconds.
    expect(joint.rates[0]!.at(0.25)).toBeCloseTo(-1.5 / half, 12);
    expect(joint.rates[1]!.at(0)).toBeCloseTo(-6 / half ** 2, 12);
    expect(joint.rates[2]!.at(0.75)).toBeCloseTo(-12 / half ** 3, 12);
  });

  test("are drawn between their limits, with their jumps", () => {
    const { title, unit, levels, range, lines } = jointContent(joint, moved.duration, {
      shown: "acceleration",
    });
    expect([title, unit, levels]).toEqual(["lift, acceleration", "m/s²", [-5, 5]]);
    expect(range[0]).toBeLessThan(-5);
    expect(range[1]).toBeGreaterThan(5);
    const t = rateTimesOf(joint);
    expect(lines[0]!.t).toEqual(t);
    const k = t.findIndex((moment) => moment > 0.5);
    const half = moved.duration / 2;
    expect(lines[0]!.value[k - 1]).toBeCloseTo(6 / half ** 2, 6);
    expect(lines[0]!.value[k]).toBeCloseTo(6 / half ** 2, 6);
    expect(t[k]! - t[k - 1]!).toBeLessThan(3e-9);
  });

  test("may be chosen, as far as they are known", () => {
    const picked: string[] = [];
    const { choices } = jointContent(joint, 2, { pick: (next) => picked.push(next) });
    expect(choices!.map(({ name, isShown }) => [name, isShown])).toEqual([
      ["position", true],
      ["velocity", false],
      ["acceleration", false],
      ["jerk", false],
    ]);
    choices![2]!.pick();
    expect(picked).toEqual(["acceleration"]);
    // Between positions alone, velocities jump; without a limit a jerk is of no interest.
    const rates = (name: string): readonly string[] =>
      model.coordinates.find((one) => one.name === name)!.rates.map((rate) => rate.name);
    expect(rates("rotor")).not.toContain("jerk");
    expect(jointContent(joint, 2, { shown: "velocity" }).choices).toBeUndefined();
  });

  test("are told with their limits", () => {
    const half = moved.duration / 2;
    const three = (x: number): string => String(Number(x.toPrecision(3)));
    const text = ratesText(joint);
    expect(text).toContain(`velocity to ${three(1.5 / half)} of 2.5\u00a0m/s`);
    expect(text).toContain(`acceleration to ${three(6 / half ** 2)} of 5\u00a0m/s²`);
    expect(ratesText(model.coordinates.find(({ name }) => name === "rotor")!)).toBe("");
  });
});

describe("the chart of the gap", () => {
  test("shades every contact that the result tells of", () => {
    const line = { t: [0, 1], distance: [0.5, 0] };
    const pair = { intervals: [{ enter: 0.2, leave: 0.4 }] };
    const content = gapContent({
      gap: line,
      gapBound: line,
      pairs: [pair, {}],
    } as unknown as Model);
    expect(content!.bands).toEqual([{ from: 0.2, to: 0.4, color: "chart-contact" }]);
    expect(content!.unit).toBe("mm");
    const nothing = { t: [], distance: [] };
    expect(
      gapContent({ gap: nothing, gapBound: nothing, pairs: [] } as unknown as Model),
    ).toBeNull();
  });
});
