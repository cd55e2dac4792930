/// The page of a run in a browser: bodies are where the record says, at every instant.

import { readFileSync } from "node:fs";
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, test } from "vitest";
import type { QuaternionWxyz, Vector3 } from "../src/data/result";
import type { WayData } from "../src/data/run_data";
import { keysAlong, motionAlong } from "../src/motion/way";
import {
  add,
  compose,
  distance,
  length,
  rotate,
  scale,
  subtract,
  turn,
  unit,
} from "../src/motion/vector";
import { canLook, Folder, launch, type MadeRun } from "./browser";

describe("the way of a body", () => {
  const quarter = 0.5 * Math.PI;
  const way: WayData = {
    body: 0,
    times: new Float64Array([0, 1, 1, 3]),
    places: new Float64Array([0, 0, 0, 2, 0, 0, 2, 0, 0, 2, 4, 0]),
    rotations: new Float32Array([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, Math.SQRT1_2, 0, 0, Math.SQRT1_2]), // prettier-ignore
    turns: new Float32Array([0, 0, 0, 0, 0, 0, 0, 0, quarter]),
  };
  const motion = motionAlong(way, [1, 0, 0], 3);

  test("goes on lines between its places, while the body turns about its centre of mass", () => {
    expect(distance(motion(0.5 / 3).position, [0, 0, 0])).toBeLessThan(1e-12);
    const { position, rotation } = motion(2 / 3);
    const c = Math.SQRT1_2;
    expect(distance(position, [2 - c, 2 - c, 0])).toBeLessThan(1e-6);
    expect(distance(rotate(rotation, [1, 0, 0]), [c, c, 0])).toBeLessThan(1e-6);
  });

  test("stays at its ends", () => {
    expect(distance(motion(0).position, [-1, 0, 0])).toBeLessThan(1e-12);
    expect(distance(motion(1).position, [2, 3, 0])).toBeLessThan(1e-6);
    expect(distance(motion(1.5).position, [2, 3, 0])).toBeLessThan(1e-6);
  });

  const turning = (...angles: number[]): WayData => ({
    ...way,
    times: Float64Array.from([0, ...angles], (_, k) => k),
    turns: new Float32Array(angles.flatMap((angle) => [0, 0, angle])),
  });

  test("has keys at the ends of its pieces, and within those that turn fast", () => {
    expect(keysAlong(turning(0, 1.5, 0), 100)).toEqual([0, 1, 2, 3]);
    expect(keysAlong(turning(0, 2.9 * Math.PI, 0), 100)).toEqual(
      [0, 1, 7 / 6, 8 / 6, 9 / 6, 10 / 6, 11 / 6, 2, 3].map((time) => expect.closeTo(time, 12)),
    );
  });

  test("leaves keys out only where it turns by less than a quarter between them", () => {
    expect(keysAlong(turning(0, 0, 0, 0, 0, 0), 3)).toEqual([0, 2, 4, 6]);
    expect(keysAlong(turning(1, 1, 0, 0, 1, 1), 3)).toEqual([0, 1, 2, 4, 5, 6]);
  });
});

/// A crate with an odd centre of mass that turns and drops on a floor, and a pusher.
const centre: Vector3 = [0.1, 0, 0.05];
const drop = {
  firstcontact: 1,
  id: "drop",
  bodies: [
    {
      name: "crate",
      shape: { box: { size: [1, 1, 1] } },
      pose: { position: [0, 0, 0.8] },
      dynamics: { centre_of_mass: centre, angular_velocity: [0, 0, 3], linear_velocity: [1, 0, 0] },
    },
    { name: "floor", shape: { box: { size: [9, 9, 0.1] } } },
    {
      name: "pusher",
      shape: { sphere: { radius: 0.1 } },
      motion: {
        type: "waypoints",
        times: [0, 1],
        poses: [{ position: [-4, 3, 1] }, { position: [4, 3, 1] }],
      },
    },
  ],
  simulation: { duration: 1, step: 0.02, gravity: [0, 0, -10], friction: 0.3 },
};

