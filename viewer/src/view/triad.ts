/// The axes of the world in a corner; a click on one looks along it.

import { Quaternion, Vector3 } from "three";
import { element } from "../core/dom";
import type { SceneView } from "./scene_view";

const axes = [
  { name: "x", direction: new Vector3(1, 0, 0) },
  { name: "y", direction: new Vector3(0, 1, 0) },
  { name: "z", direction: new Vector3(0, 0, 1) },
] as const;

const size = 76; // [px]
const arm = 26;

export function triad(view: SceneView): HTMLElement {
  const lines = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  lines.setAttribute("viewBox", `${-size / 2} ${-size / 2} ${size} ${size}`);
  lines.setAttribute("aria-hidden", "true");
  const { up } = view.camera;
  const upright = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), up);
  // Straight up has no right and left.
  const nearlyUp = new Vector3(0, -1e-3, 1).normalize().applyQuaternion(upright);
  const parts = axes.map(({ name, direction }) => {
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.setAttribute("class", `axis-${name}`);
    lines.append(line);
    const button = element(
      `button.axis.axis-${name}`,
      { type: "button", "aria-label": `Look along ${name}`, title: `Look along ${name}` },
      name,
    );
    button.addEventListener("click", () =>
      view.lookAlong(direction.dot(up) > 0.999 ? nearlyUp : direction),
    );
    return { line, button, direction };
  });
  const turned = new Quaternion();
  const at = new Vector3();
  view.onFrame = () => {
    turned.copy(view.camera.quaternion).invert();
    for (const { line, button, direction } of parts) {
      at.copy(direction).applyQuaternion(turned).multiplyScalar(arm);
      line.setAttribute("x2", String(at.x));
      line.setAttribute("y2", String(-at.y));
      button.style.transform = `translate(${at.x}px, ${-at.y}px)`;
      button.style.zIndex = at.z > 0 ? "2" : "1";
      button.style.opacity = at.z > -0.3 * arm ? "1" : "0.55";
    }
  };
  return element(
    "div.triad",
    { role: "group", "aria-label": "Axes" },
    lines,
    ...parts.map(({ button }) => button),
  );
}
