/// A planned path and the search for it, as the tool leaves them in the page.

import { bytesOf } from "./bytes";
import type { PoseData, Vector3 } from "./result";

/// The lines along which a point of a mover runs, one for each edge.
export interface StoredLines {
  readonly name: string;
  readonly origin: Vector3;
  readonly points: string;
  readonly until: string;
}

export interface TracedLines {
  /// Of the body or link that the point belongs to.
  readonly name: string;
  /// Points are relative to it.
  readonly origin: Vector3;
  readonly points: Float32Array;
  /// Of each edge: how many points there are with those of the edges before.
  readonly until: Uint32Array;
}

export interface PathEdge {
  /// [m] Proven; null where no pair is tested.
  readonly clearance: number | null;
  /// Where the edge begins and ends in t.
  readonly t: readonly [number, number];
}

export type TreeKind = "start" | "goals" | "roadmap";

interface Tree<Lines> {
  readonly kind: TreeKind;
  readonly places: number;
  /// Of the whole tree: the lines may be fewer.
  readonly edges: number;
  readonly movers: readonly Lines[];
}
export type SearchTree = Tree<TracedLines>;

export interface BlockedPair {
  readonly pair: readonly [string, string];
  readonly count: number;
}

/// A body or link where it is at the goal.
export type GoalPose = PoseData & { readonly body: number };

interface PathOf<Lines> {
  readonly verdict: "none" | "approximate" | "proven";
  readonly edges: readonly PathEdge[];
  readonly movers: readonly Lines[];
  readonly trees: readonly Tree<Lines>[];
  readonly blocked: readonly BlockedPair[];
  /// Only of a search without a path.
  readonly goal: readonly GoalPose[];
}
export type StoredPath = PathOf<StoredLines>;
export type PathData = PathOf<TracedLines>;

const linesOf = ({ name, origin, points, until }: StoredLines): TracedLines => ({
  name,
  origin,
  points: new Float32Array(bytesOf(points)),
  until: new Uint32Array(bytesOf(until)),
});

export const pathOf = (stored: StoredPath): PathData => ({
  ...stored,
  movers: stored.movers.map(linesOf),
  trees: stored.trees.map((tree) => ({ ...tree, movers: tree.movers.map(linesOf) })),
});

/// The number of edges of a tree that are drawn.
export const drawnEdges = ({ movers }: SearchTree): number => movers[0]?.until.length ?? 0;
