/// A page of a live session: the messages to it, and those of the mouse where it moves a tool.

import type { QuaternionWxyz, Vector3 } from "./data/result";
import { place, type Pose } from "./motion/motion";
import { add, compose, distance, length, turn, unit, unitQuaternion } from "./motion/vector";

/// A tool and its device.
export interface ToolPicture {
  readonly target: readonly number[]; ///< Where the device leads it: x, y, z [m], w, x, y, z.
  readonly force: Vector3; ///< [N] On the hand.
  readonly torque: Vector3; ///< [N m]
  /// Links where the device leads them: number of the body, then its pose.
  readonly links: readonly (readonly number[])[];
}

/// A picture of the session, 60 times a second.
export interface Picture {
  readonly tools: readonly ToolPicture[];
  readonly handle?: readonly number[]; ///< Of the mouse: x, y, z [m], w, x, y, z.
  readonly grip?: number; ///< Of the mouse: 0 open, 1 closed.
  readonly bodies: readonly (readonly number[])[]; ///< Number of the body, then its pose.
  readonly contacts: readonly Vector3[];
}

/// A tool: its body, and the bodies that hang on it.
export interface LiveTool {
  readonly body: number;
  readonly links: readonly number[];
}

export interface LiveSession {
  readonly tools: readonly LiveTool[];
  /// The number of the tool that follows the mouse; left out where none does.
  readonly mouse?: number;
  /// The number of grips of that tool.
  readonly grips?: number;
}

/// The session of a page that is live; else null.
export function liveSession(): LiveSession | null {
  const text = document.getElementById("firstcontact-live")?.textContent;
  return text ? (JSON.parse(text) as LiveSession) : null;
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
      if (!this.begun && picture.handle) {
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

/// The pose of a body in a picture; null where it has none.
export function poseIn({ bodies }: Picture, body: number): Pose | null {
  const found = bodies.find(([number]) => number === body);
  return found ? poseFrom(found.slice(1)) : null;
}

/// [m] The distance between the hand and the tool, which contacts hold back.
///
/// @param centre  of the tool, in its frame: it follows the handle
export function lead({ target }: ToolPicture, pose: Pose, centre: Vector3): number {
  return distance(place(poseFrom(target), centre), place(pose, centre));
}