describe.skipIf(!canLook)("the page of a run", () => {
  let browser: Browser;
  let made: MadeRun;
  const folder = new Folder();
  const complaints: string[] = [];
  const open: Page[] = [];

  const show = async (hash = "", options: BrowserContextOptions = {}) => {
    const viewport = { width: 1100, height: 720 };
    const context = await browser.newContext({ reducedMotion: "reduce", viewport, ...options });
    const page = await context.newPage();
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(String(error)));
    open.push(page);
    await page.goto(made.url + hash);
    await page.waitForFunction(() => "firstcontact" in window);
    return page;
  };
  const timeOf = (page: Page) => page.evaluate(() => window.firstcontact.player.t.value);
  const matrixOf = (page: Page, body: number, t: number) =>
    page.evaluate(
      ([index, moment]) => {
        window.firstcontact.player.seek(moment!);
        return [...window.firstcontact.view.bodies[index!]!.group.matrix.elements];
      },
      [body, t],
    );
  const text = (page: Page, name: string) =>
    page.getByRole("region", { name, exact: true }).textContent();

  beforeAll(async () => {
    made = await folder.simulate("drop", drop);
    browser = await launch();
  });

  afterEach(async () => {
    await Promise.all(open.splice(0).map((page) => page.context().close()));
  });

  afterAll(async () => {
    await browser?.close();
    folder.remove();
  });

  test("has bodies where the record says, within steps too", async () => {
    const page = await show();
    for (const index of [0, 7, 18, 19, 20, 33, 49]) {
      const step = made.steps[index]!;
      const begin = step.time - step.lasted;
      for (const { body, pieces } of step.bodies) {
        const [to, px, py, pz, qw, qx, qy, qz, tx, ty, tz, rx, ry, rz] = pieces[0] as number[];
        for (const share of [0.25, 0.5, 1]) {
          const t = Math.min(begin + share * to!, 1);
          const c = body === 0 ? centre : ([0, 0, 0] as const);
          const from: QuaternionWxyz = [qw!, qx!, qy!, qz!];
          const turned: Vector3 = [rx!, ry!, rz!];
          const rotation = compose(turn(unit(turned), share * length(turned)), from);
          const middle = add(add([px!, py!, pz!], rotate(from, c)), scale(share, [tx!, ty!, tz!]));
          const wanted = subtract(middle, rotate(rotation, c));
          const m = await matrixOf(page, body, t);
          expect(distance(m.slice(12, 15) as unknown as Vector3, wanted)).toBeLessThan(1e-6);
          const across = rotate(rotation, [1, 0, 0]);
          expect(distance(m.slice(0, 3) as unknown as Vector3, across)).toBeLessThan(1e-6);
        }
      }
    }
  });

  test("says what the run and its steps amount to", async () => {
    const page = await show();
    expect(await text(page, "Run")).toMatch(/Apart≥/);
    expect(await text(page, "Run")).toMatch(/drop.*Simulated.*Steps50, 1\ss.*Bodies3, 1 free/);
    const index = made.steps.findIndex(({ contacts }) =>
      contacts.some(({ impulse }) => length(impulse) > 0),
    );
    const { time, lasted, contacts } = made.steps[index]!;
    await page.evaluate((t) => window.firstcontact.player.seek(t), time - 0.5 * lasted);
    expect(await text(page, "Step")).toMatch(
      new RegExp(`Step ${index + 1} of 50.*Contacts${contacts.length}Apart≥`),
    );
    expect(await text(page, "Contacts")).toMatch(/crate · floor[\d.]+\s(kN|N), [\d.]+\sµm apart/);
    const most = Math.max(...contacts.map(({ impulse }) => length(impulse))) / lasted;
    const shown = /Greatest contact force([\d.]+)\s(kN|N)/.exec((await text(page, "Step"))!)!;
    expect((Number(shown[1]) * (shown[2] === "kN" ? 1000 : 1)) / most).toBeCloseTo(1, 2);
  });

  test("draws contacts with their forces, and hides them", async () => {
    const page = await show("#t=0.99");
    const shown = () =>
      page.evaluate(() => {
        const { dots, arrows } = window.firstcontact.view.forces!;
        return { dots: dots.visible, arrows: arrows.visible, count: arrows.count };
      });
    const { count } = await shown();
    expect(count).toBe(made.steps.at(-1)!.contacts.length);
    // Gravity acts on the crate, the floor carries it: upwards.
    const up = await page.evaluate(() =>
      window.firstcontact.view.forces!.arrows.instanceMatrix.array.slice(8, 11),
    );
    expect(up[2]).toBeGreaterThan(0);
    await page.keyboard.press("a");
    expect(await shown()).toMatchObject({ dots: true, arrows: false });
    await page.getByRole("button", { name: "Contact points" }).click();
    expect(await shown()).toMatchObject({ dots: false, arrows: false });
    await page.evaluate(() => window.firstcontact.player.seek(0));
    expect((await shown()).count).toBe(0);
  });

  test("goes from step to step, in real time", async () => {
    const page = await show();
    expect(await page.getByRole("combobox", { name: "Speed" }).inputValue()).toBe("1");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    expect(await timeOf(page)).toBeCloseTo(made.steps[1]!.time, 12);
    await page.keyboard.press("ArrowLeft");
    expect(await timeOf(page)).toBeCloseTo(made.steps[0]!.time, 12);
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction(() => window.firstcontact.player.t.value === 1);
  });

  test("draws what is said of steps over time", async () => {
    const page = await show();
    const title = page.locator(".chart-title");
    expect(await title.textContent()).toBe("energy [kJ]totalkinetic");
    const chart = page.getByRole("region", { name: "Over time" });
    for (const [name, shown] of [
      ["contacts", "contacts"],
      ["greatest contact force", "greatest contact force [kN]"],
      ["impacts", "impacts"],
      ["apart by at least", "apart by at least [µm]"],
      ["time lost", "time lost [s]"],
      ["kinetic energy", "energy [kJ]totalkinetic"],
    ] as const) {
      await chart.getByRole("button", { name }).click();
      expect(await title.textContent()).toBe(shown);
    }
    await page.evaluate(() => window.firstcontact.player.seek(1));
    expect(await chart.textContent()).toMatch(/contacts[1-9]/);
  });

  test("saves the animation with a key at each step", async () => {
    const page = await show();
    const [glb] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Save the animation (GLB)" }).click(),
    ]);
    const stream = await glb.createReadStream();
    const chunks: Buffer[] = [];
    for await (const chunk of stream) {
      chunks.push(chunk as Buffer);
    }
    const bytes = Buffer.concat(chunks);
    const json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString()) as {
      animations: { channels: unknown[]; samplers: { input: number }[] }[];
      accessors: { count: number }[];
    };
    expect(json.animations[0]!.channels.length).toBe(4); // Crate and pusher.
    expect(json.accessors[json.animations[0]!.samplers[0]!.input]!.count).toBe(51);
  });

  test("fits into the window of a phone", async () => {
    const page = await show("", { viewport: { width: 390, height: 780 }, hasTouch: true });
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(
      390,
    );
    await page.getByRole("button", { name: "Side panel" }).tap();
    expect(await page.getByRole("region", { name: "Step" }).isVisible()).toBe(true);
  });

  test("complained about nothing", () => {
    expect(complaints).toEqual([]);
  });
});

