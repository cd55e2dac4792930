/// Faint copies of the moving bodies: where they start and end, and between as an onion skin.

import { Group } from "three";
import type { GoalPose } from "../data/path_data";
import { poseOf } from "../motion/motion";
import type { BodyView } from "./body_view";
import { dispose } from "./geometry_view";

const skins = 12;
const mostTriangles = 3_000_000; // Of all skins together.
const skinOpacity = 0.07;
const endOpacity = 0.16;
const goalOpacity = 0.3;

export class Ghosts {
  readonly group = new Group();

  /// @param goal  poses of bodies that are always shown
  constructor(
    private readonly views: readonly BodyView[],
    private readonly goal: readonly GoalPose[],
  ) {}

  show(options: { ends: boolean; onion: boolean; hidden: ReadonlySet<number> }): void {
    dispose(this.group);
    const shown = this.views.filter(({ body }) => !body.atRest && !options.hidden.has(body.index));
    const count = skinCount(shown);
    for (const view of shown) {
      if (options.onion) {
        for (let k = 1; k <= count; ++k) {
          this.group.add(view.ghost(k / (count + 1), skinOpacity));
        }
      }
      if (options.ends) {
        this.group.add(view.ghost(0, endOpacity), view.ghost(1, endOpacity));
      }
    }
    const visible = this.goal.filter(({ body }) => !options.hidden.has(body));
    for (const pose of visible) {
      this.group.add(this.views[pose.body]!.ghost(0, goalOpacity, poseOf(pose)));
    }
  }
}

/// Fewer where the bodies are heavy.
function skinCount(views: readonly BodyView[]): number {
  const triangles = views
    .flatMap(({ shownPieces }) => shownPieces)
    .reduce((sum, { shape }) => sum + shape.mesh.triangles.length / 3, 0);
  return Math.max(1, Math.min(skins, Math.floor(mostTriangles / Math.max(triangles, 1))));
}
