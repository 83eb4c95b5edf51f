// Messages on their way to the store. A page that cannot keep up skips old ones undecoded: the newest counts.

/** A message that waited this long (ms) is skipped when a newer one of its topic has come. */
const LONGEST_WAIT = 500;
/** Longest stretch of decoding (ms), so that pictures and clicks come between. */
const STRETCH = 12;
/** Most messages that wait, of all topics together: 5 s of the default rates. */
const CAPACITY = 1000;

export interface Raw {
  topic: string;
  schema: string;
  time: bigint;
  data: DataView;
  /** When the browser handed it over (ms). */
  arrived: number;
}

export class Inbox {
  /** Messages that were skipped. */
  skipped = 0;
  private waiting: Raw[] = [];
  private scheduled = false;

  /**
   * `every` names topics of which no message may be skipped. `schedule` calls back soon, in a task of its own: not bound to
   * pictures, since a hidden page draws none.
   */
  constructor(
    private readonly every: readonly string[],
    private readonly hand: (message: Raw) => void,
    private readonly schedule: (task: () => void) => void = messageTask(),
    private readonly clock: () => number = () => performance.now(),
  ) {}

  put(topic: string, schema: string, time: bigint, data: DataView): void {
    this.waiting.push({ topic, schema, time, data, arrived: this.clock() });
    if (this.waiting.length > CAPACITY) this.skip(this.clock(), 0);
    if (this.scheduled) return;
    this.scheduled = true;
    this.schedule(() => this.drain());
  }

  /** The connection has ended: what waits is not shown. */
  clear(): void {
    this.waiting = [];
  }

  private drain(): void {
    this.scheduled = false;
    const begin = this.clock();
    this.skip(begin, LONGEST_WAIT);
    let next = 0;
    while (next < this.waiting.length && (next === 0 || this.clock() - begin < STRETCH))
      this.hand(this.waiting[next++]);
    this.waiting.splice(0, next);
    if (this.waiting.length === 0 || this.scheduled) return;
    this.scheduled = true;
    this.schedule(() => this.drain());
  }

  /** Leaves out what waited longer than `wait` and has a newer one of its topic behind it. */
  private skip(now: number, wait: number): void {
    if (this.waiting.length === 0 || now - this.waiting[0].arrived <= wait) return;
    const newest = new Map<string, Raw>();
    for (const message of this.waiting) newest.set(message.topic, message);
    const kept = this.waiting.filter(
      (message) =>
        now - message.arrived <= wait || this.every.includes(message.topic) || newest.get(message.topic) === message,
    );
    this.skipped += this.waiting.length - kept.length;
    this.waiting = kept;
  }
}

/** Tasks by messages: browsers hold timers of hidden pages back, not these. */
function messageTask(): (task: () => void) => void {
  const channel = new MessageChannel();
  const tasks: (() => void)[] = [];
  channel.port1.onmessage = () => tasks.shift()?.();
  return (task) => {
    tasks.push(task);
    channel.port2.postMessage(0);
  };
}
