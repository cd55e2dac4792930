/// Things that are seen near their time, and not otherwise.

import type { Material } from "three";

/// From 0, far from its time, to 1.
///
/// @param window  how far
export const nearness = (t: number, time: number, window: number): number =>
  window > 0 ? Math.max(0, 1 - Math.abs(t - time) / window) : Number(t === time);

/// Has each copy, or each point, a share of the material's opacity: the attribute `shown`.
export function fadeEach<M extends Material>(material: M): M {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader =
      `attribute float shown;\nvarying float vShown;\n${shader.vertexShader}`.replace(
        "#include <begin_vertex>",
        "#include <begin_vertex>\n  vShown = shown;",
      );
    shader.fragmentShader = `varying float vShown;\n${shader.fragmentShader}`.replace(
      "#include <color_fragment>",
      "#include <color_fragment>\n  diffuseColor.a *= vShown;",
    );
  };
  return material;
}
