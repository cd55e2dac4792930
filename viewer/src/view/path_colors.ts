/// Colours of paths and trees. Red is kept for contacts.

import { Color } from "three";
import type { TreeKind } from "../data/path_data";

/// From the least clearance to the greatest one.
export const clearanceScale = ["#ff8a1f", "#f2d13a", "#3fbf7f", "#3d8bff"] as const;
const stops = clearanceScale.map((color) => new Color(color));
const noClearance = new Color("#98a3ae");

/// @param share  from 0 to 1; null where no pair is tested
export function clearanceColor(share: number | null): Color {
  if (share === null) {
    return noClearance;
  }
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const below = Math.min(Math.floor(at), stops.length - 2);
  return stops[below]!.clone().lerp(stops[below + 1]!, at - below);
}

export const treeColors: Readonly<Record<TreeKind, string>> = {
  start: "#2fb5a9",
  goals: "#c869d8",
  roadmap: "#2fb5a9",
};