/// A bar with an odd centre of mass that turns by more than two turns in a step.
const spin = {
  firstcontact: 1,
  id: "spin",
  bodies: [
    {
      name: "bar",
      shape: { box: { size: [1, 0.2, 0.3] } },
      pose: { position: [0, 0, 5], rpy: [0.3, 0.2, 0.1] },
      dynamics: {
        angular_velocity: [30, 700, -100],
        linear_velocity: [1, 2, 3],
        centre_of_mass: [0.1, 0.02, 0],
        mass: 2,
        inertia: [
          [1, 0, 0],
          [0, 2, 0],
          [0, 0, 2.5],
        ],
      },
    },
  ],
  simulation: { duration: 0.2, step: 0.02 },
};

interface AnimationJson {
  readonly animations: readonly {
    readonly channels: readonly { sampler: number; target: { path: string; node: number } }[];
    readonly samplers: readonly { input: number; output: number }[];
  }[];
  readonly accessors: readonly { bufferView: number; byteOffset?: number; count: number }[];
  readonly bufferViews: readonly { byteOffset?: number }[];
  readonly nodes: readonly { translation?: Vector3; children?: number[] }[];
}

describe.skipIf(!canLook)("the animation of a body that spins fast", () => {
  test("has it where the run has it, between keys too", async () => {
    const folder = new Folder();
    const made = await folder.simulate("spin", spin);
    const browser = await launch();
    const page = await browser.newPage();
    await page.goto(made.url);
    await page.waitForFunction(() => "firstcontact" in window);
    const [glb] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Save the animation (GLB)" }).click(),
    ]);
    const bytes = readFileSync(await glb.path());
    const head = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + head).toString()) as AnimationJson;
    const numbers = (accessor: number, width: number): number[][] => {
      const { bufferView, byteOffset = 0, count } = json.accessors[accessor]!;
      const at = 28 + head + byteOffset + (json.bufferViews[bufferView]!.byteOffset ?? 0);
      return Array.from({ length: count }, (_, k) =>
        Array.from({ length: width }, (_, i) => bytes.readFloatLE(at + 4 * (k * width + i))),
      );
    };
    const said = await page.getByRole("region", { name: "Run", exact: true }).textContent();
    expect(said).toContain("Apartno pair to keep apart"); // It is alone.
    const { channels, samplers } = json.animations[0]!;
    const track = (path: string, width: number) => {
      const { input, output } = samplers[channels.find((c) => c.target.path === path)!.sampler]!;
      return { times: numbers(input, 1).flat(), values: numbers(output, width) };
    };
    const places = track("translation", 3);
    const rotations = track("rotation", 4);
    const surface = json.nodes[json.nodes[channels[0]!.target.node]!.children![0]!]!;

    // As glTF has it: on lines, and by the shortest turn.
    const keyAt = (times: number[], time: number) => {
      const next = Math.max(
        times.findIndex((key) => key >= time),
        1,
      );
      const share = (time - times[next - 1]!) / (times[next]! - times[next - 1]!);
      return { next, share };
    };
    const played = (time: number): { position: Vector3; rotation: QuaternionWxyz } => {
      const turning = keyAt(rotations.times, time);
      const [from, to] = [turning.next - 1, turning.next].map((k): QuaternionWxyz => {
        const [x, y, z, w] = rotations.values[k]!;
        return [w!, x!, y!, z!];
      }) as [QuaternionWxyz, QuaternionWxyz];
      const [w, x, y, z] = compose(to, [from[0], -from[1], -from[2], -from[3]]);
      const v: Vector3 = w < 0 ? [-x, -y, -z] : [x, y, z];
      const angle = 2 * Math.atan2(length(v), Math.abs(w));
      const rotation = compose(turn(unit(v), turning.share * angle), from);
      const going = keyAt(places.times, time);
      const [a, b] = [going.next - 1, going.next].map(
        (k) => places.values[k] as unknown as Vector3,
      );
      const node = add(a!, scale(going.share, subtract(b!, a!)));
      return { position: add(node, rotate(rotation, surface.translation!)), rotation };
    };
    for (const step of made.steps) {
      const { pieces } = step.bodies[0]!;
      let begin = 0;
      let all = 0;
      for (const piece of pieces) {
        const [to, px, py, pz, qw, qx, qy, qz, tx, ty, tz, rx, ry, rz] = piece as number[];
        const turned: Vector3 = [rx!, ry!, rz!];
        all += length(turned);
        for (const share of [0.25, 0.71]) {
          const start: QuaternionWxyz = [qw!, qx!, qy!, qz!];
          const rotation = compose(turn(unit(turned), share * length(turned)), start);
          const c: Vector3 = [0.1, 0.02, 0];
          const from = add([px!, py!, pz!], rotate(start, c));
          const middle = add(from, scale(share, [tx!, ty!, tz!]));
          const time = step.time - step.lasted + begin + share * (to! - begin);
          const seen = played(time);
          const across = distance(rotate(seen.rotation, [1, 0, 0]), rotate(rotation, [1, 0, 0]));
          expect(across).toBeLessThan(1e-3);
          expect(distance(seen.position, subtract(middle, rotate(rotation, c)))).toBeLessThan(1e-3);
        }
        begin = to!;
      }
      expect(all).toBeGreaterThan(4 * Math.PI);
    }
    await browser.close();
    folder.remove();
  });
});

