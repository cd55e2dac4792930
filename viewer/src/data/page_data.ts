/// What the tool leaves in the page: the result, and what the page needs to draw it.

import type { Result, Vector3 } from "./result";
import type { CarriedData, RobotData } from "./robot_data";

export interface MeshData {
  /// Vertices are relative to this point of the body frame.
  readonly origin: Vector3;
  readonly positions: Float32Array;
  readonly triangles: Uint16Array | Uint32Array;
}

/// A polyline over time.
export interface GapLine {
  readonly t: readonly number[];
  readonly distance: readonly number[];
}

export interface PageData {
  readonly result: Result;
  readonly meshes: readonly MeshData[];
  /// Of each body: the index of its mesh.
  readonly bodies: readonly number[];
  readonly robots: readonly RobotData[];
  readonly carried: readonly CarriedData[];
  /// What could not be drawn.
  readonly warnings: readonly string[];
  /// Samples of the gap: they prove nothing of the times between them.
  readonly gap: GapLine;
  /// The gap is proven to be nowhere below; may be empty.
  readonly gapBound: GapLine;
}

interface StoredMesh {
  readonly origin: Vector3;
  readonly positions: string;
  readonly triangles: string;
}

interface StoredPage {
  readonly result: Result;
  readonly view: {
    readonly meshes: readonly StoredMesh[];
    readonly bodies: readonly number[];
    readonly robots?: readonly RobotData[];
    readonly carried?: readonly CarriedData[];
    readonly warnings?: readonly string[];
    readonly gap: GapLine;
    readonly gap_bound: GapLine;
  };
}

/// The bytes of a base64 text, as a buffer that typed arrays can share.
export function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) {
    bytes[i] = text.charCodeAt(i);
  }
  return bytes.buffer;
}

const shortIndices = 65_536; // Vertices; of so many or fewer the corners have two bytes.

function meshOf({ origin, positions, triangles }: StoredMesh): MeshData {
  const vertices = new Float32Array(bytesOf(positions));
  const corners = bytesOf(triangles);
  const short = vertices.length / 3 <= shortIndices;
  return {
    origin,
    positions: vertices,
    triangles: short ? new Uint16Array(corners) : new Uint32Array(corners),
  };
}

/// @throws Error where the text is not what the tool leaves
export function readPageData(text: string): PageData {
  const stored = JSON.parse(text) as StoredPage | string;
  if (typeof stored === "string" || !stored.result || !stored.view) {
    throw new Error(
      "This page holds no result. Make one with: firstcontact check SCENE --html PAGE",
    );
  }
  const { view } = stored;
  return {
    result: stored.result,
    meshes: view.meshes.map(meshOf),
    bodies: view.bodies,
    robots: view.robots ?? [],
    carried: view.carried ?? [],
    warnings: view.warnings ?? [],
    gap: view.gap,
    gapBound: view.gap_bound,
  };
}
