/// The data that the tool writes into the page: a result or a run, and the meshes to draw it.

import { bytesOf } from "./bytes";
import { pathOf, type PathData, type StoredPath } from "./path_data";
import type { FileReport, PairCounts } from "./reports";
import type { Result, SceneData, Vector3 } from "./result";
import type { CarriedData, RobotData } from "./robot_data";
import { runOf, type RunData, type StoredRun } from "./run_data";

export interface MeshData {
  /// Vertices are relative to this point of the body frame.
  readonly origin: Vector3;
  readonly positions: Float32Array;
  readonly triangles: Uint16Array | Uint32Array;
  /// Whether the triangles enclose a curved body, so that only its sharp edges are to be seen.
  readonly smooth?: boolean;
  /// Whether they enclose a convex body that a radius thickens.
  readonly convex?: boolean;
}

/// A polyline over time.
export interface GapLine {
  readonly t: readonly number[];
  readonly distance: readonly number[];
}

/// The limits that the rates of a coordinate keep. [rad or m; per s, s² or s³]
export interface RateData {
  readonly robot: string;
  readonly coordinate: string;
  readonly velocity: number;
  readonly acceleration: number;
  readonly jerk?: number;
}

export interface PageData {
  /// One of these two.
  readonly result: Result | null;
  readonly run: RunData | null;
  readonly scene: SceneData;
  readonly version: string;
  readonly meshes: readonly MeshData[];
  /// Of each body: the index of its mesh.
  readonly bodies: readonly number[];
  readonly robots: readonly RobotData[];
  readonly carried: readonly CarriedData[];
  /// What could not be drawn, and what reading a run's scene warns of.
  readonly warnings: readonly string[];
  /// What the answer is about; null where that is not known.
  readonly pairCounts: PairCounts | null;
  readonly files: readonly FileReport[];
  /// Samples of the gap, of results: they prove nothing of the times between them.
  readonly gap: GapLine;
  /// The gap is proven to be nowhere below; may be empty.
  readonly gapBound: GapLine;
  /// Null where the page plays no planned path.
  readonly path: PathData | null;
  /// Of a retimed motion.
  readonly rates: readonly RateData[];
}

export interface StoredMesh {
  readonly origin: Vector3;
  readonly positions: string;
  readonly triangles: string;
  readonly smooth?: boolean;
  readonly convex?: boolean;
}

export interface StoredView {
  readonly meshes: readonly StoredMesh[];
  readonly bodies: readonly number[];
  readonly robots?: readonly RobotData[];
  readonly carried?: readonly CarriedData[];
  readonly warnings?: readonly string[];
  /// Of runs: a result has these itself.
  readonly pair_counts?: PairCounts;
  readonly files?: readonly FileReport[];
  readonly gap?: GapLine;
  readonly gap_bound?: GapLine;
  readonly path?: StoredPath;
  readonly rates?: readonly RateData[];
}

export interface StoredPage {
  readonly result?: Result;
  readonly run?: StoredRun;
  readonly view: StoredView;
}

const shortIndices = 65_536; // Vertices; of so many or fewer the corners have two bytes.

export function meshOf({ origin, positions, triangles, smooth, convex }: StoredMesh): MeshData {
  const vertices = new Float32Array(bytesOf(positions));
  const corners = bytesOf(triangles);
  const short = vertices.length / 3 <= shortIndices;
  return {
    origin,
    positions: vertices,
    triangles: short ? new Uint16Array(corners) : new Uint32Array(corners),
    smooth: smooth ?? false,
    convex: convex ?? false,
  };
}

const noLine: GapLine = { t: [], distance: [] };

/// @throws Error where the text is not what the tool leaves
export function readPageData(text: string): PageData {
  const stored = JSON.parse(text) as StoredPage | string;
  if (typeof stored === "string" || !stored.view) {
    throw new Error(
      "This page holds no result. Make one with: firstcontact check SCENE --html PAGE",
    );
  }
  return pageOf(stored, stored.view.meshes.map(meshOf));
}

/// @param meshes  of the view
export function pageOf({ result, run, view }: StoredPage, meshes: readonly MeshData[]): PageData {
  const source = result ?? run!.header;
  return {
    result: result ?? null,
    run: run ? runOf(run) : null,
    scene: source.scene,
    version: source.version,
    meshes,
    bodies: view.bodies,
    robots: view.robots ?? [],
    carried: view.carried ?? [],
    warnings: view.warnings ?? [],
    pairCounts: result?.pair_counts ?? view.pair_counts ?? null,
    files: result?.files ?? view.files ?? [],
    gap: view.gap ?? noLine,
    gapBound: view.gap_bound ?? noLine,
    path: view.path ? pathOf(view.path) : null,
    rates: view.rates ?? [],
  };
}
