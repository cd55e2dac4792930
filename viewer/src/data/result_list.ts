/// Many results in one page: the data that a batch writes.

import {
  meshOf,
  pageOf,
  type MeshData,
  type PageData,
  type StoredMesh,
  type StoredPage,
  type StoredView,
} from "./page_data";
import type { PairCounts } from "./reports";
import type { Names, Result, Verdict } from "./result";

/// A result or an error, as far as a list shows it.
export interface Summary {
  readonly id?: string;
  readonly line?: number; ///< Of the jobs, from 1.
  readonly error?: string;
  readonly verdict?: Verdict;
  readonly reason?: string | null;
  readonly pair?: Names | null;
  readonly time?: number;
  readonly pair_counts?: PairCounts;
  readonly warnings?: readonly string[];
}

interface StoredEntry {
  /// Each entry has one of these two; an entry with the second one cannot be played.
  readonly result?: Result & Summary;
  readonly summary?: Summary;
  readonly view?: Omit<StoredView, "meshes"> & { readonly meshes: readonly number[] };
}

/// As the tool leaves it. Meshes are those of all results.
export interface StoredList {
  readonly list: readonly StoredEntry[];
  readonly meshes: readonly StoredMesh[];
}

export class ResultList {
  readonly summaries: readonly Summary[];
  private readonly meshes = new Map<number, MeshData>();

  constructor(private readonly stored: StoredList) {
    this.summaries = stored.list.map(({ result, summary }) => result ?? summary ?? {});
  }

  canPlay(index: number): boolean {
    return this.stored.list[index]?.view !== undefined;
  }

  /// Returns null for an entry that cannot be played.
  pageOf(index: number): PageData | null {
    const { result, view } = this.stored.list[index] ?? {};
    if (!result || !view) {
      return null;
    }
    const page: StoredPage = { result, view: { ...view, meshes: [] } };
    return pageOf(
      page,
      view.meshes.map((mesh) => this.mesh(mesh)),
    );
  }

  private mesh(index: number): MeshData {
    const mesh = this.meshes.get(index) ?? meshOf(this.stored.meshes[index]!);
    this.meshes.set(index, mesh);
    return mesh;
  }
}

/// Null where the text is of one result, of a run or of nothing.
export function readResultList(text: string): ResultList | null {
  const isList = text.trimStart().startsWith('{"list":');
  return isList ? new ResultList(JSON.parse(text) as StoredList) : null;
}
