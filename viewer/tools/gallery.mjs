// Takes the pictures of the gallery: node viewer/tools/gallery.mjs TOOL, in the repository's root.
// Simulations are run for it, which takes about ten minutes; PICTURE... names those that are wanted.

import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [tool, ...wanted] = process.argv.slice(2);
if (tool === undefined) {
  console.error("usage: node viewer/tools/gallery.mjs TOOL [PICTURE...]");
  process.exit(2);
}

const scene = (name, ...options) => [`demo/scenes/${name}.json`, ...options];
const panda = "data/robots/moveit_resources_panda_description";
const shelf = [
  ["--robot", `${panda}/urdf/panda.urdf`],
  ["--srdf", `${panda}/srdf/panda.srdf`],
  ["--trajectory", "demo/trajectories/panda_into_a_shelf.csv"],
  ["--environment", "data/planning_mbm/bookshelf_small_panda/scene0056.yaml"],
].flat();

const all = [
  { name: "nut", question: scene("nut_wrong_pitch"), theme: "light", keys: ["Enter"] },
  { name: "bunny", question: scene("bunny_plate"), theme: "dark", keys: ["Enter"] },
  { name: "shapes", question: scene("shapes", "--all-pairs"), theme: "light", keys: ["o"] },
  { name: "phone", question: scene("shapes"), theme: "dark", keys: ["Enter"], size: [390, 780] },
  { name: "puma", question: scene("puma_post"), theme: "light", keys: ["g", "Enter", "f"] },
  {
    name: "panda",
    question: [...shelf, "--closest"],
    theme: "dark",
    keys: ["v"],
    pair: "Can3 · panda_leftfinger",
  },
  { name: "joints", question: shelf, theme: "light", keys: ["v"], t: 0.9, joint: "panda_joint4" },
];
const simulation = (name, ...options) => ({
  simulation: [`demo/simulations/${name}.json`, ...options],
  size: [1120, 700],
});
all.push(
  { name: "nut_on_bolt", ...simulation("nut_on_bolt"), theme: "light", keys: ["2"], t: 0.9 },
  { name: "rings", ...simulation("rings_over_a_bar"), theme: "light", keys: ["1"], t: 0.55 },
  { name: "wrecking_ball", ...simulation("wrecking_ball"), theme: "dark", nearer: 3, t: 0.55 },
  { name: "hand", ...simulation("hand_and_bunny"), theme: "dark", nearer: 1, t: 0.6 },
  { name: "shot_plate", ...simulation("shot_plate"), theme: "light", keys: ["1"], t: 0.02 },
);
// Scenes that demo/simulations/make_laws.py writes.
const law = (name) => ({ law: name, size: [1120, 700] });
all.push(
  { name: "cart", ...law("cart"), theme: "light", keys: ["f"], nearer: 2, t: 0.5 },
  { name: "spinning_top", ...law("spinning_top"), theme: "dark", nearer: 2, t: 0.5 },
  { name: "turntable", ...law("turntable"), theme: "light", nearer: 3, t: 0.66 },
  { name: "arch", ...law("arch"), theme: "dark", nearer: 1, t: 0.5 },
);
all.push({
  name: "peg_felt",
  session: ["demo/haptics/peg_and_hole.json", "--device", "demo/haptics/peg_hand.csv"],
  size: [1120, 700],
  theme: "light",
  keys: ["2", "x"],
  joint: "contacts",
  t: 0.62,
});
// Paths, with the search behind them.
const plan = (...options) => ({ plan: options, size: [1120, 700] });
const bookshelf = "data/planning_mbm/bookshelf_small_panda";
all.push(
  {
    name: "nut_off_bolt",
    ...plan("demo/plans/nut_off_bolt.json"),
    theme: "light",
    keys: ["2"],
    t: 0.5,
  },
  { name: "bug_trap", ...plan("examples/scenes/bug_trap.json"), theme: "dark", keys: ["x", "b"] },
  {
    name: "panda_plan",
    ...plan(
      ...["--robot", `${panda}/urdf/panda.urdf`, "--srdf", `${panda}/srdf/panda.srdf`],
      ...["--environment", `${bookshelf}/scene0022.yaml`],
      ...["--request", `${bookshelf}/request0022.yaml`],
    ),
    theme: "light",
    keys: ["b"],
    nearer: 1,
    t: 0.6,
  },
  { name: "two_pandas", ...plan("demo/plans/two_pandas.json"), theme: "light", t: 0.5 },
  {
    name: "cart_and_door",
    ...plan("demo/plans/cart_and_door.json"),
    theme: "dark",
    keys: ["b"],
    t: 0.4,
  },
  {
    name: "conveyor",
    ...plan("demo/plans/conveyor.json"),
    theme: "light",
    nearer: 3,
    t: 0.725,
  },
  { name: "revolving_door", ...plan("demo/plans/revolving_door.json"), theme: "dark", t: 0.45 },
  {
    name: "arm_around_arm",
    ...plan("demo/plans/arm_around_arm.json"),
    theme: "light",
    nearer: 2,
    t: 0.383,
  },
);
const pictures = all.filter(({ name }) => wanted.length === 0 || wanted.includes(name));

const folder = mkdtempSync(join(tmpdir(), "firstcontact-"));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
  ],
});

function makePage({ name, question, simulation, session, law, plan }) {
  const page = join(folder, `${name}.html`);
  if (plan !== undefined) {
    execFileSync(tool, ["plan", ...plan, "-o", join(folder, `${name}.json`), "--html", page]);
    return page;
  }
  if (law !== undefined) {
    execFileSync("python3", ["demo/simulations/make_laws.py", folder]);
    return makePage({ name, simulation: [join(folder, `${law}.json`)] });
  }
  const moved = session ?? simulation;
  if (moved !== undefined) {
    const run = join(folder, `${name}.jsonl`);
    const command = session === undefined ? "simulate" : "haptics";
    execFileSync(tool, [command, ...moved, "-o", run, "--html", page]);
    execFileSync(tool, ["verify", run], { stdio: "inherit" });
    return page;
  }
  try {
    execFileSync(tool, ["check", ...question, "--html", page]);
  } catch (error) {
    if (error.status !== 1) {
      throw error; // 1 is the answer "contact".
    }
  }
  return page;
}

for (const picture of pictures) {
  const { name, theme, keys = [], size: [width, height] = [1280, 800], t = 0 } = picture;
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: theme });
  await page.goto(`file://${makePage(picture)}#t=${t}`);
  await page.waitForTimeout(3000);
  for (const key of keys) {
    await page.keyboard.press(key);
    await page.waitForTimeout(4000); // The flight of the camera, drawn by software.
  }
  for (const button of [picture.pair, picture.joint].filter(Boolean)) {
    await page.getByRole("button", { name: button }).first().click();
    await page.waitForTimeout(4000);
  }
  await page.mouse.move((width - 325) / 2, height * 0.35); // The middle of what is drawn in 3D.
  for (let turns = 0; turns < (picture.nearer ?? 0); ++turns) {
    await page.mouse.wheel(0, -400);
    await page.waitForTimeout(1500);
  }
  await page.screenshot({ path: `docs/images/${name}.jpg`, type: "jpeg", quality: 82 });
  await page.close();
  console.log(`docs/images/${name}.jpg`);
}
await browser.close();
rmSync(folder, { recursive: true });
