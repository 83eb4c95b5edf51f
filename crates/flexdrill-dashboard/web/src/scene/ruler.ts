// A scale of vertical depth next to the tool: the direction of gravity and the depth of each part.

import { valueTicks } from "../ticks";
import type { Vec3 } from "./matrix";

/** How far the scale is from the kick-off, against the build's direction (m). */
const ASIDE = 0.45;
/** Length of a tick (m), and of the line below the deepest point. */
const TICK = 0.08;
const BELOW = 0.25;
/** Most ticks. */
const MOST = 6;

export interface Ruler {
  /** Upper and lower end. */
  head: Vec3;
  foot: Vec3;
  /** Value in the display's unit. */
  ticks: { value: number; from: Vec3; to: Vec3 }[];
}

/** Next to a line of stations (x, y, z each, m; z down); `shown` converts a depth below the kick-off (m) for the display. */
export function ruler(line: Float32Array, shown: (depth: number) => number): Ruler {
  const [x, y, top] = [line[0] - ASIDE, line[1], line[2]];
  let deepest = top;
  for (let index = 2; index < line.length; index += 3) deepest = Math.max(deepest, line[index]);
  // A tool that lies level has a scale too.
  const depth = Math.max(deepest - top, 0.5);
  const factor = shown(1);
  return {
    head: [x, y, top],
    foot: [x, y, top + depth + BELOW],
    ticks: valueTicks(0, depth * factor, MOST).map((value) => {
      const z = top + value / factor;
      return { value, from: [x - TICK, y, z], to: [x, y, z] };
    }),
  };
}
