/// Faint copies of the moving bodies: where they start and end, and between as an onion skin.

import {
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
} from "three";
import type { BodyView } from "./body_view";
import { setPose } from "./body_view";

const skins = 12;
const mostTriangles = 3_000_000; // Of all skins together.

export class Ghosts {
  readonly group = new Group();

  constructor(private readonly views: readonly BodyView[]) {}

  show(options: { ends: boolean; onion: boolean; hidden: ReadonlySet<number> }): void {
    this.group.clear();
    const shown = this.views.filter(({ body }) => !body.atRest && !options.hidden.has(body.index));
    for (const view of shown) {
      if (options.onion) {
        this.times(view).forEach((t) => this.add(view, t, 0.07));
      }
      if (options.ends) {
        [0, 1].forEach((t) => this.add(view, t, 0.16));
      }
    }
  }

  /// Fewer where the bodies are heavy.
  private times(view: BodyView): number[] {
    const triangles = view.body.mesh.triangles.length / 3;
    const count = Math.max(1, Math.min(skins, Math.floor(mostTriangles / triangles)));
    return Array.from({ length: count }, (_, k) => (k + 1) / (count + 1));
  }

  private add(view: BodyView, t: number, opacity: number): void {
    const surface = new Mesh<BufferGeometry, MeshBasicMaterial>(
      view.surface.geometry,
      new MeshBasicMaterial({
        color: view.color,
        transparent: true,
        opacity,
        depthWrite: false,
        side: DoubleSide,
      }),
    );
    surface.raycast = () => {};
    if (surface.morphTargetInfluences) {
      surface.morphTargetInfluences[0] = t;
    }
    const parts: (Mesh | LineSegments)[] = [surface];
    if (view.edgeGeometry) {
      const color = new Color(view.color);
      const lines = new LineSegments(
        view.edgeGeometry,
        new LineBasicMaterial({
          color,
          transparent: true,
          opacity: 2 * opacity,
          depthWrite: false,
        }),
      );
      lines.raycast = () => {};
      parts.push(lines);
    }
    const ghost = new Group();
    parts.forEach((part) => part.position.copy(view.surface.position));
    ghost.add(...parts);
    setPose(ghost, view.body.motion(t));
    this.group.add(ghost);
  }
}
