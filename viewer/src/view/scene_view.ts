/// The scene on the screen. Draws when something changed, and not otherwise.

import {
  Box3,
  BufferGeometry,
  type Intersection,
  MOUSE,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Sphere,
  Vector2,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { MeshData } from "../data/page_data";
import type { Contact, Vector3 as Triple } from "../data/result";
import type { Signal } from "../core/signal";
import type { Display } from "../display";
import type { Body, Model, BodyGeometry } from "../model";
import { unplace } from "../motion/motion";
import type { Player } from "../player";
import { BodyView } from "./body_view";
import { Bounds, corners } from "./bounds";
import { CameraFlight, type Viewpoint } from "./camera_flight";
import { bodyColor } from "./colors";
import {
  contactSize,
  ContactMarkers,
  fadeSurface,
  middleOf,
  sideViews,
  touchingSurface,
} from "./contact_view";
import { CutPlane } from "./cut_plane";
import { nearness } from "./fading";
import { DeviceMarkers, showDevices } from "./device_view";
import { DrawnShapes } from "./drawn_shape";
import { edgeGeometry } from "./feature_edges";
import { ForceMarkers } from "./force_view";
import { Ghosts } from "./ghosts";
import { Grid } from "./grid";
import { rangeFor, rangeTo } from "./framing";
import { homeDirection } from "./home_view";
import { PathView } from "./path_view";
import { fieldOfView, type GeometryView, type Surface } from "./geometry_view";
import { addLights } from "./lights";
import { Probe, probePoint } from "./probe";
import { TieMarkers } from "./tie_view";

const slowFrame = 60; // [ms] Beyond this the picture gets coarser while it moves.
const nearContact = 0.04; // In t: contacts of a result are seen within it.
const blink = 0.2; // [s] Of the person who looks: no less long are contacts seen.

function setVisible(shown: boolean, ...parts: readonly (Object3D | undefined)[]): void {
  parts.forEach((part) => part && (part.visible = shown));
}

export class SceneView {
  readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.01, 100);
  readonly probe = new Probe();
  readonly bodies: readonly BodyView[];
  readonly bounds: Bounds;
  /// Of a run.
  readonly forces: ForceMarkers | null;
  readonly ties: TieMarkers | null;
  readonly path: PathView | null;
  readonly devices: DeviceMarkers | null;
  /// [ms] between the last frames while the picture moves.
  frameTime = 0;
  onFrame: (() => void) | null = null;

  readonly scene = new Scene();
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly flight: CameraFlight;
  private readonly markers = new ContactMarkers();
  private readonly ghosts: Ghosts;
  private readonly grid: Grid;
  private readonly sweep: Box3;
  private readonly home: Sphere;
  /// Of the whole motion, where what is looked at first is less than that.
  private readonly whole: Box3;
  private readonly reach: number; // [m] From the middle of what is looked at first.
  private showsWhole = false;
  private readonly edges = new Map<MeshData, BufferGeometry | null>();
  private shownContacts: readonly Contact[] = [];
  private readonly cut = new CutPlane();
  private contactsAt: number | null = null; // t
  private dirty = true;
  private lastFrame: number | null = null;
  private coarse = false;

  constructor(
    private readonly model: Model,
    private readonly player: Player,
    private readonly display: Display,
    private readonly container: HTMLElement,
  ) {
    this.renderer = new WebGLRenderer({
      alpha: true,
      antialias: true,
      powerPreference: "high-performance",
    });
    this.renderer.localClippingEnabled = true;
    this.renderer.domElement.setAttribute("role", "img");
    this.renderer.domElement.setAttribute("aria-label", "The bodies in motion");
    container.append(this.renderer.domElement);
    this.camera.up.set(...model.up);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.zoomToCursor = true;
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN };
    this.flight = new CameraFlight(this.camera, this.controls.target);

    const goal = model.path?.data.goal ?? [];
    this.bounds = new Bounds(model.bodies, goal);
    this.sweep = this.bounds.opening(model.firstTouch);
    const ends = model.ties.flatMap((tie) => tie.ends(0));
    ends.forEach((end) => this.sweep.expandByPoint(new Vector3(...end)));
    this.whole = this.bounds.sweep();
    showDevices(model, this.bounds, this.sweep, this.whole);
    this.home = this.sweep.getBoundingSphere(new Sphere());
    this.reach = this.home.center.distanceTo(this.whole.getCenter(new Vector3()));
    this.reach += 0.5 * this.whole.getSize(new Vector3()).length();
    this.grid = new Grid(this.sweep, this.camera.up);
    this.bodies = this.makeBodies();
    this.ghosts = new Ghosts(this.bodies, goal);
    this.path = model.path && new PathView(model.path, this.home.center);
    this.forces = model.run && new ForceMarkers(model.run, this.home.center, this.bodySize());
    this.ties =
      model.run && new TieMarkers(model.run, model.ties, this.home.center, this.bodySize());
    this.devices =
      model.run && model.devices.length > 0
        ? new DeviceMarkers(
            model.run,
            model.devices,
            this.bodies,
            this.home.center,
            this.bodySize(),
          )
        : null;
    this.scene.add(
      ...this.bodies.map(({ group }) => group),
      this.ghosts.group,
      this.grid.object,
      this.markers.group,
      ...(this.forces ? [this.forces.group] : []),
      ...(this.ties ? [this.ties.group] : []),
      ...(this.path ? [this.path.group] : []),
      ...(this.devices ? [this.devices.ghosts, this.devices.arrows] : []),
      this.probe.group,
      this.camera,
    );
    addLights(this.scene, this.camera);
    this.showContacts(model.contacts, model.contactTime);
    this.listen();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  requestFrame(): void {
    this.dirty = true;
  }

  /// Runs from now on.
  start(): void {
    const frame = (now: number): void => {
      requestAnimationFrame(frame);
      this.frame(now);
    };
    this.resize();
    this.fit(this.sweep, true);
    this.controls.update();
    this.draw();
    requestAnimationFrame(frame);
  }

  /// @param background  none where what is behind the canvas is to be seen
  setColors(background: string | null, grid: string): void {
    this.renderer.setClearColor(background ?? "#000", background === null ? 0 : 1);
    this.grid.color = grid;
    this.requestFrame();
  }

  /// The edges take a while to find: first the picture, then its lines.
  addEdges(): void {
    const lacking = ({ drawn, hasEdges }: GeometryView): boolean =>
      drawn.kind === "triangles" && !hasEdges;
    for (const piece of this.bodies.flatMap(({ shownPieces }) => shownPieces).filter(lacking)) {
      const { mesh } = piece.shape;
      const edges = this.edges.get(mesh) ?? edgeGeometry(mesh, piece.surface.geometry);
      this.edges.set(mesh, edges);
      if (edges) {
        piece.setEdges(edges);
      }
    }
    this.restyle();
    this.devices?.makeGhosts();
    this.showGhosts();
    this.showMoment(this.player.t.value);
  }

  /// The whole motion; and by turns what was looked at first, where that is less.
  fitAll(): void {
    this.showsWhole = !this.showsWhole && !this.whole.equals(this.sweep);
    this.fit(this.showsWhole ? this.whole : this.sweep);
  }

  private fit(box: Box3, atOnce = false): void {
    this.display.endOwnCut();
    const seen = corners(box.min, box.max);
    const target = box.getCenter(new Vector3());
    const direction = homeDirection(this.model);
    const range = rangeFor(this.camera, seen, target, direction);
    this.fly({ position: target.clone().addScaledVector(direction, range), target }, atOnce);
  }

  focusBodies(bodies: readonly Body[]): void {
    this.display.endOwnCut();
    this.flyTo(this.bounds.bodiesAt(bodies, this.player.t.value));
  }

  /// Near enough to see where two bodies touch.
  focusPoint(point: Triple, bodies: readonly Body[]): void {
    this.display.endOwnCut();
    const sizes = bodies.map((body) => this.bounds.bodiesAt([body], this.player.t.value).radius);
    this.flyTo(new Sphere(new Vector3(...point), Math.min(...sizes)));
  }

  /// From where the normal is seen from the side, near enough to see the triangles. What hides the
  /// contact from every side is cut away.
  focusContact(contact: Contact): void {
    this.showContacts(
      [contact, ...this.shownContacts.filter((other) => other !== contact)],
      this.contactsAt,
    );
    const scene = this.home.radius;
    const size = Math.min(
      Math.max(5 * contactSize(this.model, contact), 0.03 * scene),
      0.3 * scene,
    );
    const middle = middleOf(contact);
    const toCamera = this.camera.position.clone().sub(this.controls.target).normalize();
    const open = sideViews(contact, toCamera).find((side) => this.sees(middle, side, 0.02 * size));
    const around = new Sphere(middle, size);
    this.display.endOwnCut();
    if (open === undefined && !this.display.cut.value) {
      const share = 0.5 * (1 - (0.25 * size) / rangeTo(this.camera, around));
      this.display.cut.value = { along: "view", share, otherSide: false, byItself: true };
    }
    this.flyTo(around, open ?? sideViews(contact, toCamera)[0]);
  }

  /// The contacts of the scene, or those of a pair that touches later.
  ///
  /// @param t  when they are
  showContacts(contacts: readonly Contact[], t: number | null): void {
    this.shownContacts = contacts;
    this.contactsAt = t;
    this.markers.show(contacts);
    this.bodies.forEach(({ body, geometries }) =>
      geometries.forEach(({ group, shape }) => {
        group.remove(...group.children.filter(({ name }) => name === "touching"));
        const surface = touchingSurface(body, shape, contacts);
        surface.name = "touching";
        surface.visible = this.display.contacts.value;
        group.add(surface);
      }),
    );
    this.showMoment(this.player.t.value);
  }

  lookAlong(direction: Vector3): void {
    const range = this.camera.position.distanceTo(this.controls.target);
    const target = this.controls.target.clone();
    this.fly({ position: target.clone().addScaledVector(direction, range), target });
  }

  /// The nearest surface under a place of the window.
  hitAt(x: number, y: number): Intersection | undefined {
    const ray = this.rayAt(x, y);
    ray.params.Points.threshold = 0.005 * this.home.radius;
    return ray
      .intersectObjects(this.shownSurfaces(), false)
      .find(({ distance, point }) => distance > this.camera.near && this.cut.keeps(point));
  }

  /// The edge of a planned path under a place of the window.
  edgeAt(x: number, y: number): number | null {
    return this.path?.edgeOn(this.rayAt(x, y)) ?? null;
  }

  private rayAt(x: number, y: number): Raycaster {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2(
      (2 * (x - box.left)) / box.width - 1,
      1 - (2 * (y - box.top)) / box.height,
    );
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray;
  }

  /// The point of a body under a place of the window.
  pick(x: number, y: number): void {
    const hit = this.hitAt(x, y);
    if (!hit) {
      this.probe.clear();
      return;
    }
    const found = hit.object.userData as { body: number; shape: BodyGeometry };
    const body = this.model.bodies[found.body]!;
    const t = this.player.t.value;
    const triangle = hit.faceIndex ?? hit.index ?? 0;
    const local = unplace(body.motion(t), hit.point.toArray());
    this.probe.add(probePoint(body, found.shape, triangle, local, t), this.display.measure.value);
  }

  /// Draws now, for a picture of it.
  draw(): void {
    this.adaptClipping();
    this.cut.update(this.display.cut.value, this.camera, this.controls.target, this.sweep);
    this.markers.adapt(this.camera);
    this.renderer.render(this.scene, this.camera);
    this.onFrame?.();
  }

  /// Whether nothing stands between a point and a camera in that direction.
  private sees(point: Vector3, direction: Vector3, slack: number): boolean {
    const ray = new Raycaster(point.clone().addScaledVector(direction, slack), direction);
    this.scene.updateMatrixWorld();
    return ray.intersectObjects(this.shownSurfaces(), false).length === 0;
  }

  private shownSurfaces(): Surface[] {
    return this.bodies
      .filter(({ group }) => group.visible)
      .flatMap(({ shownPieces }) => shownPieces.map(({ surface }) => surface));
  }

  /// [m] The median radius of the bodies that move.
  private bodySize(): number {
    const radii = this.model.bodies
      .filter(({ atRest }) => !atRest)
      .map((body) => this.bounds.bodiesAt([body], 0).radius)
      .sort((a, b) => a - b);
    return radii[Math.floor(radii.length / 2)] ?? this.home.radius;
  }

  private makeBodies(): BodyView[] {
    const { bodies } = this.model;
    const shapes = new DrawnShapes();
    return bodies.map((body) => new BodyView(body, shapes, bodyColor(body, bodies)));
  }

  private listen(): void {
    const { display, player } = this;
    player.t.subscribe((t) => this.showMoment(t));
    [display.wireframe, display.xray, display.edges].forEach((signal) =>
      signal.subscribe(() => this.restyle()),
    );
    display.looks.subscribe((looks) => {
      this.bodies.forEach((view) => view.showLooks(looks));
      setTimeout(() => this.addEdges());
      this.requestFrame();
    });
    display.cut.subscribe(() => this.requestFrame());
    display.opacities.subscribe(() => this.restyle());
    player.speed.subscribe(() => this.showMoment(player.t.value));
    [display.ghosts, display.onion].forEach((signal) => signal.subscribe(() => this.showGhosts()));
    display.contacts.subscribe((shown) => {
      this.markers.group.visible = shown;
      if (this.forces) {
        this.forces.dots.visible = shown;
      }
      this.bodies
        .flatMap(({ geometries }) => geometries.flatMap(({ group }) => group.children))
        .filter(({ name }) => name === "touching")
        .forEach((surface) => (surface.visible = shown));
      this.requestFrame();
    });
    const on = (signal: Signal<boolean>, show: (shown: boolean) => void): void =>
      signal.subscribe((shown) => {
        show(shown);
        this.requestFrame();
      });
    on(display.forces, (shown) => {
      setVisible(shown, this.forces?.arrows, this.devices?.arrows);
    });
    on(display.devices, (shown) => setVisible(shown, this.devices?.ghosts));
    on(display.path, (shown) => this.path?.showPath(shown));
    on(display.trees, (shown) => this.path?.showTrees(shown));
    display.hidden.subscribe((hidden) => {
      this.bodies.forEach(({ group, body }) => (group.visible = !hidden.has(body.index)));
      this.devices?.show(player.t.value);
      this.showGhosts();
    });
    this.probe.points.subscribe(() => this.showMoment(player.t.value));
    this.controls.addEventListener("change", () => this.requestFrame());
    this.controls.addEventListener("start", () => this.flight.stop());
    new ResizeObserver(() => {
      this.resize();
      this.draw(); // At once: a canvas that was resized is empty.
    }).observe(this.container);
  }

  private showMoment(t: number): void {
    this.bodies.forEach((view) => view.show(t));
    const { duration, speed } = this.player;
    const window = (blink * speed.value) / duration;
    this.fadeContacts(
      this.contactsAt === null ? 0 : nearness(t, this.contactsAt, Math.max(window, nearContact)),
    );
    this.forces?.show(t, window);
    this.ties?.show(t);
    this.devices?.show(t);
    this.probe.show(t);
    this.requestFrame();
  }

  /// Points, normal and triangles of the contacts that are shown.
  private fadeContacts(nearness: number): void {
    this.markers.fade(nearness);
    this.bodies
      .flatMap(({ geometries }) => geometries.flatMap(({ group }) => group.children))
      .filter(({ name }) => name === "touching")
      .forEach((surface) => fadeSurface(surface, nearness));
  }

  private restyle(): void {
    const { wireframe, xray, edges } = this.display;
    this.bodies.forEach((view) =>
      view.setStyle({
        wireframe: wireframe.value,
        xray: xray.value,
        edges: edges.value,
        opacity: this.display.opacityOf(view.body.index),
        cut: this.cut.planes,
      }),
    );
    this.requestFrame();
  }

  private showGhosts(): void {
    const { ghosts, onion, hidden } = this.display;
    this.ghosts.show({ ends: ghosts.value, onion: onion.value, hidden: hidden.value });
    this.requestFrame();
  }

  private flyTo(sphere: Sphere, direction?: Vector3): void {
    const toCamera =
      direction ?? this.camera.position.clone().sub(this.controls.target).normalize();
    const range = rangeTo(this.camera, sphere);
    const target = sphere.center.clone();
    this.fly({ position: target.clone().addScaledVector(toCamera, range), target });
  }

  private fly(to: Viewpoint, atOnce = false): void {
    const reduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.flight.start(to, atOnce || reduced);
    this.requestFrame();
  }

  private frame(now: number): void {
    const elapsed = this.lastFrame === null ? 0 : now - this.lastFrame;
    const moving = this.player.playing.value || this.flight.flying;
    this.lastFrame = now;
    this.player.advance(Math.min(elapsed, 250) / 1000);
    this.flight.advance(elapsed / 1000);
    this.controls.update();
    if (moving) {
      this.frameTime = 0.8 * this.frameTime + 0.2 * elapsed;
    }
    this.setCoarse(moving && this.frameTime > slowFrame);
    if (this.dirty || moving) {
      this.dirty = false;
      this.draw();
    }
  }

  private setCoarse(coarse: boolean): void {
    if (coarse !== this.coarse) {
      this.coarse = coarse;
      this.resize();
      this.requestFrame();
    }
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.container;
    if (width === 0 || height === 0) {
      return;
    }
    this.renderer.setPixelRatio(this.coarse ? 0.75 : Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /// From far and near: the depth buffer is spread over what can be seen.
  private adaptClipping(): void {
    const range = this.camera.position.distanceTo(this.controls.target);
    const away = this.camera.position.distanceTo(this.home.center);
    this.camera.near = Math.max(range / 200, (away - 6 * this.home.radius) / 50, 1e-12);
    this.camera.far = Math.max(away + 8 * this.home.radius, away + this.reach, 4 * range);
    this.camera.updateProjectionMatrix();
  }
}
