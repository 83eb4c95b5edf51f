// What plausible tools do: the newest message, and the bands of the time that strips show.

import type { Bands } from "../messages";
import { nearest } from "./geometry";
import { Ring } from "./ring";
import { stamp } from "./topics";

/** Rows of the longest strips, an hour, and what the message comes late. */
const HOUR = 3660;
/** Rows of the profiles: five minutes, the longest strip of a station. */
const PROFILES = 330;
/** A band says nothing about values that are more than this after it (s). */
const HOLDS = 10;
/** Bands are a second behind the twin, so one that is more than this ahead is of another time (s). */
const AHEAD = 1;
/** A station without one of the plausible tools within half a link (m) has no band. */
const NEAR = 0.1;
/** Without a band for this long (s) the fill of a strip ends. */
export const GAP = 3;

/** Ends of a band: 5 and 95 % of plausible tools, in SI units. */
export interface Range {
  low: number;
  high: number;
}

/** Times (s), lower and upper ends of a band. */
export type BandRows = [number[], (number | null)[], (number | null)[]];
export type LayerOfForce = "pipe_guide" | "guide_wall";

export class BandBook {
  /** The newest message; null where none has ever come. */
  newest: Bands | null = null;
  /** Counts messages, so that strips refresh. */
  revision = 0;
  /** Names of the figures in the order of the columns, two per figure. */
  private names: string[] = [];
  private figures: Ring | null = null;
  private depth: ArrayLike<number> = [];
  /** Both layers, lower and upper ends, by station. */
  private profiles: Ring | null = null;

  take(bands: Bands): void {
    this.newest = bands;
    this.revision++;
    const time = stamp(bands.header);
    // A player that was brought back, or a message that came twice.
    this.figures?.cut(time);
    this.profiles?.cut(time);
    this.takeFigures(time, bands);
    this.takeProfiles(time, bands);
  }

  /** What is known is of another time or tool. */
  clear(): void {
    this.newest = null;
    this.figures?.clear();
    this.profiles?.clear();
    this.revision++;
  }

  private takeFigures(time: number, { bands }: Bands): void {
    const names = bands.map(({ name }) => name);
    if (names.length > 0 && names.join() !== this.names.join()) {
      this.names = names;
      this.figures = new Ring(HOUR, 2 * names.length);
    }
    // A message without bands ends those before it.
    const row = this.figures?.push(time).fill(NaN);
    bands.forEach(({ p5, p95 }, index) => row?.set([p5, p95], 2 * index));
  }

  private takeProfiles(time: number, bands: Bands): void {
    const count = bands.measured_depth.length;
    if (count > 0 && count !== this.depth.length) this.profiles = new Ring(PROFILES, 4 * count);
    if (count > 0) this.depth = bands.measured_depth;
    const row = this.profiles?.push(time).fill(NaN);
    const ends = [
      bands.pipe_guide_force_p5,
      bands.pipe_guide_force_p95,
      bands.guide_wall_force_p5,
      bands.guide_wall_force_p95,
    ];
    ends.forEach((of, part) => of.forEach((force, station) => row?.set([force], part * count + station)));
  }

  /** The newest message where it is of the present at `now` (s); null otherwise. */
  fresh(now: number): Bands | null {
    if (!this.newest) return null;
    const age = now - stamp(this.newest.header);
    return age <= HOLDS && age > -AHEAD ? this.newest : null;
  }

  /** The band of a figure, such as `transfer/bit_torque`, at a time (s); null where there is none. */
  range(name: string, time: number): Range | null {
    const column = 2 * this.names.indexOf(name);
    const index = this.figures?.before(time) ?? -1;
    if (!this.figures || column < 0 || index < 0 || time - this.figures.time(index) > HOLDS) return null;
    const [low, high] = [this.figures.value(index, column), this.figures.value(index, column + 1)];
    return Number.isFinite(low) && Number.isFinite(high) ? { low, high } : null;
  }

  /** The band of a figure between two times (s). */
  rows(name: string, from: number, to: number): BandRows {
    const column = 2 * this.names.indexOf(name);
    return column < 0 ? [[], [], []] : rows(this.figures, [column, column + 1], from, to);
  }

  /** The band of the force of a layer at a measured depth (m), between two times (s). */
  stationRows(layer: LayerOfForce, depth: number, from: number, to: number): BandRows {
    const count = this.depth.length;
    const station = count > 0 ? nearest(this.depth, depth) : -1;
    if (station < 0 || Math.abs(this.depth[station] - depth) > NEAR) return [[], [], []];
    const low = (layer === "pipe_guide" ? 0 : 2 * count) + station;
    return rows(this.profiles, [low, low + count], from, to);
  }
}

function rows(ring: Ring | null, columns: [number, number], from: number, to: number): BandRows {
  const [times, low, high]: BandRows = [[], [], []];
  if (!ring) return [times, low, high];
  const known = (value: number) => (Number.isFinite(value) ? value : null);
  for (let index = Math.max(0, ring.before(from)); index < ring.length && ring.time(index) <= to; index++) {
    times.push(ring.time(index));
    low.push(known(ring.value(index, columns[0])));
    high.push(known(ring.value(index, columns[1])));
  }
  return [times, low, high];
}
