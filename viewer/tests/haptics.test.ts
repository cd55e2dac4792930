/// The page of a haptic run in a browser: devices as ghosts of their tools, and what hands feel.

import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { distance } from "../src/motion/vector";
import { canLook, Folder, launch, type MadeRun } from "./browser";

const cube = (name: string, x: number) => ({
  name,
  shape: { box: { size: [0.04, 0.04, 0.04] } },
  pose: { position: [x, 0, 0.03] },
});
const plate = { name: "plate", shape: { box: { size: [0.3, 0.2, 0.01] } } };
const still = [1, 0, 0, 0];

/// A hand that goes down, drags along x under the surface, and lifts.
const drag = (depth: number): number[][] =>
  Array.from({ length: 1001 }, (_, k) => {
    const s = k / 1000;
    const down = Math.min(1, 4 * s, 4 - 4 * s);
    return [s, 0.03 * Math.min(Math.max(2 * s - 0.5, 0), 1), 0, -depth * down, ...still];
  });

describe.skipIf(!canLook)("the page of a haptic run", () => {
  let browser: Browser;
  let one: MadeRun;
  let two: MadeRun;
  const folder = new Folder();
  const complaints: string[] = [];

  beforeAll(async () => {
    const scene = {
      firstcontact: 1,
      id: "drag",
      bodies: [plate, cube("cube", 0)],
      haptics: { tools: [{ body: "cube" }], friction: 0.3 },
    };
    one = await folder.haptics("one", scene, [drag(0.012)]);
    two = await folder.haptics(
      "two",
      {
        ...scene,
        bodies: [plate, cube("left", -0.08), cube("right", 0.02)],
        haptics: { tools: [{ body: "right" }, { body: "left" }] },
      },
      [drag(0.012), drag(0)],
    );
    browser = await launch();
  });

  afterAll(async () => {
    await browser?.close();
    folder.remove();
  });

  const open = async (made: MadeRun): Promise<Page> => {
    const viewport = { width: 1100, height: 720 };
    const context = await browser.newContext({ reducedMotion: "reduce", viewport });
    const page = await context.newPage();
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(String(error)));
    await page.goto(made.url);
    await page.waitForFunction(() => "firstcontact" in window);
    return page;
  };

  /// A ghost and an arrow in the middle of a step.
  const drawn = (page: Page, made: MadeRun, step: number, device = 0) =>
    page.evaluate(
      ([t, index]) => {
        window.firstcontact.player.seek(t!);
        const { ghosts, arrows } = window.firstcontact.view.devices!;
        const arrow = arrows.children[index!]!;
        return {
          ghost: ghosts.children[index!]!.children[0]!.matrix.elements.slice(12, 15) as [
            number,
            number,
            number,
          ],
          arrow: arrow.visible ? arrow.scale.z : 0,
          at: arrow.position.clone().add(arrows.position).toArray(),
        };
      },
      [(made.steps[step]!.time - 0.0005) / made.steps.at(-1)!.time, device],
    );

  test("shows where the device leads the tool, and the force at the tool", async () => {
    const page = await open(one);
    for (const step of [100, 500, 900]) {
      const { position, force } = one.steps[step]!.devices![0]!;
      const { ghost, arrow, at } = await drawn(page, one, step);
      expect(distance(ghost, position)).toBeLessThan(1e-9);
      expect(arrow > 0).toBe(Math.hypot(...force) > 0);
      if (arrow > 0) {
        // The recorded position is that of the end of the step; the centre is the origin.
        expect(distance(at, one.steps[step]!.bodies[0]!.position)).toBeLessThan(1e-4);
        expect(ghost[2]).toBeLessThan(at[2] - 0.005); // The plate holds the cube back.
      }
    }
    expect((await drawn(page, one, 10)).arrow).toBe(0); // Nothing touches yet.
    expect((await drawn(page, one, 500)).arrow).toBeGreaterThan(0.01);
    await page.context().close();
  });

  test("hides ghosts and arrows by keys", async () => {
    const page = await open(one);
    const seen = () =>
      page.evaluate(() => {
        const { ghosts, arrows } = window.firstcontact.view.devices!;
        return [ghosts.visible, arrows.visible];
      });
    expect(await seen()).toEqual([true, true]);
    await page.keyboard.press("d");
    expect(await seen()).toEqual([false, true]);
    await page.getByRole("button", { name: "Forces on devices" }).click();
    expect(await seen()).toEqual([false, false]);
    await page.context().close();
  });

  test("draws force, torque and distance over time", async () => {
    const page = await open(one);
    await drawn(page, one, 500);
    const said = (await page.getByRole("region", { name: "Over time" }).textContent())!;
    const force = Math.hypot(...one.steps[500]!.devices![0]!.force);
    expect(said).toContain(`force on the device${Number(force.toPrecision(4))}\u00a0N`);
    expect(said).toMatch(/torque on the device[\d.]+\s[mµ]?N m/);
    expect(said).toMatch(/from the device to the tool[\d.]+\smm/);
    expect(await page.locator(".chart").first().textContent()).toMatch(/force on the device/);
    const step = (await page.getByRole("region", { name: "Step", exact: true }).textContent())!;
    expect(step).toMatch(/Force[\d.]+\sNTorque[\d.]+\s[mµ]?N mDevice to tool[\d.]+\smm/);
    await page.context().close();
  });

  test("tells two tools apart", async () => {
    const page = await open(two);
    // The first tool is the second body: devices are in the order of bodies.
    expect((await drawn(page, two, 500, 0)).arrow).toBe(0);
    expect((await drawn(page, two, 500, 1)).arrow).toBeGreaterThan(0);
    const said = (await page.getByRole("region", { name: "Over time" }).textContent())!;
    expect(said).toMatch(/force on the device: left0\sN/);
    expect(said).toMatch(/force on the device: right[\d.]+\sN/);
    await page.context().close();
  });

  test("complained about nothing", () => {
    expect(complaints).toEqual([]);
  });
});
