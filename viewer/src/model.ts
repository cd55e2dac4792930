/// A result, or a run, made ready to be shown.

import type {
  Answer,
  BodyData,
  Contact,
  Limit,
  PairAnswer,
  Result,
  Turn,
  Vector3,
} from "./data/result";
import type { FileReport, PairCounts } from "./data/reports";
import type { GapLine, MeshData, PageData, RateData } from "./data/page_data";
import type { GeometryData, RobotData, SegmentData, StretchData } from "./data/robot_data";
import type { RunData, WayData } from "./data/run_data";
import { devicesOf, type Device } from "./devices";
import { combine, identity, isAtRest, motionOf, poseOf, totalAngle } from "./motion/motion";
import type { Motion, Pose } from "./motion/motion";
import { chainTo, coordinateAt, derivativeAt, linkMotions, restsAt, restsOn } from "./motion/robot";
import { length, scale, unit, zero } from "./motion/vector";
import { angleAlong, motionAlong } from "./motion/way";
import { Path } from "./path";
import { Run } from "./run";
import { tiesOf, type Tie } from "./ties";

/// A rigid geometry of a body, in a frame of its own; or the whole of a body that deforms.
export interface BodyGeometry {
  readonly mesh: MeshData;
  readonly pose: Pose; ///< In the body.
  readonly radius: number; ///< [m] By which its triangles are thickened.
  readonly color: string | null; ///< That it looks like, if its file says so.
  readonly to: readonly Vector3[] | null; ///< Where its vertices end, in the world, if it deforms.
}

/// The motion of a body in a run.
export interface Course {
  readonly way: WayData;
  readonly centre: Vector3; ///< Of mass, in the body: it goes on lines.
}

/// All that can touch: a body, or a link of a robot.
export interface Body {
  readonly index: number;
  readonly name: string;
  readonly label: string; ///< Within its robot.
  readonly robot: number | null;
  readonly kind: string; ///< How it moves, in a word or two.
  readonly geometries: readonly BodyGeometry[]; ///< What was tested.
  readonly looks: readonly BodyGeometry[] | null; ///< What it looks like, where that differs.
  readonly motion: Motion;
  readonly atRest: boolean;
  readonly angle: number; ///< [rad] No more than this is it turned over the whole step.
  readonly course?: Course; ///< Of a run, where the body moves.
}

/// Some links have nothing that could be drawn.
export const isDrawn = ({ geometries, looks }: Body): boolean =>
  geometries.length > 0 || looks !== null;

/// The rates of a coordinate, each the derivative of the one before.
export const rateNames = ["velocity", "acceleration", "jerk"] as const;
export type RateName = (typeof rateNames)[number];

/// A rate of a coordinate over the step. [rad or m; per s, s² or s³]
export interface Rate {
  readonly name: RateName;
  readonly limit: number | null; ///< Of its size.
  readonly at: (t: number) => number;
}

/// One coordinate of a joint over the step.
export interface Coordinate {
  readonly robot: number;
  readonly joint: string;
  readonly name: string;
  readonly unit: "rad" | "m";
  readonly lower: number | null;
  readonly upper: number | null;
  readonly atRest: boolean;
  readonly mimics: string | null;
  readonly breaks: readonly number[]; ///< Where its segments end.
  readonly at: (t: number) => number;
  readonly rates: readonly Rate[];
  readonly violations: readonly Limit[];
  /// Which way it went, of a joint that turns without end.
  readonly turn: Turn | null;
}

const kinds: Readonly<Record<string, string>> = {
  constant_velocity: "constant velocity",
  screw: "screw",
  waypoints: "waypoints",
  vertices: "deforms",
  fixed: "at rest",
};

function radiusOf({ shape }: BodyData): number {
  const round = (shape.sphere ?? shape.capsule ?? shape) as { radius?: number };
  return typeof round.radius === "number" ? round.radius : 0;
}

