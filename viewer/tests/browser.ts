/// Chromium with software rendering, and pages that the tool made.

import { execFile } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, type Browser, type Page } from "playwright-core";
import type { Result, Vector3 } from "../src/data/result";

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
      error && error.code !== 1 && options[0] !== "batch"
        ? reject(new Error(error.message))
        : resolve(),
    );
  });
}

/// A step of a run, as docs/run_format.md has it.
export interface RecordedStep {
  readonly time: number;
  readonly lasted: number;
  readonly bodies: readonly {
    readonly body: number;
    readonly pieces: readonly (readonly number[])[];
    readonly position: Vector3;
  }[];
  readonly contacts: readonly { readonly point: Vector3; readonly impulse: Vector3 }[];
  readonly impacts?: readonly { readonly at: number }[];
  readonly kinetic_energy: number;
  readonly devices?: readonly {
    readonly body: number;
    readonly position: Vector3;
    readonly force: Vector3;
  }[];
}

export interface MadeRun {
  readonly url: string;
  readonly file: string;
  readonly steps: readonly RecordedStep[];
}

export interface MadePage {
  readonly url: string;
  readonly file: string;
  readonly result: Result;
}

/// A path file, as docs/path_format.md has it.
export interface PlannedPath {
  readonly waypoints: readonly (readonly number[])[];
  readonly edges: readonly { readonly clearance: number | null }[];
}

export interface MadePlan {
  readonly url: string;
  /// Null where none was found.
  readonly path: PlannedPath | null;
}

function runAt(file: string, record: string): MadeRun {
  const lines = readFileSync(record, "utf8").trimEnd().split("\n").slice(1);
  return {
    url: `file://${file}`,
    file,
    steps: lines.map((line) => JSON.parse(line) as RecordedStep),
  };
}

export class Folder {
  private readonly path = mkdtempSync(join(tmpdir(), "firstcontact-"));

  write(name: string, text: string): void {
    writeFileSync(join(this.path, name), text);
  }

