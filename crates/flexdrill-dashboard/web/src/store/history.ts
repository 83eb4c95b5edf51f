// The server's hour and what the page has heard itself, as one.

import type { History } from "../api";
import type { Layout } from "./layout";
import { Ring } from "./ring";

/** Rows nearer than this (s) are of the same second. */
const SAME = 0.6;

/**
 * A ring of the server's frames and the page's own seconds, in time. Where both have a second, the page's own holds; where
 * neither has anything for longer than two and a half periods, a row without values says so. Columns are found by their
 * names; what the server does not have is NaN.
 */
export function merged(history: History, layout: Layout, own: Ring | null, capacity: number): Ring {
  const { head, values } = history;
  const base = Number(BigInt(head.base_ns)) / 1e9;
  const timeColumn = head.columns.find(({ name }) => name === "time")?.offset ?? 0;
  const state = layout.offset("state");
  const heard: { time: number; index: number }[] = [];
  for (let index = 0; own && index < own.length; index++) {
    const gap = Number.isNaN(own.value(index, state)) && own.row(index).every(Number.isNaN);
    if (!gap) heard.push({ time: own.time(index), index });
  }
  const ring = new Ring(capacity, layout.stride);
  const most = 2.5 * (head.period_s || 1);
  let last = NaN;
  const add = (time: number): Float32Array => {
    if (time - last > most) ring.push(last + 1).fill(NaN);
    last = time;
    return ring.push(time).fill(NaN);
  };
  let next = 0;
  const addHeard = (before: number): void => {
    for (; own && next < heard.length && heard[next].time <= before; next++) {
      add(heard[next].time).set(own.row(heard[next].index));
    }
  };
  for (let frame = 0; frame < head.count; frame++) {
    const from = frame * head.stride;
    const time = base + values[from + timeColumn];
    if (!Number.isFinite(time)) continue;
    addHeard(time + SAME);
    if (time <= last + SAME || time < ring.time(ring.length - 1)) continue;
    const row = add(time);
    for (const { name, offset, length } of head.columns) {
      const ours = layout.find(name);
      if (ours?.length === length) row.set(values.subarray(from + offset, from + offset + length), ours.offset);
    }
  }
  addHeard(Infinity);
  return ring;
}
