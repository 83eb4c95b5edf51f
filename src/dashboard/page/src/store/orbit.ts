// Motion from before the last minute: the server keeps three seconds of every ten, and the page asks for what it shows.

import type { Orbit } from "../api";
import type { Motion } from "../views/orbit";

/** Time between two windows of the server (s). */
export const EVERY = 10;

type Ask = (joint: number, time: number) => Promise<Orbit | null>;

export class PastOrbit {
  private wanted = "";
  private known: Motion | null = null;
  private asking = false;

  constructor(private readonly ask: Ask) {}

  /** The motion of a joint at a time (s): null where the server has none, undefined while that is not known. */
  at(joint: number, time: number): Motion | null | undefined {
    const wanted = `${joint} ${Math.floor(time / EVERY)}`;
    if (wanted === this.wanted) return this.asking ? undefined : this.known;
    // One question at a time, however fast somebody drags.
    if (this.asking) return undefined;
    this.wanted = wanted;
    this.asking = true;
    void this.ask(joint, time).then((orbit) => {
      this.known = orbit && motion(orbit);
      this.asking = false;
    });
    return undefined;
  }
}

function motion(orbit: Orbit): Motion {
  const from = Number(BigInt(orbit.from_ns)) / 1e9;
  return { times: orbit.times_s.map((time) => from + time), y: orbit.y_m, z: orbit.z_m };
}
