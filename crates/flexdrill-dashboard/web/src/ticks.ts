// Where the marks of an axis are: of times on whole minutes and seconds, of values at 1, 2 and 5.

import { clock } from "./units";

const MINUTE = 60;
const HOUR = 3600;
/** Steps of a time axis (s): each divides the next larger unit. */
const TIME_STEPS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, HOUR, 2 * HOUR, 6 * HOUR, 12 * HOUR, 24 * HOUR];
/** Least distance of two labels (pixels): hours and minutes; with seconds. */
const ROOM = { minutes: 52, seconds: 72 };

export interface Tick {
  /** s since 1970. */
  time: number;
  label: string;
}

/** Step of a time axis of so many pixels (s). */
export function timeStep(from: number, to: number, width: number): number {
  const fits = (step: number) => ((to - from) / step) * (step < MINUTE ? ROOM.seconds : ROOM.minutes) <= width;
  return TIME_STEPS.find(fits) ?? Math.max(24 * HOUR, to - from);
}

/** Marks of a time axis, on whole steps of the local day. All axes of one range have the same ones. */
export function timeTicks(from: number, to: number, width: number): Tick[] {
  if (!(to > from) || !(width > 0)) return [];
  const step = timeStep(from, to, width);
  // Six-hour steps begin at local midnight.
  const offset = new Date(from * 1e3).getTimezoneOffset() * MINUTE;
  const first = Math.ceil((from - offset) / step) * step + offset;
  const ticks: Tick[] = [];
  for (let time = first; time <= to && ticks.length < 100; time += step) {
    ticks.push({ time, label: step < MINUTE ? clock(time) : clock(time).slice(0, 5) });
  }
  return ticks;
}

/** The next of 1, 2, 5, 10, 20, ... that is not below a value. */
export function roundUp(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const digit = value / power;
  return power * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
}

/** Values of an axis from `min` to `max`, at most `most` of them, on whole multiples of 1, 2 or 5. */
export function valueTicks(min: number, max: number, most: number): number[] {
  if (!(max > min) || most < 1) return [];
  const step = roundUp((max - min) / most);
  const ticks: number[] = [];
  for (let index = Math.ceil(min / step - 1e-9); index * step <= max + 1e-9 * step; index++) {
    // Products of decimal steps are rounded, or 0.3 would read 0.30000000000000004.
    ticks.push(Number((index * step).toPrecision(12)));
  }
  return ticks;
}
