/// A still picture of the scene for a page around this one, such as a list of scenes: what the page
/// shows where its address ends in #picture. The picture goes to that page as a message.

import { element } from "./core/dom";
import { Display } from "./display";
import type { Model } from "./model";
import { Player } from "./player";
import { SceneView } from "./view/scene_view";

const gridColor = "#8090a0"; // Neither dark nor light.

/// Whether a picture is asked for.
export const wantsPicture = (hash: string): boolean =>
  new URLSearchParams(hash.replace(/^#/, "")).has("picture");

/// The moment that tells most: the first touch, or the closest approach.
function tellingMoment({ result, run, firstTouch }: Model): number {
  return firstTouch ?? result?.closest?.t ?? (run ? 1 : 0.5);
}

/// What the page around this one gets: an image on a transparent ground.
export interface PictureMessage {
  readonly firstcontactPicture: string;
}

export function sendPicture(model: Model): void {
  const stage = element("main.picture");
  document.body.append(stage);
  const player = new Player(model.duration, model.contactTime, tellingMoment(model));
  const view = new SceneView(model, player, new Display(), stage);
  view.setColors(null, gridColor);
  view.start();
  view.addEdges();
  view.draw();
  const message: PictureMessage = { firstcontactPicture: view.canvas.toDataURL("image/png") };
  window.parent.postMessage(message, "*");
}