function bodyOf(data: BodyData, index: number, mesh: MeshData, duration: number): Body {
  const { motion } = data;
  const to = motion?.type === "vertices" ? motion.to : null;
  return {
    index,
    name: data.name,
    label: data.name,
    robot: null,
    kind: kinds[motion?.type ?? "fixed"] ?? "",
    geometries: [{ mesh, pose: identity, radius: radiusOf(data), color: null, to }],
    looks: null,
    motion: motionOf(data, duration),
    atRest: isAtRest(data),
    angle: motion ? totalAngle(motion) : 0,
  };
}

/// Returns a body that moves as recorded in the run, in place of its motion in the scene.
function along(body: Body, way: WayData, { header, linksFrom, steps }: RunData): Body {
  const centre = header.centres_of_mass[way.body]!;
  return {
    ...body,
    kind: way.body >= linksFrom ? "link" : header.masses[way.body]! > 0 ? "free" : body.kind,
    motion: motionAlong(way, centre, steps.at(-1)!.time),
    atRest: false,
    angle: angleAlong(way),
    course: { way, centre },
  };
}

const turns = (type: string): boolean => type !== "prismatic" && type !== "fixed";

/// Computes the total variation of a coordinate, from samples.
function variation(at: (t: number) => number): number {
  const samples = Array.from({ length: 129 }, (_, k) => at(k / 128));
  return samples.slice(1).reduce((sum, q, k) => sum + Math.abs(q - samples[k]!), 0);
}

/// How the link moves against its parent, and how far it turns in the world.
function linkMotion(robot: RobotData, link: number) {
  const chain = chainTo(robot, link);
  const moves = chain.filter(({ coordinates = [], motion = [] }) => {
    const still = coordinates.every(({ segments }) => restsAt(segments));
    return !(still && (motion.length === 0 || restsOn(motion)));
  });
  const angle = moves
    .filter(({ type }) => turns(type))
    .flatMap(({ coordinates = [] }) => coordinates.slice(-1))
    .reduce((sum, { segments }) => sum + variation((t) => coordinateAt(segments, t)), 0);
  return {
    kind: chain.at(-1)?.type ?? "base",
    atRest: moves.length === 0 && restsOn(robot.base),
    angle: angle + (restsOn(robot.base) ? 0 : Math.PI * robot.base.length),
  };
}

const cssColor = (color: Vector3): string =>
  `rgb(${color.map((share) => Math.round(255 * share)).join(",")})`; // As three reads it.

function linksOf(robot: RobotData, index: number, first: number, meshes: readonly MeshData[]) {
  const motions = linkMotions(robot);
  const shape = ({ mesh, pose, radius = 0, color }: GeometryData): BodyGeometry => ({
    mesh: meshes[mesh]!,
    pose: poseOf(pose),
    radius,
    color: color ? cssColor(color) : null,
    to: null,
  });
  return robot.links.map(({ name, collision, visual = [] }, link): Body => ({
    index: first + link,
    name: `${robot.name}/${name}`,
    label: name,
    robot: index,
    geometries: collision.map(shape),
    looks: visual.length > 0 ? visual.map(shape) : null,
    motion: motions[link]!,
    ...linkMotion(robot, link),
  }));
}

/// A body that links carry for a while.
function carried(body: Body, stretches: readonly StretchData[], bodies: readonly Body[]): Body {
  const holders = stretches.flatMap(({ link }) => (link === undefined ? [] : [bodies[link]!]));
  const motions = stretches.map(({ link, pose }): Motion => {
    const at = pose ? poseOf(pose) : identity;
    const holder = link === undefined ? null : bodies[link]!.motion;
    return holder ? (t) => combine(holder(t), at) : pose ? () => at : body.motion;
  });
  return {
    ...body,
    kind: `carried by ${[...new Set(holders.map(({ label }) => label))].join(", ")}`,
    motion: (t) => {
      const found = stretches.findIndex(({ until }) => t <= until);
      return motions.at(found)!(t);
    },
    atRest: body.atRest && holders.every(({ atRest }) => atRest),
    angle: body.angle + Math.max(...holders.map(({ angle }) => angle)),
  };
}

