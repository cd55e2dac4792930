/// Moves the camera from where it is to where something is seen well.

import { PerspectiveCamera, Vector3 } from "three";

export interface Viewpoint {
  readonly position: Vector3;
  readonly target: Vector3;
}

const flightTime = 0.7; // [s]

const smooth = (s: number): number => s * s * (3 - 2 * s);

export class CameraFlight {
  private from: Viewpoint | null = null;
  private to: Viewpoint | null = null;
  private elapsed = 0;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly target: Vector3,
  ) {}

  get flying(): boolean {
    return this.to !== null;
  }

  start(to: Viewpoint, atOnce: boolean): void {
    this.from = { position: this.camera.position.clone(), target: this.target.clone() };
    this.to = to;
    this.elapsed = atOnce ? flightTime : 0;
    this.advance(0);
  }

  stop(): void {
    this.to = null;
  }

  /// Target and direction turn evenly, the distance changes by ratio: no dive through the scene.
  advance(seconds: number): void {
    if (!this.from || !this.to) {
      return;
    }
    this.elapsed += seconds;
    const s = smooth(Math.min(this.elapsed / flightTime, 1));
    const begin = this.from.position.clone().sub(this.from.target);
    const end = this.to.position.clone().sub(this.to.target);
    const range = begin.length() ** (1 - s) * end.length() ** s;
    this.target.lerpVectors(this.from.target, this.to.target, s);
    const direction = begin.normalize().lerp(end.normalize(), s);
    if (direction.lengthSq() < 1e-6) {
      direction.set(0, 0, 1);
    }
    this.camera.position.copy(this.target).addScaledVector(direction.normalize(), range);
    if (this.elapsed >= flightTime) {
      this.to = null;
    }
  }
}