describe.skipIf(!canLook)("a page of odd names", () => {
  test("is named by its file, and holds long names in its panel", async () => {
    const folder = new Folder();
    const { id, ...nameless } = drop;
    const [first, ...others] = drop.bodies;
    const long = { ...first, name: "x".repeat(300) };
    const simulation = { ...drop.simulation, duration: 0.4 };
    const bodies = [long, ...others];
    const made = await folder.simulate(`${id} it`, { ...nameless, simulation, bodies });
    const browser = await launch();
    const page = await browser.newPage();
    await page.goto(made.url);
    await page.waitForFunction(() => "firstcontact" in window);
    expect(await page.title()).toBe("drop it · firstcontact");
    const [glb] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Save the animation (GLB)" }).click(),
    ]);
    expect(glb.suggestedFilename()).toBe("drop-it.glb");
    await page.evaluate(() => window.firstcontact.player.seek(1));
    const room = await page.locator("aside.panel").evaluate((panel) => ({
      wide: panel.scrollWidth,
      seen: panel.clientWidth,
    }));
    expect(room.wide).toBeLessThanOrEqual(room.seen);
    // With Shift an arrow goes less far than a step.
    await page.evaluate(() => window.firstcontact.player.seek(0.5));
    await page.keyboard.press("Shift+ArrowRight");
    const t = await page.evaluate(() => window.firstcontact.player.t.value);
    expect(t - 0.5).toBeCloseTo(0.001, 6);
    await browser.close();
    folder.remove();
  });
});