/// The velocity of a coordinate that moves, and those further rates that its polynomials have.
///
/// Between positions alone a coordinate jumps from one velocity to the next, so that its
/// acceleration is not drawn. A jerk is where it has a limit.
function ratesOf(
  segments: readonly SegmentData[],
  duration: number,
  velocity: number | undefined,
  given: RateData | undefined,
): Rate[] {
  const degree = Math.max(...segments.map(({ a }) => a.length - 1));
  const limits = [given?.velocity ?? velocity, given?.acceleration, given?.jerk];
  return rateNames
    .map((name, k): Rate => ({
      name,
      limit: limits[k] || null,
      at: (t) => derivativeAt(segments, t, k + 1) / duration ** (k + 1),
    }))
    .filter(
      ({ name, limit }) =>
        !restsAt(segments) &&
        (name === "velocity" || degree > 1) &&
        (name !== "jerk" || limit !== null),
    );
}

/// Limits belong to the coordinate of a joint that has one.
function coordinatesOf(
  robot: RobotData,
  index: number,
  duration: number,
  rates: readonly RateData[],
  { limits = [], turns: ways = [] }: Partial<Result>,
): Coordinate[] {
  return robot.joints.flatMap(({ name: joint, type, limits: own, mimics, coordinates = [] }) =>
    coordinates.map(({ name, segments }, k): Coordinate => {
      const single = coordinates.length === 1;
      const hasEnds = single && type !== "continuous";
      return {
        robot: index,
        joint,
        name,
        unit: single ? (turns(type) ? "rad" : "m") : k === 2 ? "rad" : "m",
        lower: hasEnds ? (own.lower ?? null) : null,
        upper: hasEnds ? (own.upper ?? null) : null,
        atRest: restsAt(segments),
        mimics: mimics ?? null,
        breaks: segments.map(({ until }) => until),
        at: (t) => coordinateAt(segments, t),
        rates: ratesOf(
          segments,
          duration,
          single ? own.velocity : undefined,
          rates.find((rate) => rate.robot === robot.name && rate.coordinate === name),
        ),
        violations: limits.filter((found) => found.robot === robot.name && found.joint === joint),
        // That of a planar joint has the name of the coordinate.
        turn: ways.find((way) => way.robot === robot.name && way.joint === name) ?? null,
      };
    }),
  );
}

/// The name of the page's own file, without its ending; nothing of a page inside another one.
function pageName(): string {
  const { protocol, pathname } = globalThis.location ?? { protocol: "", pathname: "" };
  if (!["file:", "http:", "https:"].includes(protocol)) {
    return "";
  }
  try {
    return decodeURIComponent(pathname.split("/").at(-1)!).replace(/\.html?$/i, "");
  } catch {
    return ""; // Not a name that a browser writes.
  }
}

export class Model {
  readonly title: string;
  readonly version: string;
  /// [s]
  readonly duration: number;
  /// Either `result` or `run` is null.
  readonly result: Result | null;
  readonly run: Run | null;
  /// Bodies, then the links of each robot.
  readonly bodies: readonly Body[];
  /// Of a run.
  readonly ties: readonly Tie[];
  /// Of a haptic run.
  readonly devices: readonly Device[];
  readonly robots: readonly string[];
  readonly coordinates: readonly Coordinate[];
  readonly gap: GapLine;
  readonly gapBound: GapLine;
  /// The planned path that is played, or the search that found none.
  readonly path: Path | null;
  /// Whether there is nothing to play.
  readonly isStill: boolean;
  /// Those of every pair where the result has them, each at its own pair's time.
  readonly pairs: readonly PairAnswer[];
  /// The warnings for the user.
  readonly warnings: readonly string[];
  /// Which pairs the answer is about; null where that is not known.
  readonly pairCounts: PairCounts | null;
  readonly files: readonly FileReport[];

  private readonly indices: ReadonlyMap<string, number>;

