/// A page on which the mouse is the haptic device: the messages to and from the tool.

import type { QuaternionWxyz, Vector3 } from "./data/result";
import type { Pose } from "./motion/motion";
import { add, compose, distance, length, turn, unit, unitQuaternion } from "./motion/vector";

/// A picture of the session, 60 times a second.
export interface Picture {
  readonly handle: readonly number[]; ///< Of the device: x, y, z [m], w, x, y, z.
  readonly grip?: number; ///< Of the device: 0 open, 1 closed.
  readonly target: readonly number[]; ///< To which it leads the tool.
  readonly force: Vector3; ///< [N] On the hand.
  readonly torque: Vector3; ///< [N m]
  readonly bodies: readonly (readonly number[])[]; ///< Number of the body, then its pose.
  readonly contacts: readonly Vector3[];
}

/// The tool that follows the mouse: a body, its links, and the number of grips that move the links.
export interface LiveTool {
  readonly tool: number;
  readonly links?: readonly number[];
  readonly grips?: number;
}

/// The tool of a page that is live; else null.
export function liveTool(): LiveTool | null {
  const text = document.getElementById("firstcontact-live")?.textContent;
  return text ? (JSON.parse(text) as LiveTool) : null;
}

export const poseFrom = ([x, y, z, w, i, j, k]: readonly number[]): Pose => ({
  position: [x!, y!, z!],
  rotation: [w!, i!, j!, k!],
});

/// The handle in the user's hand: drags move it and turn it.
export class Handle {
  position: Vector3 = [0, 0, 0];
  rotation: QuaternionWxyz = [1, 0, 0, 0];
  grip = 0; ///< 0 open, 1 closed.

  move(by: Vector3): void {
    this.position = add(this.position, by);
  }

  /// Turns about an axis of the world, by the length of the vector [rad].
  turnBy(vector: Vector3): void {
    this.rotation = unitQuaternion(compose(turn(unit(vector), length(vector)), this.rotation));
  }

  set(pose: Pose): void {
    this.position = pose.position;
    this.rotation = pose.rotation;
  }
}

/// The connection to `firstcontact haptics`. The session knows where the handle is: a page that is
/// opened again goes on from there.
export class Connection {
  readonly handle = new Handle();
  private readonly socket: WebSocket;
  private begun = false;

  constructor(onPicture: (picture: Picture) => void, onEnd: () => void) {
    this.socket = new WebSocket(`ws://${location.host}/live`);
    this.socket.addEventListener("message", ({ data }) => {
      const picture = JSON.parse(data as string) as Picture;
      if (!this.begun) {
        this.begun = true;
        this.handle.set(poseFrom(picture.handle));
        this.handle.grip = picture.grip ?? 0;
        this.send();
      }
      onPicture(picture);
    });
    this.socket.addEventListener("close", onEnd);
  }

  send(): void {
    if (this.begun && this.socket.readyState === WebSocket.OPEN) {
      const { position, rotation, grip } = this.handle;
      this.socket.send(JSON.stringify({ position, rotation, grip }));
    }
  }
}

/// [m] The distance between the hand and the tool, which contacts hold back.
export function lead({ bodies, target }: Picture, tool: number): number {
  const body = bodies.find(([number]) => number === tool);
  return body ? distance(poseFrom(target).position, poseFrom(body.slice(1)).position) : 0;
}
