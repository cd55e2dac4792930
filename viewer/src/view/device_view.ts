/// The devices of a haptic run: a ghost of each tool where its device leads it, and the force on
/// the device as an arrow at the tool.

import { Box3, Group, type Material, Mesh, type Object3D, Quaternion, Vector3 } from "three";
import type { Device } from "../devices";
import type { Model } from "../model";
import { length } from "../motion/vector";
import type { Run } from "../run";
import type { BodyView } from "./body_view";
import type { Bounds } from "./bounds";
import { overlay } from "./contact_view";
import { arrowGeometry, greatestLength, typical, typicalLength } from "./force_view";
import { dispose, setPose } from "./geometry_view";

const ghostOpacity = 0.2;
const mostGrowth = 2.5; // Of what is looked at first.
const mostSamples = 500; // Of a device's way, for the camera.

export class DeviceMarkers {
  readonly ghosts = new Group(); ///< Of each device a group: of its tool, and of its links.
  readonly arrows = new Group();
  private readonly perNewton: number; // [m]
  private step = -1;

  /// @param views   of all bodies
  /// @param middle  of what is seen: relative to it, single precision is enough
  /// @param size    [m] radius of a body, to which arrows compare
  constructor(
    private readonly run: Run,
    private readonly devices: readonly Device[],
    private readonly views: readonly BodyView[],
    private readonly middle: Vector3,
    private readonly size: number,
  ) {
    this.perNewton = (typicalLength * size) / typical(devices.flatMap(({ forces }) => forces));
    this.arrows.position.copy(middle);
    for (let k = 0; k < devices.length; ++k) {
      const arrow = new Mesh(arrowGeometry(), overlay(0.9));
      arrow.renderOrder = 11;
      arrow.frustumCulled = false;
      arrow.raycast = () => {};
      this.arrows.add(arrow);
    }
    this.makeGhosts();
  }

  /// Makes the ghosts anew, as their bodies look now.
  makeGhosts(): void {
    dispose(this.ghosts);
    for (const { body, links } of this.devices) {
      this.ghosts.add(ghostOfHand([body, ...links].map((each) => this.views[each]!)));
    }
    this.step = -1;
  }

  show(t: number): void {
    const step = this.run.stepAt(t);
    this.devices.forEach((device, k) => {
      const moment = device.at(step);
      const ghost = this.ghosts.children[k]!;
      ghost.visible = moment !== null && this.views[device.body]!.group.visible;
      if (moment && step !== this.step) {
        [moment.pose, ...moment.links].forEach((pose, n) => setPose(ghost.children[n]!, pose));
      }
      const strength = moment ? length(moment.force) : 0;
      const arrow = this.arrows.children[k]!;
      arrow.visible = strength > 0;
      if (strength > 0) {
        arrow.position.set(...device.centreAt(t)).sub(this.middle);
        arrow.quaternion.copy(
          new Quaternion().setFromUnitVectors(
            new Vector3(0, 0, 1),
            new Vector3(...moment!.force).divideScalar(strength),
          ),
        );
        arrow.scale.setScalar(Math.min(this.perNewton * strength, greatestLength * this.size));
      }
    });
    this.step = step;
  }
}

/// Copies of a tool and of its links, which show where the device leads them.
export function ghostOfHand(views: readonly BodyView[]): Group {
  const hand = new Group();
  for (const view of views) {
    const ghost = view.ghost(0, ghostOpacity);
    ghost.traverse(seeThrough);
    hand.add(ghost);
  }
  return hand;
}

/// A device may lead its tool into a body, which would hide the ghost.
function seeThrough(part: Object3D): void {
  if ("material" in part) {
    part.renderOrder = 9; // Below arrows and contacts.
    (part.material as Material).depthTest = false;
  }
}

/// Makes what is looked at so large that devices are seen, unless all else would become small.
///
/// @param sweep  of the bodies, what is looked at first
/// @param whole  of the whole motion
export function showDevices(model: Model, bounds: Bounds, sweep: Box3, whole: Box3): void {
  const { run, devices, bodies } = model;
  if (run && devices.length > 0) {
    const box = boxOfDevices(run, devices, (body) => bounds.bodiesAt([bodies[body]!], 0).radius);
    whole.union(box);
    const all = sweep.clone().union(box);
    if (diagonal(all) < mostGrowth * diagonal(sweep)) {
      sweep.copy(all);
    }
  }
}

const diagonal = ({ min, max }: Box3): number => min.distanceTo(max);

/// A box around the centres of tools where devices lead them, wider by the radius of each tool.
function boxOfDevices(
  run: Run,
  devices: readonly Device[],
  radius: (body: number) => number,
): Box3 {
  const box = new Box3();
  const stride = Math.max(1, Math.floor(run.steps.length / mostSamples));
  for (const device of devices) {
    const around = new Vector3().setScalar(radius(device.body));
    for (let step = 0; step < run.steps.length; step += stride) {
      const moment = device.at(step);
      if (moment) {
        const centre = new Vector3(...device.targetOf(moment));
        box.expandByPoint(centre.clone().sub(around)).expandByPoint(centre.add(around));
      }
    }
  }
  return box;
}
