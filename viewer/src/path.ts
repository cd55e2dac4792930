/// A planned path, made ready to be shown.

import type { PathData } from "./data/path_data";

export class Path {
  /// [m] Of all edges; null where no pair is tested.
  readonly least: number | null;
  readonly greatest: number | null;

  constructor(readonly data: PathData) {
    const known = data.edges.flatMap(({ clearance }) => (clearance === null ? [] : [clearance]));
    this.least = known.length > 0 ? Math.min(...known) : null;
    this.greatest = known.length > 0 ? Math.max(...known) : null;
  }

  /// Whether the search found no path.
  get failed(): boolean {
    return this.data.verdict === "none";
  }

  get hasTrees(): boolean {
    return this.data.trees.some(({ edges }) => edges > 0);
  }

  /// The number of the edge that is played at a moment, the later one between two; -1 without edges.
  edgeAt(t: number): number {
    const after = this.data.edges.findIndex((edge) => t < edge.t[1]);
    return after >= 0 ? after : this.data.edges.length - 1;
  }

  /// The clearance of an edge between the least one and the greatest one, from 0 to 1.
  ///
  /// It is on a logarithmic scale, as few micrometres matter as much as few centimetres elsewhere.
  share(edge: number): number | null {
    const clearance = this.data.edges[edge]?.clearance ?? null;
    if (clearance === null || this.least === null || this.greatest === null) {
      return null;
    }
    if (this.greatest === this.least) {
      return 1;
    }
    const measure = this.least > 0 ? Math.log : (x: number): number => x;
    const from = measure(this.least);
    return (measure(clearance) - from) / (measure(this.greatest) - from);
  }
}