/// Two balls that are shot at a thin plate, and fly on to where the plate is a dot.
const shot = {
  firstcontact: 1,
  id: "shot",
  bodies: [
    { name: "plate", shape: { box: { size: [0.001, 1, 1] } } },
    ...[-0.2, 0.2].map((y) => ({
      name: `ball at ${y} m`,
      shape: { sphere: { radius: 0.05 } },
      pose: { position: [-0.5, y, 0] },
      dynamics: { density: 1000, linear_velocity: [100, 0, 0], restitution: 0.5 },
    })),
  ],
  simulation: { duration: 0.5, gravity: [0, 0, -9.81] },
};

describe.skipIf(!canLook)("the page of bodies that fly far apart", () => {
  let browser: Browser;
  let made: MadeRun;
  const folder = new Folder();

  beforeAll(async () => {
    made = await folder.simulate("shot", shot);
    browser = await launch();
  });

  afterAll(async () => {
    await browser?.close();
    folder.remove();
  });

  const show = async (): Promise<Page> => {
    const context = await browser.newContext({ reducedMotion: "reduce" });
    const page = await context.newPage();
    await page.goto(made.url);
    await page.waitForFunction(() => "firstcontact" in window);
    return page;
  };

  test("opens on the way to the first impact, and shows the whole by a key", async () => {
    const page = await show();
    const range = () =>
      page.evaluate(() => {
        const { x, y, z } = window.firstcontact.view.camera.position;
        return Math.hypot(x, y, z);
      });
    const opening = await range();
    expect(opening).toBeLessThan(8); // The balls fly farther than 20 m.
    await page.keyboard.press("f");
    await page.waitForTimeout(300);
    expect(await range()).toBeGreaterThan(3 * opening);
    await page.keyboard.press("f");
    await page.waitForTimeout(300);
    expect(await range()).toBeCloseTo(opening, 6);
    await page.context().close();
  });

  test("says how hard impacts are", async () => {
    const page = await show();
    const said = async (name: string): Promise<string> =>
      (await page.getByRole("region", { name, exact: true }).textContent())!;
    expect(await said("Run")).toMatch(/Impacts\d+Greatest impact[\d.]+\sk?N sGreatest contact/);
    const { impacts, lasted, time } = made.steps.find((step) => step.impacts)!;
    const end = made.steps.at(-1)!.time;
    await page.evaluate((t) => window.firstcontact.player.seek(t), (time - 0.5 * lasted) / end);
    expect(await said("Impacts")).toMatch(
      new RegExp(
        `^Impacts ${impacts!.length}plate · ball at -?0.2 m[\\d.]+\\sk?N s, [\\d.]+\\sm?s`,
      ),
    );
    await page.context().close();
  });

  test("draws impacts near their time, on the body that they move", async () => {
    const page = await show();
    const { impacts, lasted, time } = made.steps.find((step) => step.impacts)!;
    const end = made.steps.at(-1)!.time;
    const hit = (time - lasted + impacts![0]!.at) / end;
    const shown = (t: number) =>
      page.evaluate((to) => {
        window.firstcontact.player.seek(to);
        const { count, geometry, instanceMatrix } = window.firstcontact.view.forces!.arrows;
        const seen = [...geometry.attributes.shown.array.slice(0, count)];
        const most = Math.max(0, ...seen);
        return { most, along: instanceMatrix.array[16 * seen.indexOf(most) + 8]! }; // In x.
      }, t);
    const at = await shown(hit);
    expect(at.most).toBeCloseTo(1, 5);
    expect(at.along).toBeLessThan(0); // The plate throws the balls back.
    expect((await shown(0.9)).most).toBe(0);
    await page.context().close();
  });
});

