// The motion of a location: of the last minute from what was heard; from before, three seconds of every ten from the server,
// which is asked for what is shown.

import type { Orbit } from "../api";
import type { Ring } from "./ring";

/** Points of a motion with their times, oldest first; y to the right, z down (m). */
export interface Motion {
  times: number[];
  y: number[];
  z: number[];
}

/** Two columns of a ring over the last `span` before a time (s). */
export function heard(ring: Ring, y: number, z: number, to: number, span: number): Motion {
  const out: Motion = { times: [], y: [], z: [] };
  for (let index = Math.max(0, ring.before(to - span)); index < ring.length; index++) {
    const time = ring.time(index);
    if (time > to) break;
    if (time < to - span) continue;
    out.times.push(time);
    out.y.push(ring.value(index, y));
    out.z.push(ring.value(index, z));
  }
  return out;
}

/** Time between two windows of the server (s). */
const EVERY = 10;

type Ask = (joint: number, time: number) => Promise<Orbit | null>;

export class PastMotion {
  private wanted = "";
  private known: Motion | null = null;
  private asking = false;

  constructor(private readonly ask: Ask) {}

  /** The motion of a joint at a time (s): null where the server has none, undefined while that is not known. */
  at(joint: number, time: number): Motion | null | undefined {
    const wanted = `${joint} ${Math.floor(time / EVERY)}`;
    if (wanted === this.wanted) return this.asking ? undefined : this.known;
    // One request at a time, however fast the operator drags.
    if (this.asking) return undefined;
    this.wanted = wanted;
    this.asking = true;
    void this.ask(joint, time).then((orbit) => {
      this.known = orbit && ofServer(orbit);
      this.asking = false;
    });
    return undefined;
  }
}

function ofServer(orbit: Orbit): Motion {
  const from = Number(BigInt(orbit.from_ns)) / 1e9;
  return { times: orbit.times_s.map((time) => from + time), y: orbit.y_m, z: orbit.z_m };
}
