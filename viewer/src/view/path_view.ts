/// A planned path as a line that is coloured by clearance, and the trees of the search.

import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Points,
  PointsMaterial,
  type Raycaster,
  Vector3,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { TracedLines } from "../data/path_data";
import type { Path } from "../path";
import { clearanceColor, treeColors } from "./path_colors";

const lineWidth = 4; // [px]
const clickWidth = 12; // [px] A click so near hits the line.
const dotSize = 7; // [px]
const dotColor = "#f4f6f8";
const hiddenOpacity = 0.4; // Of the line behind bodies.
const treeOpacity = 0.6;

/// A straight piece of a line, and the edge that it is of.
interface Segments {
  readonly ends: Float32Array; ///< Six numbers each.
  readonly edges: readonly number[];
}

/// @param middle  of what is seen: relative to it, single precision is enough
function segmentsOf(movers: readonly TracedLines[], middle: Vector3): Segments {
  const ends: number[] = [];
  const edges: number[] = [];
  for (const { origin, points, until } of movers) {
    const offset = new Vector3(...origin).sub(middle).toArray();
    const push = (point: number): void =>
      offset.forEach((x, axis) => void ends.push(x + points[3 * point + axis]!));
    until.forEach((end, edge) => {
      for (let k = edge > 0 ? until[edge - 1]! : 0; k + 1 < end; ++k) {
        push(k);
        push(k + 1);
        edges.push(edge);
      }
    });
  }
  return { ends: new Float32Array(ends), edges };
}

/// The ends of all edges.
function waypointsOf(movers: readonly TracedLines[], middle: Vector3): Float32Array {
  const places: number[] = [];
  for (const { origin, points, until } of movers) {
    const offset = new Vector3(...origin).sub(middle).toArray();
    const last = (until.at(-1) ?? 0) - 1;
    const first = [...until].map((_, edge) => (edge > 0 ? until[edge - 1]! : 0));
    for (const point of last >= 0 ? [...first, last] : []) {
      offset.forEach((x, axis) => void places.push(x + points[3 * point + axis]!));
    }
  }
  return new Float32Array(places);
}

function dots(places: Float32Array): Points {
  const material = new PointsMaterial({ color: dotColor, size: dotSize, sizeAttenuation: false });
  material.depthTest = false;
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <color_fragment>",
      `#include <color_fragment>
  float off = length(gl_PointCoord - 0.5);
  if (off > 0.5) discard;
  if (off > 0.3) diffuseColor.rgb = vec3(0.12);`,
    );
  };
  return new Points(
    new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3)),
    material,
  );
}

export class PathView {
  readonly group = new Group();
  readonly line: LineSegments2;
  readonly waypoints: Points;
  readonly trees = new Group();
  private readonly course = new Group();
  private readonly edges: readonly number[];

  constructor(
    private readonly path: Path,
    private readonly middle: Vector3,
  ) {
    const { ends, edges } = segmentsOf(path.data.movers, middle);
    this.edges = edges;
    const geometry = new LineSegmentsGeometry();
    if (edges.length > 0) {
      const colors = edges.flatMap((edge) => {
        const color = clearanceColor(path.share(edge)).toArray();
        return [...color, ...color];
      });
      geometry.setPositions(ends).setColors(colors);
    }
    // Both count as transparent, so that the line is drawn over its own part behind bodies.
    const look = { linewidth: lineWidth, vertexColors: true, transparent: true };
    this.line = new LineSegments2(geometry, new LineMaterial(look));
    const behind = new LineSegments2(
      geometry,
      new LineMaterial({ ...look, opacity: hiddenOpacity, depthTest: false, depthWrite: false }),
    );
    behind.raycast = () => {};
    this.waypoints = dots(waypointsOf(path.data.movers, middle));
    this.waypoints.raycast = () => {};
    [behind, this.line, this.waypoints].forEach((part, k) => {
      part.frustumCulled = false;
      part.renderOrder = 8 + k;
      part.visible = edges.length > 0;
    });
    this.course.add(behind, this.line, this.waypoints);
    this.group.position.copy(middle);
    this.group.add(this.course, this.trees);
  }

  showPath(shown: boolean): void {
    this.course.visible = shown;
  }

  /// The lines of trees are made when they are shown for the first time.
  showTrees(shown: boolean): void {
    if (shown && this.trees.children.length === 0) {
      for (const { kind, movers } of this.path.data.trees) {
        this.trees.add(this.tree(kind, movers));
      }
    }
    this.trees.visible = shown;
  }

  /// The number of the edge that a ray passes; null where it passes none.
  edgeOn(ray: Raycaster): number | null {
    if (!this.course.visible || this.edges.length === 0) {
      return null;
    }
    ray.params.Line2 = { threshold: clickWidth - lineWidth };
    const hit = ray.intersectObject(this.line, false)[0];
    return hit ? (this.edges[hit.faceIndex ?? -1] ?? null) : null;
  }

  private tree(kind: keyof typeof treeColors, movers: readonly TracedLines[]): LineSegments {
    const { ends } = segmentsOf(movers, this.middle);
    const lines = new LineSegments(
      new BufferGeometry().setAttribute("position", new BufferAttribute(ends, 3)),
      new LineBasicMaterial({
        color: treeColors[kind],
        transparent: true,
        opacity: treeOpacity,
        depthWrite: false,
      }),
    );
    lines.name = kind;
    lines.frustumCulled = false;
    lines.raycast = () => {};
    lines.renderOrder = 7;
    return lines;
  }
}
