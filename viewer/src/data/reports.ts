/// What an answer is about: its pairs and its files, in the words of result.json.

import type { Names } from "./result";

export type WhyUntested =
  "joined_links" | "srdf" | "allowed_collisions" | "held" | "rule" | "both_rest" | "both_scripted";

export interface UntestedPairs {
  readonly why: WhyUntested;
  readonly count: number;
  readonly first: readonly Names[]; ///< The first few.
}

export interface PairCounts {
  readonly tested: number;
  readonly ignored: number;
  readonly left_out: number;
  readonly untested: readonly UntestedPairs[];
}

export interface FileReport {
  readonly path: string;
  readonly format: string;
  readonly contents: readonly { readonly what: string; readonly count: number }[];
  readonly unit?: string;
  readonly left_out?: readonly {
    readonly name: string;
    readonly reason: string;
    readonly count: number;
  }[];
  readonly warnings?: readonly string[];
  readonly also_read?: readonly string[];
}