  /// @returns  its address
  writePage(name: string, body: string): string {
    this.write(name, `<!DOCTYPE html><html><body>${body}</body></html>`);
    return `file://${join(this.path, name)}`;
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

  /// A page of a run.
  async simulate(name: string, scene: object): Promise<MadeRun> {
    const [file, record, input] = [".html", ".jsonl", ".scene.json"].map((end) =>
      join(this.path, name + end),
    ) as [string, string, string];
    writeFileSync(input, JSON.stringify(scene));
    await run(["simulate", input, "--html", file, "-o", record]);
    return runAt(file, record);
  }

  /// A page of tools that follow recordings: the samples of each are seconds, a position and a
  /// rotation.
  async haptics(
    name: string,
    scene: object,
    recordings: readonly (readonly (readonly number[])[])[],
    ...options: string[]
  ): Promise<MadeRun> {
    const [file, record, input] = [".html", ".jsonl", ".scene.json"].map((end) =>
      join(this.path, name + end),
    ) as [string, string, string];
    writeFileSync(input, JSON.stringify(scene));
    const devices = recordings.flatMap((samples, k) => {
      const rows = samples.map(([time, ...pose], n) => [Math.round(1e9 * time!), n + 1, ...pose]);
      const head = "# firstcontact recording: 1\ntime_ns,sequence,x,y,z,qw,qx,qy,qz\n";
      this.write(`${name}${k}.csv`, `${head}${rows.map((row) => row.join(",")).join("\n")}\n`);
      return ["--device", join(this.path, `${name}${k}.csv`)];
    });
    await run(["haptics", input, ...devices, "--html", file, "-o", record, ...options]);
    return runAt(file, record);
  }

  /// A page of a plan.
  async plan(name: string, scene: object): Promise<MadePlan> {
    const [file, answer, input] = [".html", ".json", ".scene.json"].map((end) =>
      join(this.path, name + end),
    ) as [string, string, string];
    writeFileSync(input, JSON.stringify(scene));
    await run(["plan", input, "--html", file, "-o", answer]);
    const path = existsSync(answer)
      ? (JSON.parse(readFileSync(answer, "utf8")) as PlannedPath)
      : null;
    return { url: `file://${file}`, path };
  }

  /// The page that `view` makes of a file of this folder.
  async view(name: string): Promise<string> {
    const page = join(this.path, `${name}.view.html`);
    await run(["view", join(this.path, name), "--no-open", "-o", page]);
    return `file://${page}`;
  }

  /// The page of a batch: one job a line, as objects or as text that is none.
  async batch(name: string, jobs: readonly (object | string)[]): Promise<string> {
    const [page, results, input] = [".html", ".results.jsonl", ".jobs.jsonl"].map((end) =>
      join(this.path, name + end),
    ) as [string, string, string];
    const lines = jobs.map((job) => (typeof job === "string" ? job : JSON.stringify(job)));
    writeFileSync(input, `${lines.join("\n")}\n`);
    await run(["batch", input, "-o", results, "--html", page]);
    return `file://${page}`;
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

/// What the page leaves for whoever asks it.
interface PlaceOfPage {
  clone(): PlaceOfPage;
  add(other: PlaceOfPage): PlaceOfPage;
  toArray(): [number, number, number];
}

declare global {
  interface Window {
    firstcontact: {
      model: { bodies: { name: string }[] };
      player: {
        t: { value: number };
        playing: { value: boolean; subscribe(listener: () => void): void };
        seek(t: number): void;
      };
      display: { hidden: { value: Set<number> } };
      view: {
        bodies: {
          group: { matrix: { elements: number[] } };
          pieces: { group: { children: TouchingOfPage[] } }[];
          geometries: PieceOfPage[];
          looks: PieceOfPage[];
        }[];
        ties: {
          group: {
            position: PlaceOfPage;
            children: {
              children: {
                material: { color: { r: number; g: number }; opacity: number };
                position: PlaceOfPage;
                scale: { z: number };
              }[];
            }[];
          };
        } | null;
        forces: {
          dots: { visible: boolean };
          arrows: {
            visible: boolean;
            count: number;
            geometry: { attributes: { shown: { array: Float32Array } } };
            instanceMatrix: { array: Float32Array };
          };
        } | null;
        path: {
          group: { position: PlaceOfPage };
          line: { parent: { visible: boolean } };
          waypoints: { geometry: GeometryOfPage };
          trees: { visible: boolean; children: { name: string; geometry: GeometryOfPage }[] };
        } | null;
        ghosts: { group: { children: { matrix: { elements: number[] } }[] } };
        edgeAt(x: number, y: number): number | null;
        devices: {
          ghosts: {
            visible: boolean;
            children: {
              visible: boolean;
              children: { matrix: { elements: number[] } }[];
            }[];
          };
          arrows: {
            visible: boolean;
            position: PlaceOfPage;
            children: {
              visible: boolean;
              position: PlaceOfPage;
              scale: { z: number };
              matrixWorld: { elements: number[] };
            }[];
          };
        } | null;
        camera: { position: { x: number; y: number; z: number } };
      };
    };
  }
}
/// The triangles of a contact are in the group of this name.
interface TouchingOfPage {
  name: string;
  children: { material: { opacity: number; visible: boolean } }[];
}
interface PieceOfPage {
  shape: { mesh: MeshOfPage };
  surface: SurfaceOfPage;
  shown: boolean;
}
interface SurfaceOfPage {
  position: { toArray(): number[] };
  material: {
    opacity: number;
    color: { getHexString(): string };
    clippingPlanes: { normal: { toArray(): number[] }; constant: number }[];
  };
  /// As drawn: deformed.
  getVertexPosition(index: number, target: object): { toArray(): number[] };
}
interface GeometryOfPage {
  attributes: { position: { count: number; array: Float32Array } };
}
interface MeshOfPage {
  origin: number[];
  positions: Float32Array;
  triangles: Uint16Array | Uint32Array;
}
