/// The live page in a browser: the mouse moves a tool, which stops where it touches.

import { spawn, type ChildProcess } from "node:child_process";
import { fileURLToPath } from "node:url";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, test } from "vitest";
import { Handle, lead, poseIn, type Picture, type ToolPicture } from "../src/live";
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

  test("is ahead of the tool by the distance of their centres", () => {
    const tool: ToolPicture = {
      target: [0, 0, -3, 0, 1, 0, 0], // Turned by half a turn about x.
      force: [0, 0, 0],
      torque: [0, 0, 0],
      links: [],
    };
    const picture: Picture = { tools: [tool], bodies: [[1, 0, 0, 1, 1, 0, 0, 0]], contacts: [] };
    expect(poseIn(picture, 0)).toBeNull();
    expect(lead(tool, poseIn(picture, 1)!, [0, 0, 0])).toBe(4);
    expect(lead(tool, poseIn(picture, 1)!, [0, 0, 0.5])).toBe(5);
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
  async function open(asked: object = scene, ...options: string[]): Promise<void> {
    const devices = options.length > 0 ? options : ["--device", "mouse"];
    session = spawn(tool!, ["haptics", "-", ...devices]);
    session.stdin!.end(JSON.stringify(asked));
    const address = await new Promise<string>((resolve, reject) => {
      session.stdout!.once("data", (text: Buffer) => resolve(String(text).split(" ")[0]!));
      session.stderr!.once("data", (text: Buffer) => reject(new Error(String(text))));
    });
    page = await browser.newPage({ viewport: { width: 900, height: 600 } });
    await page.goto(address);
    await page.getByText("Force").first().waitFor();
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
    // The ghost of the jaw is where the grip leads it, inside of the cube.
    await page.waitForFunction(
      "firstcontact.markers.ghosts.children[0].children[1].matrix.elements[12] < 0.01",
    );
    await page.getByLabel("Grip").fill("0");
    await page.waitForFunction("firstcontact.view.bodies[2].group.matrix.elements[12] > 0.0399");
  });

  test("shows two tools that other devices move", { timeout: 60_000 }, async () => {
    const two = {
      ...scene,
      bodies: [
        ...scene.bodies,
        { ...scene.bodies[1]!, name: "block", pose: { position: [0.07, 0, 0.05] } },
      ],
      haptics: { tools: [{ body: "peg" }, { body: "block" }] },
    };
    const hand = ["--device", "simulated"];
    await open(two, ...hand, ...hand, "--live", "--duration", "30", "--speed", "0.5");
    const ghost = (tool: number): Promise<number[]> =>
      page.evaluate(
        `[...firstcontact.markers.ghosts.children[${tool}].children[0].matrix.elements.slice(12, 15)]`,
      );
    const before = [await ghost(0), await ghost(1)] as [number[], number[]];
    const moved = (tool: number): Promise<unknown> =>
      page.waitForFunction(
        `Math.hypot(...[...firstcontact.markers.ghosts.children[${tool}].children[0].matrix.elements.slice(12, 15)]
          .map((x, k) => x - ${JSON.stringify(before[tool])}[k])) > 0.005`,
      );
    await Promise.all([moved(0), moved(1)]);
    // A hand that goes anywhere pushes the tools on the plate, or on each other.
    await page.waitForFunction(
      "firstcontact.markers.group.children.some(({ type, visible }) => type === 'Mesh' && visible)",
    );
    const said = await page.locator(".panel").innerText();
    expect(said).toMatch(/Force on peg[\s\S]*Force on block/);
    expect(said).not.toContain("Drag the tool");
    expect(said).toContain("The tools pass through nothing.");
  });
});
