/// The ground: a grid that fades with the distance, so that height and size can be seen.

import { Box3, Color, DoubleSide, Mesh, PlaneGeometry, ShaderMaterial, Vector3 } from "three";
import { corners } from "./bounds";

const vertexShader = /* glsl */ `
  varying vec2 place;
  void main() {
    place = position.xy;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const fragmentShader = /* glsl */ `
  uniform vec3 color;
  uniform float cell;
  uniform float reach;
  varying vec2 place;

  float lines(float size) {
    vec2 at = place / size;
    vec2 width = fwidth(at);
    vec2 near = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-6));
    float line = 1.0 - min(min(near.x, near.y), 1.0);
    return line * (1.0 - smoothstep(0.2, 0.7, max(width.x, width.y)));
  }

  void main() {
    float fade = 1.0 - smoothstep(0.25, 1.0, length(place) / reach);
    float line = max(0.4 * lines(cell), lines(5.0 * cell));
    gl_FragColor = vec4(color, 0.34 * line * fade);
    #include <colorspace_fragment>
  }`;

/// 1, 2 or 5 times a power of ten, at most the size.
export function roundNumber(size: number): number {
  const power = 10 ** Math.floor(Math.log10(size));
  const factor = [5, 2, 1].find((f) => f * power <= size) ?? 1;
  return factor * power;
}

export class Grid {
  readonly object: Mesh<PlaneGeometry, ShaderMaterial>;
  readonly cell: number;

  /// @param up  unit
  constructor(sweep: Box3, up: Vector3) {
    const center = sweep.getCenter(new Vector3());
    const size = Math.max(sweep.getSize(new Vector3()).length(), 1e-9);
    this.cell = roundNumber(size / 12);
    const reach = 2.2 * size;
    this.object = new Mesh(
      new PlaneGeometry(2 * reach, 2 * reach),
      new ShaderMaterial({
        uniforms: {
          color: { value: new Color("#888") },
          cell: { value: this.cell },
          reach: { value: reach },
        },
        vertexShader,
        fragmentShader,
        transparent: true,
        depthWrite: false,
        side: DoubleSide,
      }),
    );
    // Lines stand at multiples of five cells in the world, wherever the scene is.
    const snap = (x: number): number => Math.round(x / (5 * this.cell)) * 5 * this.cell;
    this.object.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), up);
    const fromWorld = this.object.quaternion.clone().invert();
    const { x, y } = center.applyQuaternion(fromWorld);
    const lowest = Math.min(...corners(sweep.min, sweep.max).map((corner) => corner.dot(up)));
    this.object.position
      .set(snap(x), snap(y), lowest - 0.002 * size)
      .applyQuaternion(this.object.quaternion);
    this.object.renderOrder = -1;
  }

  set color(color: string) {
    (this.object.material.uniforms.color!.value as Color).set(color);
  }
}
