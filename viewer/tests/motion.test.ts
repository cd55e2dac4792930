/// The viewer's motions against poses that the library also reproduces (tests/scene).

import { readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import type { SceneData, QuaternionWxyz, Vector3 } from "../src/data/result";
import { motionOf, place, unplace } from "../src/motion/motion";
import { distance, length, rotate } from "../src/motion/vector";

interface StoredPose {
  readonly body: string;
  readonly t: number;
  readonly position: Vector3;
  readonly quaternion_wxyz: QuaternionWxyz;
}

const stored = JSON.parse(readFileSync(new URL("data/poses.json", import.meta.url), "utf8")) as {
  scene: SceneData;
  poses: StoredPose[];
};

describe.each(stored.scene.bodies)("the motion of $name", (body) => {
  const motion = motionOf(body, stored.scene.options.duration);
  const poses = stored.poses.filter((pose) => pose.body === body.name);

  test("is that of the library", () => {
    expect(poses.length).toBeGreaterThan(4);
    for (const pose of poses) {
      const { position, rotation } = motion(pose.t);
      expect(distance(position, pose.position)).toBeLessThanOrEqual(2e-14 * length(position));
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

  test("takes points to the world and back", () => {
    const point: Vector3 = [0.3, -2, 5];
    for (const t of [0, 0.3, 1]) {
      const pose = motion(t);
      expect(distance(unplace(pose, place(pose, point)), point)).toBeLessThan(1e-12);
    }
  });
});
