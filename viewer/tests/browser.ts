/// Chromium with software rendering, and pages that the tool made.

import { execFile } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, type Browser, type Page } from "playwright-core";
import type { Result } from "../src/data/result";

export const tool = process.env.FIRSTCONTACT_TOOL;
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

/// Without these there is nothing to look at.
export const canLook = tool !== undefined && existsSync(browserPath);

const root = new URL("../..", import.meta.url).pathname;

export const launch = (): Promise<Browser> =>
  chromium.launch({
    executablePath: browserPath,
    args: [
      "--no-sandbox",
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
    ],
  });

/// Free and contact are both answers.
function run(options: readonly string[]): Promise<void> {
  return new Promise((resolve, reject) => {
    execFile(tool!, options, (error) =>
      error && error.code !== 1 ? reject(new Error(error.message)) : resolve(),
    );
  });
}

export interface MadePage {
  readonly url: string;
  readonly file: string;
  readonly result: Result;
}

export class Folder {
  private readonly path = mkdtempSync(join(tmpdir(), "firstcontact-"));

  write(name: string, text: string): void {
    writeFileSync(join(this.path, name), text);
  }

  /// A page of a scene of the repository, or of one given as an object.
  async make(name: string, scene: string | object, ...options: string[]): Promise<MadePage> {
    const file = join(this.path, `${name}.html`);
    const answer = join(this.path, `${name}.json`);
    let input = join(this.path, `${name}.scene.json`);
    if (typeof scene === "string") {
      input = join(root, scene);
    } else {
      writeFileSync(input, JSON.stringify(scene));
    }
    await run(["check", input, "--html", file, "-o", answer, ...options]);
    const result = JSON.parse(readFileSync(answer, "utf8")) as Result;
    return { url: `file://${file}`, file, result };
  }

  remove(): void {
    rmSync(this.path, { recursive: true });
  }
}

/// How many different colours a picture has, and how much of it has the most frequent one.
export async function colorsOf(
  page: Page,
  png: Buffer,
): Promise<{ count: number; largest: number }> {
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d")!;
    context.drawImage(bitmap, 0, 0);
    const words = new Uint32Array(
      context.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer,
    );
    const counts = new Map<number, number>();
    words.forEach((word) => counts.set(word, (counts.get(word) ?? 0) + 1));
    return { count: counts.size, largest: Math.max(...counts.values()) / words.length };
  }, png.toString("base64"));
}
