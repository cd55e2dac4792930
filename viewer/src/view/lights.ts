/// The lamps of the scene.

import { AmbientLight, DirectionalLight, HemisphereLight, type Camera, type Scene } from "three";

/// Adds a lamp above, one at the camera's shoulder, and light from everywhere.
export function addLights(scene: Scene, camera: Camera): void {
  const key = new DirectionalLight(0xffffff, 1.5);
  key.position.set(-0.5, 0.9, 1);
  const fill = new DirectionalLight(0xcfe0ff, 0.5);
  fill.position.set(1, -0.2, 0.3);
  camera.add(key, key.target, fill, fill.target);
  key.target.position.set(0, 0, -1);
  fill.target.position.set(0, 0, -1);
  const sky = new HemisphereLight(0xffffff, 0x667788, 0.9);
  sky.position.copy(camera.up);
  scene.add(sky, new AmbientLight(0xffffff, 0.25));
}