/// A crate on a spring, a lamp on a loose cable, a door on a hinge, and a ball pinned to the crate.
const tied = {
  firstcontact: 1,
  id: "tied",
  bodies: [
    { name: "crate", shape: { box: { size: [0.4, 0.4, 0.4] } }, dynamics: { density: 300 } },
    {
      name: "lamp",
      shape: { sphere: { radius: 0.1 } },
      pose: { position: [1, 0, 0.3] },
      dynamics: { density: 500 },
    },
    {
      name: "door",
      shape: { box: { size: [0.6, 0.05, 1] } },
      pose: { position: [-1, 0, 0] },
      dynamics: { density: 300, angular_velocity: [0, 0, 1] },
    },
    {
      name: "ball",
      shape: { sphere: { radius: 0.1 } },
      pose: { position: [0.2, 0, -0.5] },
      dynamics: { density: 500 },
    },
  ],
  simulation: {
    duration: 1,
    step: 0.01,
    gravity: [0, 0, -9.81],
    ties: [
      { type: "spring", bodies: [null, "crate"], points: [[0, 0, 1], [0, 0, 0.2]], stiffness: 2000 }, // prettier-ignore
      {
        type: "cable",
        bodies: [null, "lamp"],
        points: [
          [1, 0, 1],
          [0, 0, 0.1],
        ],
        length: 1,
      },
      { type: "hinge", bodies: [null, "door"], points: [[-1.3, 0, 0], null] },
      { type: "pin", bodies: ["crate", "ball"], points: [null, [0, 0, 0.2]] },
    ],
  },
};

describe.skipIf(!canLook)("the page of bodies that are tied", () => {
  let browser: Browser;
  let made: MadeRun;
  const folder = new Folder();

  beforeAll(async () => {
    made = await folder.simulate("tied", tied);
    browser = await launch();
  });

  afterAll(async () => {
    await browser?.close();
    folder.remove();
  });

  test("draws ties between their points, redder where they bear more", async () => {
    const context = await browser.newContext({ reducedMotion: "reduce" });
    const page = await context.newPage();
    await page.goto(made.url);
    await page.waitForFunction(() => "firstcontact" in window);
    const drawn = (tie: number, t: number) =>
      page.evaluate(
        ([index, moment]) => {
          window.firstcontact.player.seek(moment!);
          const { group } = window.firstcontact.view.ties!;
          const { children } = group.children[index!]!;
          const { material } = children[0]!;
          const at = (part: number) =>
            children[part]!.position.clone().add(group.position).toArray();
          return {
            red: material.color.r - material.color.g,
            opacity: material.opacity,
            from: at(0),
            long: children[0]!.scale.z,
            last: at(children.length - 1),
          };
        },
        [tie, t],
      );
    const placeOf = (step: number, body: number): Vector3 =>
      made.steps[step]!.bodies.find((moved) => moved.body === body)!.position;
    const spring = await drawn(0, 0.5);
    expect(distance(spring.from, [0, 0, 1])).toBeLessThan(1e-5);
    const crate = placeOf(49, 0);
    expect(spring.long).toBeCloseTo(0.8 - crate[2], 1); // The crate may tilt.
    expect((await drawn(1, 0.05)).opacity).toBeLessThan(1);
    const late = await drawn(1, 0.99);
    expect(late.opacity).toBe(1);
    expect(late.long).toBeCloseTo(1, 3);
    expect(distance((await drawn(2, 0.7)).last, [-1.3, 0, 0])).toBeLessThan(1e-3);
    const force = (step: number) =>
      length((made.steps[step] as unknown as { ties: { force: Vector3 }[] }).ties[0]!.force);
    const steps = made.steps.map((_, step) => step).sort((a, b) => force(a) - force(b));
    const [least, most] = [steps[0]!, steps.at(-1)!];
    expect((await drawn(0, (most + 0.5) / 100)).red).toBeGreaterThan(
      (await drawn(0, (least + 0.5) / 100)).red + 0.2,
    );
    const said = await page.getByRole("region", { name: "Ties", exact: true }).textContent();
    expect(said).toMatch(/^Ties 4/);
    expect(said).toMatch(/world · cratespring: [\d.]+\s[mk]?N[\d.]+\s\w+ long/);
    expect(said).toMatch(/crate · ballpin: [\d.]+\s[mk]?N/);
    await page.context().close();
  });

  test("shows no list of ties where there are none", async () => {
    const free = await folder.simulate("free", {
      ...tied,
      simulation: { ...tied.simulation, ties: [] },
    });
    const page = await browser.newPage();
    await page.goto(free.url);
    await page.waitForFunction(() => "firstcontact" in window);
    expect(await page.getByRole("region", { name: "Ties", exact: true }).count()).toBe(0);
    await page.close();
  });
});
