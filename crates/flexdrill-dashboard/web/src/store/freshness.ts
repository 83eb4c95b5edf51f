// How old the data on the page are, by the server's clock: the page's own time of processing says nothing about messages
// that waited in a queue before it.

import type { Pulse } from "../api";

/** Without an answer of the server for this long (ms) the age of the data is not known: six questions. */
const UNCONFIRMED = 3000;

/** The newest message of a topic that the page has processed. */
interface Taken {
  /** Instant that it speaks of (ns since 1970). */
  time: bigint;
  /** When the page processed it (ms, the page's clock). */
  at: number;
}

/** The newest message of a topic that the server has. */
interface Newest {
  time: bigint;
  /** When it arrived at the server, or a little earlier (ms, the page's clock). */
  arrived: number;
}

export class Freshness {
  private readonly taken = new Map<string, Taken>();
  private newest = new Map<string, Newest>();
  /** When the newest answer was asked for, and when it came (ms, the page's clock). */
  private asked = NaN;
  private answered = NaN;
  /** When the connection began (ms). */
  private begun = Infinity;

  /** The page has processed a message. */
  take(topic: string, time: bigint, now: number): void {
    this.taken.set(topic, { time, at: now });
  }

  /** The server has answered at `answered` a question that was asked at `asked` (ms, the page's clock). */
  hear(pulse: Pulse, asked: number, answered: number): void {
    this.asked = asked;
    this.answered = answered;
    // The question's time, not the answer's: ages err towards old.
    this.newest = new Map(
      Object.entries(pulse.newest).map(([topic, { time_ns, age_s }]) => [
        topic,
        { time: BigInt(time_ns), arrived: asked - 1e3 * age_s },
      ]),
    );
  }

  /** A connection begins: nothing has come over it. */
  begin(now: number): void {
    this.taken.clear();
    this.begun = now;
  }

  /** Age of what the page shows of a topic (ms); infinite before the first message. */
  age(topic: string, now: number): number {
    const taken = this.taken.get(topic);
    if (!taken) return Infinity;
    const since = now - taken.at;
    const newest = this.newest.get(topic);
    // What is newer than the server's answer arrived at the server after the question.
    if (!newest || taken.time > newest.time) return since;
    return Math.max(since, now - newest.arrived + Number(newest.time - taken.time) / 1e6);
  }

  /** Time since the server heard a topic (ms), whatever the page has processed; infinite when it never did. */
  serverAge(topic: string, now: number): number {
    const taken = this.taken.get(topic);
    const newest = this.newest.get(topic);
    if (!newest) return taken ? now - taken.at : Infinity;
    if (taken && taken.time > newest.time) return now - taken.at;
    return now - newest.arrived;
  }

  /** Newest instant of a topic at the server (s since 1970), NaN when it never heard it. */
  serverTime(topic: string): number {
    const newest = this.newest.get(topic);
    return newest ? Number(newest.time) / 1e9 : NaN;
  }

  /**
   * How far the page is behind the server in these topics (ms): the largest, 0 while it keeps up. What the server heard
   * before the connection began does not come over it. Counted from the answer, not from the question: a slow answer is
   * not a page that is behind.
   */
  lag(topics: readonly string[], now: number): number {
    let most = 0;
    for (const topic of topics) {
      const newest = this.newest.get(topic);
      if (!newest) continue;
      const taken = this.taken.get(topic);
      if (!taken) {
        if (newest.arrived > this.begun) most = Math.max(most, now - this.begun);
      } else if (newest.time > taken.time) {
        most = Math.max(most, Number(newest.time - taken.time) / 1e6 + now - this.answered);
      }
    }
    return most;
  }

  /** Time since the server last answered (ms) where that is too long to know any age; else 0. */
  unconfirmed(now: number): number {
    const since = now - this.asked;
    return since > UNCONFIRMED ? since : 0;
  }
}
