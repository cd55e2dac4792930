/// The live page in a browser: the mouse moves a tool, which stops where it touches.

import { spawn, type ChildProcess } from "node:child_process";
import { fileURLToPath } from "node:url";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, test } from "vitest";
import { Handle, lead, type Picture } from "../src/live";
import { distance, rotate } from "../src/motion/vector";
import { canLook, launch, tool } from "./browser";

const quarter = 0.5 * Math.PI;

describe("a handle", () => {
  test("adds moves, and turns about axes of the world", () => {
    const handle = new Handle();
    handle.move([1, 2, 3]);
    handle.move([0, 0, 1]);
    expect(handle.position).toEqual([1, 2, 4]);
    handle.turnBy([0, 0, quarter]);
    handle.turnBy([quarter, 0, 0]);
    expect(distance(rotate(handle.rotation, [1, 0, 0]), [0, 0, 1])).toBeLessThan(1e-12);
    handle.turnBy([0, 0, 0]);
    expect(Math.hypot(...handle.rotation)).toBeCloseTo(1, 12);
  });

  test("is ahead of the tool by the distance of their places", () => {
    const picture: Picture = {
      handle: [0, 0, 0, 1, 0, 0, 0],
      target: [0, 0, -3, 1, 0, 0, 0],
      force: [0, 0, 0],
      torque: [0, 0, 0],
      bodies: [[1, 0, 0, 1, 1, 0, 0, 0]],
      contacts: [],
    };
    expect(lead(picture, 1)).toBe(4);
    expect(lead(picture, 0)).toBe(0);
  });
});

const scene = {
  firstcontact: 1,
  bodies: [
    { name: "plate", shape: { box: { size: [0.2, 0.2, 0.01] } } },
    {
      name: "peg",
      shape: { box: { size: [0.05, 0.05, 0.05] } },
      pose: { position: [0, 0, 0.05] },
    },
  ],
  haptics: { tools: [{ body: "peg" }] },
};

const gripper = {
  firstcontact: 1,
  bodies: [{ name: "cube", shape: { box: { size: [0.04, 0.04, 0.04] } } }],
  robots: [
    {
      name: "gripper",
      urdf: fileURLToPath(new URL("../../benchmarks/haptics/scenes/jaws.urdf", import.meta.url)),
      base: { position: [0, 0, 0.04] },
    },
  ],
  haptics: { tools: [{ robot: "gripper", grips: [{ joints: { slide: [0, 0.035] } }] }] },
};

describe.skipIf(!canLook)("a live page", () => {
  let browser: Browser;
  let session: ChildProcess;
  let page: Page;

  beforeAll(async () => {
    browser = await launch();
  });
  afterAll(async () => browser?.close());
  afterEach(() => session?.kill("SIGKILL"));

  /// A session whose scene comes by standard input; its page is open.
  async function open(asked: object = scene): Promise<void> {
    session = spawn(tool!, ["haptics", "-", "--device", "mouse"]);
    session.stdin!.end(JSON.stringify(asked));
    const address = await new Promise<string>((resolve, reject) => {
      session.stdout!.once("data", (text: Buffer) => resolve(String(text).split(" ")[0]!));
      session.stderr!.once("data", (text: Buffer) => reject(new Error(String(text))));
    });
    page = await browser.newPage({ viewport: { width: 900, height: 600 } });
    await page.goto(address);
    await page.getByText("Force").waitFor();
  }

  const height = (): Promise<number> =>
    page.evaluate("firstcontact.view.bodies[1].group.matrix.elements[14]");
  const middle = (): Promise<[number, number]> =>
    page.evaluate(`(() => {
      const { view } = firstcontact;
      const { x, y } = view.camera.position.clone().setFromMatrixPosition(view.bodies[1].group.matrix).project(view.camera);
      const box = view.canvas.getBoundingClientRect();
      return [box.left + ((1 + x) / 2) * box.width, box.top + ((1 - y) / 2) * box.height];
    })()`);

  test("drags a tool down until it touches, and no farther", { timeout: 60_000 }, async () => {
    await open();
    const [x, y] = await middle();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y + 200, { steps: 20 });
    await page.waitForFunction("firstcontact.view.bodies[1].group.matrix.elements[14] < 0.032");
    expect(await height()).toBeGreaterThan(0.03);
    await page.waitForFunction(
      "/Force\\s+[\\d.]*[1-9]/.test(document.querySelector('.panel').innerText)",
    );
    await page.mouse.up();
    await page.mouse.move(x, y);
    expect(await height()).toBeLessThan(0.032);
    expect(await page.getByLabel("Grip").count()).toBe(0);
  });

  test("closes jaws until they touch, and no farther", { timeout: 60_000 }, async () => {
    await open(gripper);
    const right = (): Promise<number> =>
      page.evaluate("firstcontact.view.bodies[2].group.matrix.elements[12]");
    expect(await right()).toBeCloseTo(0.04, 3);
    await page.getByLabel("Grip").fill("0.9");
    await page.waitForFunction("firstcontact.view.bodies[2].group.matrix.elements[12] < 0.0251");
    expect(await right()).toBeGreaterThan(0.025); // Half of the cube and of the jaw.
    await page.getByLabel("Grip").fill("0");
    await page.waitForFunction("firstcontact.view.bodies[2].group.matrix.elements[12] > 0.0399");
  });
});
