// Takes the pictures of the gallery: node viewer/tools/gallery.mjs TOOL, in the repository's root.

import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const tool = process.argv[2];
if (tool === undefined) {
  console.error("usage: node viewer/tools/gallery.mjs TOOL");
  process.exit(2);
}

const pictures = [
  { name: "nut", scene: "nut_wrong_pitch", theme: "light", keys: ["Enter"] },
  { name: "bunny", scene: "bunny_plate", theme: "dark", keys: ["Enter"] },
  { name: "shapes", scene: "shapes", theme: "light", keys: ["o"], options: ["--all-pairs"] },
  { name: "phone", scene: "shapes", theme: "dark", keys: ["Enter"], width: 390, height: 780 },
];

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

function makePage({ name, scene, options = [] }) {
  const page = join(folder, `${name}.html`);
  try {
    execFileSync(tool, ["check", `demo/scenes/${scene}.json`, "--html", page, ...options]);
  } catch (error) {
    if (error.status !== 1) {
      throw error; // 1 is the answer "contact".
    }
  }
  return page;
}

for (const picture of pictures) {
  const { name, theme, keys, width = 1280, height = 800 } = picture;
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: theme });
  await page.goto(`file://${makePage(picture)}`);
  await page.waitForTimeout(3000);
  for (const key of keys) {
    await page.keyboard.press(key);
    await page.waitForTimeout(4000); // The flight of the camera, drawn by software.
  }
  await page.screenshot({ path: `docs/images/${name}.jpg`, type: "jpeg", quality: 82 });
  await page.close();
  console.log(`docs/images/${name}.jpg`);
}
await browser.close();
rmSync(folder, { recursive: true });
