/// The plane that bodies are cut with: across the view, or across an axis of the world.

import { Box3, PerspectiveCamera, Plane, Vector3 } from "three";
import type { Cut } from "../display";

/// @param box  from one of its sides to the other an axis is cut
function planeOf(
  { along, share }: Cut,
  camera: PerspectiveCamera,
  target: Vector3,
  box: Box3,
): Plane {
  const towards = target.clone().sub(camera.position);
  if (along === "view") {
    // From the camera to twice as far as what is looked at, which is half way.
    const at = camera.position.clone().addScaledVector(towards, 2 * share);
    return new Plane().setFromNormalAndCoplanarPoint(towards.normalize(), at);
  }
  const normal = new Vector3();
  normal[along] = 1;
  const room = 0.01 * box.getSize(new Vector3()).length(); // Neither end cuts anything off.
  const [from, to] = [box.min[along] - room, box.max[along] + room];
  return new Plane(normal, -(from + share * (to - from)));
}

export class CutPlane {
  /// For materials; none where nothing is cut.
  readonly planes: Plane[] = [];

  /// Once for each picture, as a plane across the view goes with it.
  update(cut: Cut | null, camera: PerspectiveCamera, target: Vector3, box: Box3): void {
    this.planes.length = 0;
    if (cut) {
      const plane = planeOf(cut, camera, target, box);
      this.planes.push(cut.otherSide ? plane.negate() : plane);
    }
  }

  keeps(point: Vector3): boolean {
    return this.planes.every((plane) => plane.distanceToPoint(point) >= 0);
  }
}
