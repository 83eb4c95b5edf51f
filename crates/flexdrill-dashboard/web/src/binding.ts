// The binding of the page to one server: its data, the requests next to the live data, and when the page must restart.

import * as api from "./api";
import { Connection } from "./connection";
import type { Inbox } from "./store/inbox";
import type { Layout } from "./store/layout";
import type { Store } from "./store/store";
import { TOPICS } from "./store/topics";

/** Time between two questions to the server (ms). */
const ASK = 500;
/** How long a server that has just been started may take to hear the twin (ms). */
const DISCOVERY = 5000;

/** What a session is of: a run of a twin, or a recording; empty while that is not known. */
export function subject(session: api.Session): string {
  const { mode, namespace, node, start_ns, config_hash, bag } = session;
  if (bag) return JSON.stringify([mode, bag.name, bag.start_ns, bag.end_ns]);
  return start_ns ? JSON.stringify([mode, namespace, node, start_ns, config_hash]) : "";
}

/** What to do about a server that is not the one that the page is bound to. */
export function judge(
  known: api.Session | null,
  found: api.Session,
  waited: number,
  empty: boolean,
): "keep" | "wait" | "reload" {
  if (!known || known.instance === found.instance) return "keep";
  // The page of another version may decode other messages.
  if (known.version !== found.version || known.mode !== found.mode) return "reload";
  if (empty && subject(known) === "") return "keep";
  if (subject(found) === "") return waited < DISCOVERY ? "wait" : "reload";
  return subject(found) === subject(known) ? "keep" : "reload";
}

export class Binding {
  readonly connection: Connection;
  /** Counts connections: an answer to a question from before a connection says nothing about its server. */
  private generation = 0;
  private admitted = false;
  private waiting = NaN;
  private sessionTaken = false;
  private journalTaken = false;
  /** Layout that the server's hour was taken for. */
  private historyOf: Layout | null = null;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private asking = false;
  private refreshed = false;

  constructor(
    private readonly store: Store,
    inbox: Inbox,
    private readonly reload: () => void = () => location.reload(),
  ) {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.connection = new Connection(`${scheme}://${location.host}/live`, TOPICS, {
      onConnected: (connected) => {
        this.generation++;
        this.admitted = this.sessionTaken = this.journalTaken = false;
        this.historyOf = null;
        inbox.clear();
        store.setConnected(connected);
        if (connected) this.askNow();
      },
      onMessage: (topic, schema, time, data) => inbox.put(topic, schema, time, data),
      onPlayback: (playback) => store.takePlayback(playback),
    });
    document.addEventListener("visibilitychange", () => this.askNow());
    this.askNow();
  }

  private askNow(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    if (this.asking) return;
    this.asking = true;
    void this.ask().finally(() => {
      this.asking = false;
      this.timer = setTimeout(() => this.askNow(), ASK);
    });
  }

  private async ask(): Promise<void> {
    const { store, generation } = this;
    const asked = performance.now();
    const pulse = await api.pulse();
    if (!pulse || generation !== this.generation) return;
    if (!store.session || pulse.instance !== store.session.instance || !this.sessionTaken) {
      if (!(await this.bind(generation))) return;
    }
    store.takePulse(pulse, asked);
    if (!store.connected) return;
    if (!this.admitted) {
      this.admitted = true;
      this.connection.admit();
    }
    await this.fetch();
  }

  /** Adopts the session of the server if the page shows its data; otherwise the page restarts. */
  private async bind(generation: number): Promise<boolean> {
    const { store } = this;
    const found = await api.session();
    if (!found || generation !== this.generation) return false;
    if (Number.isNaN(this.waiting)) this.waiting = performance.now();
    const verdict = judge(store.session, found, performance.now() - this.waiting, store.layout === null);
    if (verdict === "wait") return false;
    this.waiting = NaN;
    if (verdict === "reload") {
      this.reload();
      return false;
    }
    store.session = found;
    this.sessionTaken = true;
    api.bindTo(found.instance);
    return true;
  }

  /** Data that is not live: session, hour, journal; the state of a paused recording. */
  private async fetch(): Promise<void> {
    const { store } = this;
    const { session } = store;
    const changed =
      session?.config_hash !== undefined && store.status && store.status.config_hash !== session.config_hash;
    if (!session?.limits || !session.tool || changed || (session.bag && !session.bag.ready)) {
      const found = await api.session();
      if (found && found.instance === session?.instance) store.session = found;
    }
    if (this.historyOf === null || this.historyOf !== store.layout) {
      const history = await api.history();
      if (history) {
        store.takeHistory(history);
        this.historyOf = history.head.complete !== false ? store.layout : null;
      }
    }
    if (!this.journalTaken) {
      // The journal of a bag that is being read lacks what stands further on in it.
      const isWhole = store.session?.bag?.ready ?? true;
      const events = await api.journal();
      if (events) {
        store.takeJournal(events);
        this.journalTaken = store.layout !== null && isWhole;
      }
    }
    const { playback } = store;
    // A player that stands sends nothing; brought to where it is, it sends what stands there.
    if (store.isBag && playback?.reported && !playback.playing && !store.hasLive && !this.refreshed) {
      this.refreshed = true;
      this.connection.play(false, playback.speed, playback.time);
    }
  }
}
