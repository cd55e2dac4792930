/// Where bodies touch: the points, their normals, and the triangles that meet.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import type { Contact } from "../data/result";
import type { Body, Model, BodyGeometry } from "../model";
import { contactColor } from "./colors";
import { cornersAt } from "./triangle";

/// A corner, or a long line of contact, has many feature pairs: only the first shows its normal.
const arrowLength = 0.09; // of the distance from the camera
const dotSize = 15; // [px]
const fillOpacity = 0.7;
const outlineOpacity = 0.6;
const many = 12; // Contacts; from here on their dots are small.

export function roundDot(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d")!;
  context.beginPath();
  context.arc(32, 32, 22, 0, 2 * Math.PI);
  context.fillStyle = "#fff";
  context.fill();
  context.lineWidth = 8;
  context.strokeStyle = contactColor;
  context.stroke();
  return new CanvasTexture(canvas);
}

export function overlay(opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({
    color: contactColor,
    transparent: true,
    opacity,
    depthTest: false,
    depthWrite: false,
    side: DoubleSide,
  });
}

/// Along z, from 0 to 1.
function arrow(material: MeshBasicMaterial): Group {
  const shaft = new Mesh(new CylinderGeometry(0.02, 0.02, 0.75).translate(0, 0.375, 0), material);
  const head = new Mesh(new ConeGeometry(0.07, 0.25, 16).translate(0, 0.875, 0), material);
  const group = new Group();
  shaft.rotation.x = head.rotation.x = 0.5 * Math.PI;
  group.add(shaft, head);
  group.traverse((part) => (part.renderOrder = 11));
  return group;
}

/// All triangles of a body's part that touch something.
function touchingTriangles(
  body: Body,
  shape: BodyGeometry,
  contacts: readonly Contact[],
): number[] {
  const touching = contacts.flatMap(({ bodies, triangles, geometries }) =>
    [0, 1]
      .filter(
        (side) => bodies[side] === body.name && body.geometries[geometries?.[side] ?? 0] === shape,
      )
      .map((side) => triangles[side]!),
  );
  return [...new Set(touching)];
}

/// In the frame of the mesh, so that the triangles move, and deform, with the geometry.
export function touchingSurface(
  body: Body,
  shape: BodyGeometry,
  contacts: readonly Contact[],
): Group {
  const group = new Group();
  const touching = touchingTriangles(body, shape, contacts);
  const cornersOfAll = (t: number): Float32Array =>
    new Float32Array(touching.flatMap((triangle) => [...cornersAt(shape, triangle, t)]));
  const positions = cornersOfAll(0);
  if (positions.length > 0) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    if (shape.to) {
      geometry.morphAttributes.position = [new BufferAttribute(cornersOfAll(1), 3)];
    }
    const fill = overlay(fillOpacity);
    fill.depthTest = true; // A body before it hides it, the outline shows all the same.
    const outline = overlay(outlineOpacity);
    outline.wireframe = true;
    [fill, outline].forEach((material) => {
      const mesh = new Mesh(geometry, material);
      mesh.renderOrder = 10;
      mesh.raycast = () => {};
      group.add(mesh);
    });
  }
  group.position.set(...shape.mesh.origin);
  return group;
}

/// @param nearness  1 at the moment of contact, 0 far from it
export function fadeSurface(surface: Object3D, nearness: number): void {
  surface.traverse((part) => {
    if (part instanceof Mesh) {
      const material = part.material as MeshBasicMaterial;
      material.opacity = nearness * (material.wireframe ? outlineOpacity : fillOpacity);
      material.visible = nearness > 0;
    }
  });
}

/// Directions from which the normal is seen from the side, those near the camera's first.
export function sideViews({ normal }: Contact, toCamera: Vector3): Vector3[] {
  if (!normal) {
    return [toCamera];
  }
  const along = new Vector3(...normal);
  const flat = toCamera.clone().addScaledVector(along, -toCamera.dot(along));
  if (flat.lengthSq() < 1e-6) {
    flat.set(along.z, along.x, along.y).cross(along);
  }
  flat.normalize();
  const tilt = 0.25 * Math.sign(toCamera.dot(along) || 1);
  return [0, 1, -1, 2, -2, 3, -3, 4].map((eighth) =>
    flat
      .clone()
      .applyAxisAngle(along, (eighth * Math.PI) / 4)
      .addScaledVector(along, tilt)
      .normalize(),
  );
}

export const middleOf = ({ points: [a, b] }: Contact): Vector3 =>
  new Vector3(...a).add(new Vector3(...b)).multiplyScalar(0.5);

/// The points and normals of contacts, in the world.
export class ContactMarkers {
  readonly group = new Group();
  private readonly points = new PointsMaterial({
    map: roundDot(),
    size: dotSize,
    sizeAttenuation: false,
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
  private readonly arrowMaterial = overlay(1);
  private arrow: Group | null = null;

  /// The first contact is the one that is looked at.
  show(contacts: readonly Contact[]): void {
    this.group.clear();
    this.arrow = null;
    if (contacts.length === 0) {
      return;
    }
    // Relative to the first, as they may be far from the origin.
    const center = middleOf(contacts[0]!);
    this.group.position.copy(center);
    const local = contacts.map((contact) => middleOf(contact).sub(center));
    const dots = new Points(new BufferGeometry().setFromPoints(local), this.points);
    dots.renderOrder = 12;
    this.points.size = contacts.length < many ? dotSize : 0.6 * dotSize;
    this.group.add(dots);
    const { normal } = contacts[0]!;
    if (normal) {
      this.arrow = arrow(this.arrowMaterial);
      this.arrow.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...normal));
      this.group.add(this.arrow);
    }
  }

  /// @param nearness  1 at the moment of contact, 0 far from it
  fade(nearness: number): void {
    this.points.opacity = nearness;
    this.arrowMaterial.opacity = nearness;
    this.points.visible = this.arrowMaterial.visible = nearness > 0;
  }

  /// The arrow is as long on the screen from near and far.
  adapt(camera: PerspectiveCamera): void {
    this.arrow?.scale.setScalar(arrowLength * camera.position.distanceTo(this.group.position));
  }
}

/// How much of a contact's surroundings is worth seeing, from the sizes of its triangles.
export function contactSize(model: Model, contact: Contact): number {
  const sizes = ([0, 1] as const).map((side) => {
    const p = cornersAt(
      model.geometryOf(contact, side),
      contact.triangles[side],
      model.provenUntil,
    );
    const corner = (k: number): Vector3 => new Vector3().fromArray(p, 3 * k);
    return Math.max(
      corner(0).distanceTo(corner(1)),
      corner(1).distanceTo(corner(2)),
      corner(2).distanceTo(corner(0)),
    );
  });
  return Math.min(...sizes.filter((size) => size > 0), Infinity);
}
