/// A result made ready to be shown.

import type { BodyData, Contact, PairAnswer, Result } from "./data/result";
import type { GapLine, MeshData, PageData } from "./data/page_data";
import { isAtRest, motionOf, type Motion, type Pose } from "./motion/motion";

export interface Body {
  readonly index: number;
  readonly name: string;
  readonly data: BodyData;
  readonly mesh: MeshData;
  readonly motion: Motion;
  readonly atRest: boolean;
}

export class Model {
  readonly result: Result;
  readonly bodies: readonly Body[];
  readonly gap: GapLine;
  readonly gapBound: GapLine;
  /// Those of every pair where the result has them, each at its own pair's time.
  readonly pairs: readonly PairAnswer[];

  private readonly indices: ReadonlyMap<string, number>;

  constructor(page: PageData) {
    this.result = page.result;
    this.gap = page.gap;
    this.gapBound = page.gapBound;
    const { bodies, options } = page.result.scene;
    this.bodies = bodies.map((data, index) => ({
      index,
      name: data.name,
      data,
      mesh: page.meshes[page.bodies[index]!]!,
      motion: motionOf(data, options.duration),
      atRest: isAtRest(data),
    }));
    this.indices = new Map(bodies.map(({ name }, index) => [name, index]));
    this.pairs = page.result.pairs ?? [];
  }

  get duration(): number {
    return this.result.scene.options.duration;
  }

  /// t of the first contact; none where nothing touches, or nobody knows.
  get contactTime(): number | null {
    const { verdict, t } = this.result;
    return verdict === "contact" || verdict === "contact_at_start" ? t : null;
  }

  get contacts(): readonly Contact[] {
    return this.result.contacts;
  }

  get triangleCount(): number {
    return this.bodies.reduce((sum, { mesh }) => sum + mesh.triangles.length / 3, 0);
  }

  body(name: string): Body {
    return this.bodies[this.indices.get(name)!]!;
  }

  pose(body: Body, t: number): Pose {
    return body.motion(t);
  }
}
