// The planned hole (well.plan of the configuration) as points in the frame of the tool, and the distance of a point to it.

import type { Plan, Tool } from "./api";

export type Point = [number, number, number];

/** Distance of two points of the plan (m): an arc of 3 m radius differs by 0.1 mm from its chord. */
const STEP = 0.05;

/** Unit vector of a direction: along azimuth 0, to the right, down. */
function direction(inclination: number, azimuth: number): Point {
  const across = Math.sin(inclination);
  return [across * Math.cos(azimuth), across * Math.sin(azimuth), Math.cos(inclination)];
}

/** The direction at a share of the way between two, on the great circle (minimum curvature). */
function between(from: Point, to: Point, share: number): Point {
  const cosine = from.reduce((sum, part, axis) => sum + part * to[axis], 0);
  const angle = Math.acos(Math.min(Math.max(cosine, -1), 1));
  // Equal directions, and opposite ones, which no arc joins.
  if (angle < 1e-9 || Math.PI - angle < 1e-6) return to;
  const [a, b] = [(1 - share) * angle, share * angle].map((part) => Math.sin(part) / Math.sin(angle));
  return from.map((part, axis) => a * part + b * to[axis]) as Point;
}

/** The direction of a plan at a measured depth (m). */
function along({ stations }: Plan, depth: number): Point {
  const found = stations.findIndex((station) => station.measured_depth >= depth);
  const after = Math.min(Math.max(found < 0 ? stations.length - 1 : found, 1), stations.length - 1);
  const [above, below] = [stations[after - 1], stations[after]];
  const share = (depth - above.measured_depth) / (below.measured_depth - above.measured_depth);
  const [from, to] = [above, below].map(({ inclination, azimuth }) => direction(inclination, azimuth));
  return between(from, to, Math.min(Math.max(share, 0), 1));
}

/** The place of the hole as configured at a measured depth (m). */
export function onHole({ stations }: Tool, depth: number): Point | null {
  const after = stations.findIndex((station) => station.measured_depth >= depth);
  const below = stations[after];
  const above = stations[Math.max(after - 1, 0)];
  if (!below?.position || !above.position) return null;
  const length = below.measured_depth - above.measured_depth;
  const share = length > 0 ? (depth - above.measured_depth) / length : 0;
  return above.position.map((part, axis) => part + share * ((below.position?.[axis] ?? NaN) - part)) as Point;
}

/**
 * The plan from its first station to `end` (m of measured depth), laid from the hole as configured. That hole has no
 * azimuth: it lies in the plane that the plan has at the bit. Empty where the plan is a file of the twin's computer.
 */
export function laid(tool: Tool, bit: number, end: number): Point[] {
  const { plan } = tool;
  const begin = plan?.stations[0]?.measured_depth;
  if (!plan || plan.stations.length < 2 || begin === undefined) return [];
  const hole = onHole(tool, begin);
  if (!hole) return [];
  // A hole that has left its plan does not begin on it.
  let at = hole.map((part, axis) => part + (plan.offset?.[axis] ?? 0)) as Point;
  const [x, y] = along(plan, bit);
  const plane = Math.hypot(x, y) > 1e-9 ? Math.atan2(y, x) : 0;
  const [sine, cosine] = [Math.sin(plane), Math.cos(plane)];
  const last = Math.min(end, plan.stations[plan.stations.length - 1].measured_depth);
  const count = Math.ceil((last - begin) / STEP);
  const points: Point[] = [at];
  for (let index = 0; index < count; index++) {
    const step = (last - begin) / count;
    const [north, east, down] = along(plan, begin + (index + 0.5) * step);
    at = [
      at[0] + step * (north * cosine + east * sine),
      at[1] + step * (east * cosine - north * sine),
      at[2] + step * down,
    ];
    points.push(at);
  }
  return points;
}

/** Distance of a point to a line through points (m); NaN where there are less than two. */
export function distance(line: readonly Point[], point: Point): number {
  let least = NaN;
  for (let index = 1; index < line.length; index++) {
    const way = line[index].map((part, axis) => part - line[index - 1][axis]);
    const off = point.map((part, axis) => part - line[index - 1][axis]);
    const square = way.reduce((sum, part) => sum + part * part, 0);
    const share = square > 0 ? way.reduce((sum, part, axis) => sum + part * off[axis], 0) / square : 0;
    const held = Math.min(Math.max(share, 0), 1);
    const here = Math.hypot(...off.map((part, axis) => part - held * way[axis]));
    if (!(here >= least)) least = here;
  }
  return least;
}