  constructor(page: PageData) {
    const { result, run, scene, robots } = page;
    this.title = scene.id || pageName() || "Scene";
    this.version = page.version;
    this.result = result;
    this.run = run ? new Run(run) : null;
    this.duration = this.run?.duration ?? scene.options.duration;
    this.gap = page.gap;
    this.gapBound = page.gapBound;
    this.path = page.path && new Path(page.path);
    const bodies = scene.bodies.map((data, index) =>
      bodyOf(data, index, page.meshes[page.bodies[index]!]!, scene.options.duration),
    );
    run?.ways.forEach((way) => (bodies[way.body] = along(bodies[way.body]!, way, run)));
    robots.forEach((robot, index) =>
      bodies.push(...linksOf(robot, index, bodies.length, page.meshes)),
    );
    page.carried.forEach(({ body, stretches }) => {
      bodies[body] = carried(bodies[body]!, stretches, bodies);
    });
    this.isStill = this.path?.failed === true && bodies.every(({ atRest }) => atRest);
    page.path?.goal.forEach(({ body }) => {
      bodies[body] = { ...bodies[body]!, kind: "planned", atRest: false };
    });
    this.bodies = bodies;
    this.ties = run ? tiesOf(run, bodies) : [];
    this.devices = run ? devicesOf(run, bodies) : [];
    this.robots = robots.map(({ name }) => name);
    this.coordinates = robots.flatMap((robot, index) =>
      coordinatesOf(robot, index, this.duration, page.rates, result ?? {}),
    );
    this.indices = new Map(bodies.map(({ name }, index) => [name, index]));
    // The result of a search without a path is about what rests at the start.
    this.pairs = this.path?.failed ? [] : (result?.pairs ?? []);
    this.pairCounts = page.pairCounts;
    this.files = page.files;
    this.warnings = [...(result?.warnings ?? []), ...page.warnings];
  }

  /// Against gravity, in runs.
  get up(): Vector3 {
    const up = unit(scale(-1, this.run?.gravity ?? zero));
    return length(up) > 0 ? up : [0, 0, 1];
  }

  /// t until which all bodies are proven apart; those of a run are to its end.
  get provenUntil(): number {
    return this.result?.t ?? 1;
  }

  /// t of the first contact; none where nothing touches, or nobody knows.
  get contactTime(): number | null {
    if (this.path?.failed) {
      return null;
    }
    const touch = this.result?.verdict === "contact" || this.result?.verdict === "contact_at_start";
    return touch ? this.provenUntil : null;
  }

  /// [m] Lengths of a result are not known better; 0 where nothing is said of it.
  get grain(): number {
    const { tolerance_used, enclosure_error = 0, scene } = this.result ?? {};
    return this.result ? (tolerance_used ?? scene?.options.tolerance ?? 0) + enclosure_error : 0;
  }

  /// [s] In which the bodies of an answer close its tolerance; 0 where their speed is not known.
  timeGrain({ contacts }: Answer): number {
    const speeds = contacts.map(({ normal_velocity }) => Math.abs(normal_velocity ?? 0));
    const fastest = Math.max(...speeds, 0);
    return fastest > 0 ? this.grain / fastest : 0;
  }

  /// t at which something touches for the first time, in a result or a run.
  get firstTouch(): number | null {
    return this.run ? this.run.firstTouch : this.contactTime;
  }

  get contacts(): readonly Contact[] {
    return this.contactTime === null ? [] : (this.result?.contacts ?? []);
  }

  get triangleCount(): number {
    const geometries = this.bodies.flatMap((body) => body.geometries);
    return geometries.reduce((sum, { mesh }) => sum + mesh.triangles.length / 3, 0);
  }

  /// True if any link has visual geometry that differs from the tested one, or a colour of its own.
  get hasLooks(): boolean {
    return this.bodies.some(
      ({ geometries, looks }) => looks !== null || geometries.some(({ color }) => color !== null),
    );
  }

  body(name: string): Body {
    return this.bodies[this.indices.get(name)!]!;
  }

  /// The name of a link without that of its robot, where there is only one.
  shortName(name: string): string {
    return this.robots.length === 1 ? this.body(name).label : name;
  }

  /// The geometry of a body that touches.
  geometryOf(contact: Contact, side: 0 | 1): BodyGeometry {
    return this.body(contact.bodies[side]).geometries[contact.geometries?.[side] ?? 0]!;
  }
}
