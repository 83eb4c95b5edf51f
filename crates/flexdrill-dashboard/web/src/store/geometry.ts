// Where things are along the tool, and how far its pipes are from the bore's axis.

import type { Tool } from "../api";
import type { ContactForces, JointDeflections, MarkerArray, WhirlState } from "../messages";

/** Where things are along the tool; does not change while a configuration runs. */
export interface Geometry {
  /** Measured depth of stations (m), their inclination (rad) and place in the world (x, y, z each, m). */
  stationDepth: Float64Array;
  stationInclination: Float64Array;
  stationPosition: Float32Array;
  /** Measured depth of joints (m), their station and the angle of their stop (rad). */
  jointDepth: Float64Array;
  jointStation: Int32Array;
  jointLimit: number;
  /** Measured depth of watched places (m), their body and station. */
  watchedDepth: Float64Array;
  watchedBody: Uint8Array;
  watchedStation: Int32Array;
}

/** The first messages of a tool: all that says where its parts are. */
export interface First {
  contacts: ContactForces;
  joints: JointDeflections;
  whirl: WhirlState;
  shape: MarkerArray;
}

export function geometryOf({ contacts, joints, whirl, shape }: First): Geometry {
  const depth = contacts.measured_depth.slice();
  const position = new Float32Array(3 * depth.length);
  line(shape, "bore")
    .slice(0, depth.length)
    .forEach((point, index) => position.set([point.x, point.y, point.z], 3 * index));
  return {
    stationDepth: depth,
    stationInclination: contacts.inclination.slice(),
    stationPosition: position,
    jointDepth: joints.measured_depth.slice(),
    jointStation: Int32Array.from(joints.measured_depth, (at) => nearest(depth, at)),
    jointLimit: joints.limit_angle[0] ?? NaN,
    watchedDepth: whirl.measured_depth.slice(),
    watchedBody: whirl.body.slice(),
    watchedStation: Int32Array.from(whirl.measured_depth, (at) => nearest(depth, at)),
  };
}

/** The same as the server has it of the session, with the places that are watched for whirl. */
export function geometryOfTool(
  tool: Tool,
  watched: number,
  bodies: readonly number[],
  depths: readonly (number | null)[],
): Geometry {
  const stationDepth = Float64Array.from(tool.stations, (station) => station.measured_depth);
  // A server that does not know the watched places leaves them off the tool.
  const known = bodies.length === watched && depths.length === watched;
  const watchedDepth = Float64Array.from({ length: watched }, (_, index) => (known ? (depths[index] ?? NaN) : NaN));
  return {
    stationDepth,
    stationInclination: Float64Array.from(tool.stations, (station) => station.inclination),
    stationPosition: Float32Array.from(tool.stations.flatMap((station) => station.position ?? [NaN, NaN, NaN])),
    jointDepth: Float64Array.from(tool.joints, (joint) => joint.measured_depth),
    jointStation: Int32Array.from(tool.joints, (joint) => joint.station),
    jointLimit: tool.joint_limit,
    watchedDepth,
    watchedBody: Uint8Array.from({ length: watched }, (_, index) => (known ? bodies[index] : 0)),
    watchedStation: Int32Array.from(watchedDepth, (at) => nearest(stationDepth, at)),
  };
}

/** The geometry with the places that are watched by a message: those of the server's hour may be of another run. */
export function watching(geometry: Geometry, { measured_depth: depth, body }: WhirlState): Geometry {
  const same = depth.every(
    (at, index) => at === geometry.watchedDepth[index] && body[index] === geometry.watchedBody[index],
  );
  if (same) return geometry;
  return {
    ...geometry,
    watchedDepth: depth.slice(),
    watchedBody: body.slice(),
    watchedStation: Int32Array.from(depth, (at) => nearest(geometry.stationDepth, at)),
  };
}

/**
 * Displacements of pipe and guide from the bore's axis at every station, horizontal and towards the low side (m), out
 * of the drawn shape, which shows them `exaggeration` times as large. Hands each to `put`; nothing of a shape of
 * another tool.
 */
export function displacements(
  shape: MarkerArray,
  geometry: Geometry,
  exaggeration: number,
  put: (body: "pipe" | "guide", station: number, across: number, low: number) => void,
): void {
  const stations = geometry.stationDepth.length;
  const bore = line(shape, "bore");
  const bodies = [
    ["pipe", line(shape, "flexible_pipe")],
    ["guide", line(shape, "guide_pipe")],
  ] as const;
  if (bore.length !== stations || bodies.some(([, points]) => points.length !== stations)) return;
  for (let station = 0; station < stations; station++) {
    const angle = geometry.stationInclination[station];
    const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
    for (const [body, points] of bodies) {
      const x = points[station].x - bore[station].x;
      const y = points[station].y - bore[station].y;
      const z = points[station].z - bore[station].z;
      put(body, station, y / exaggeration, (sin * z - cos * x) / exaggeration);
    }
  }
}

function line(shape: MarkerArray, name: string): MarkerArray["markers"][number]["points"] {
  return shape.markers.find((marker) => marker.ns === name)?.points ?? [];
}

/** Index of the entry nearest to a value. */
export function nearest(values: ArrayLike<number>, value: number): number {
  let best = 0;
  for (let index = 1; index < values.length; index++) {
    if (Math.abs(values[index] - value) < Math.abs(values[best] - value)) best = index;
  }
  return best;
}
