// What the page knows: the newest messages, the tool's motion, alarms and journal, and the time that is looked at.

import type { History, JournalEntry, Pulse, Session } from "../api";
import { CdrReader } from "../cdr";
import type { Connection, Playback } from "../connection";
import {
  DECODERS,
  type Ageing,
  type AlarmEvent,
  type AlarmList,
  type AppliedInputs,
  type Bands,
  type BitState,
  type ContactForces,
  type Forecast,
  type HoleAhead,
  type JointDeflections,
  type MarkerArray,
  type Residuals,
  type SafeWindow,
  type SessionInfo,
  type Transfer,
  type TwinStatus,
  type WhirlState,
} from "../messages";
import { AlarmBook } from "./alarms";
import { BandBook } from "./bands";
import { Freshness } from "./freshness";
import type { Geometry } from "./geometry";
import type { Layout } from "./layout";
import type { Ring } from "./ring";
import { instant, MOTION, stamp, type Topic } from "./topics";
import { Trace } from "./trace";

/** Topics of which the newest holds, however old. */
const LATCHED: readonly string[] = ["twin/session", "twin/alarms", "twin/forecast", "twin/safe_window"];
/** Forecasts that are kept: what came is shown against those of the last minutes. */
const FORECASTS = 6;
/** An answer of the hole ahead is of the present for this long after its stamp (s): it takes some seconds to compute. */
const HOLE_HOLDS = 15;
/** Comparisons of rig and twin that are kept: ten minutes at one per second, and some more. */
const RESIDUALS = 640;
/**
 * Messages of a recording are of the player's time within this (s) and half a second of playing: it fetches those of up
 * to two seconds before a time that it is brought to.
 */
const FETCHED = 2.5;
/** Without a heartbeat for this long the twin is gone (ms): ten beats at 5 Hz, as in the terminal. */
export const SILENT = 2000;
/** A page that is this far behind the server (ms) says so until it has caught up to the second bound. */
const BEHIND = 2000;
const CAUGHT_UP = 1000;

/** The tool at one instant. */
export interface Moment {
  /** On the rig's clock (s since 1970). */
  time: number;
  /** The newest there is. */
  live: boolean;
  layout: Layout;
  row: Float32Array;
}

export class Store {
  connected = false;
  connection: Connection | null = null;
  session: Session | null = null;
  playback: Playback | null = null;

  status: TwinStatus | null = null;
  sessionInfo: SessionInfo | null = null;
  transfer: Transfer | null = null;
  /** What drives the model. */
  applied: AppliedInputs | null = null;
  /** The map of speed and weight that the twin has loaded. */
  safeWindow: SafeWindow | null = null;
  /** The newest forecasts, the oldest first. */
  forecasts: Forecast[] = [];
  /** The newest comparisons of rig and twin, the oldest first. */
  residuals: Residuals[] = [];
  /** The newest answer where the tool drills; null where none has ever come. */
  hole: HoleAhead | null = null;
  /** The newest ageing of the joints; null where none has ever come. */
  ageing: Ageing | null = null;
  /** What plausible tools do. */
  readonly bands = new BandBook();
  /** Messages that were not understood: page and twin are of different versions. */
  unreadable = 0;

  private readonly book = new AlarmBook();
  private readonly trace = new Trace(this, () => {
    this.book.forgetPast();
    this.bands.clear();
    this.hole = null;
    this.ageing = null;
    this.cursorTime = null;
  });
  private cursorTime: number | null = null;
  private readonly freshness = new Freshness();
  private isBehind = false;

  get layout(): Layout | null {
    return this.trace.layout;
  }

  get geometry(): Geometry | null {
    return this.trace.geometry;
  }

  /** Rows of the hour, a second each or the time of `period`; rings at full rate, as the trace has them. */
  get hour(): Ring {
    return this.trace.hour;
  }

  get period(): number {
    return this.trace.period;
  }

  get joints(): Ring {
    return this.trace.joints;
  }

  get contacts(): Ring {
    return this.trace.contacts;
  }

  get shapes(): Ring {
    return this.trace.shapes;
  }

  get hourRevision(): number {
    return this.trace.hourRevision;
  }

  get shapeRevision(): number {
    return this.trace.shapeRevision;
  }

  get alarms(): AlarmList | null {
    return this.book.newest;
  }

  get journal(): JournalEntry[] {
    return this.book.journal;
  }

  get journalRevision(): number {
    return this.book.journalRevision;
  }

  /** Takes one message of that time (ns), which with a recording is that of the recording. */
  take(topic: string, schema: string, time: bigint, data: DataView): void {
    if (!this.isOfNow(topic, time)) return;
    const decode = DECODERS[schema as keyof typeof DECODERS];
    if (!decode) return;
    let message;
    try {
      message = decode(new CdrReader(data));
    } catch {
      this.unreadable++;
      return;
    }
    this.accept(topic as Topic, message, time);
  }

  /**
   * Whether a message belongs to where the player is: what was on its way when the player was brought elsewhere does not.
   * Latched topics keep the time at which they were sent.
   */
  private isOfNow(topic: string, time: bigint): boolean {
    if (!this.isBag || !this.playback || LATCHED.includes(topic)) return true;
    const away = Math.abs(Number(time - this.playback.time)) / 1e9;
    return away <= FETCHED + this.playback.speed / 2;
  }

  /** Takes a message that has been decoded, of that time (ns). */
  accept(topic: Topic, message: unknown, time: bigint = instant(message)): void {
    const { trace, book } = this;
    this.freshness.take(topic, time, performance.now());
    switch (topic) {
      case "twin/status":
        this.status = message as TwinStatus;
        return trace.takeStatus(this.status);
      case "twin/session":
        this.sessionInfo = message as SessionInfo;
        return;
      case "twin/alarms":
        if (book.take(message as AlarmList, this.isBag)) trace.takeAlarms(message as AlarmList);
        return;
      case "twin/alarm_events":
        return book.takeEvent(message as AlarmEvent);
      case "twin/bit_state":
        return trace.takeBit(message as BitState);
      case "twin/contact_forces":
        return trace.takeContacts(message as ContactForces);
      case "twin/joint_deflections":
        return trace.takeJoints(message as JointDeflections);
      case "twin/whirl":
        return trace.takeWhirl(message as WhirlState);
      case "twin/transfer":
        this.transfer = message as Transfer;
        return;
      case "twin/applied_inputs":
        this.applied = message as AppliedInputs;
        return;
      case "twin/safe_window":
        this.safeWindow = message as SafeWindow;
        return;
      case "twin/forecast":
        return this.takeForecast(message as Forecast);
      case "twin/bands":
        return this.bands.take(message as Bands);
      case "twin/hole_ahead":
        this.hole = message as HoleAhead;
        return;
      case "twin/ageing":
        this.ageing = message as Ageing;
        return;
      case "twin/residuals":
        return this.takeResiduals(message as Residuals);
      case "twin/tool_shape":
        return trace.takeShape(message as MarkerArray);
    }
  }

  /** Keeps the newest forecasts in the order of their states: after a jump of the player, or of a new run, only this one. */
  private takeForecast(forecast: Forecast): void {
    const before = this.forecasts.filter((kept) => stamp(kept.header) < stamp(forecast.header));
    this.forecasts = [...before.slice(1 - FORECASTS), forecast];
  }

  /** Keeps the newest comparisons in the order of their times: after a jump back, those before it. */
  private takeResiduals(residuals: Residuals): void {
    const time = stamp(residuals.header);
    const last = this.residuals[this.residuals.length - 1];
    if (last && stamp(last.header) >= time) this.residuals = this.residuals.filter((kept) => stamp(kept.header) < time);
    this.residuals.push(residuals);
    if (this.residuals.length > RESIDUALS) this.residuals.shift();
  }

  /** Takes the server's answer to a question that was asked at `asked` (ms). */
  takePulse(pulse: Pulse, asked: number): void {
    this.freshness.hear(pulse, asked, performance.now());
  }

  /** The connection has come or gone. */
  setConnected(connected: boolean): void {
    this.connected = connected;
    this.freshness.begin(connected ? performance.now() : Infinity);
    this.isBehind = false;
  }

  /** Age of what the page shows of a topic by the server's clock (ms); infinite before the first message. */
  age(topic: Topic): number {
    return this.freshness.age(topic, performance.now());
  }

  /** Time since the server heard the twin (ms); infinite when it never did. */
  get twinAge(): number {
    return this.freshness.serverAge("twin/status", performance.now());
  }

  /** When the server heard the twin last, on the rig's clock (s); NaN when it never did. */
  get lastHeard(): number {
    return this.freshness.serverTime("twin/status");
  }

  /** How far the page is behind the server's newest data (ms); 0 while it keeps up. */
  get lag(): number {
    if (this.isBag || !this.connected) return 0;
    const lag = this.freshness.lag(MOTION, performance.now());
    this.isBehind = lag > (this.isBehind ? CAUGHT_UP : BEHIND);
    return this.isBehind ? lag : 0;
  }

  /** For how long the server has not confirmed how old the data are (ms); 0 while it does. */
  get unconfirmed(): number {
    return this.isBag ? 0 : this.freshness.unconfirmed(performance.now());
  }

  /** The twin's heart does not beat, or nothing can be heard at all. */
  get silent(): boolean {
    if (this.session?.mode === "bag") return false;
    return !this.connected || this.twinAge > SILENT;
  }

  /** What is shown is the rig now: nothing keeps it from being acted on. */
  get isLive(): boolean {
    return !this.isBag && this.cursorTime === null && !this.silent && this.lag === 0 && this.unconfirmed === 0;
  }

  get isBag(): boolean {
    return this.session?.mode === "bag";
  }

  /** Time that is looked back to (s); null is the newest. With a bag the player's time is the cursor. */
  get cursor(): number | null {
    return this.cursorTime;
  }

  /** Newest time on the rig's clock (s), NaN while none is known. */
  get now(): number {
    if (!Number.isNaN(this.trace.newest)) return this.trace.newest;
    // Nothing of the tool has come: a recording is where its player is, a twin that has ended where its hour ends.
    if (this.isBag) return this.playback ? Number(this.playback.time) / 1e9 : this.span[0];
    return this.hour.length > 0 ? this.hour.time(this.hour.length - 1) : NaN;
  }

  /** Messages of the tool have come, not only the server's hour. */
  get hasLive(): boolean {
    return this.trace.hasLive;
  }

  /** Where the hour or the bag begins and ends (s). */
  get span(): [number, number] {
    const bag = this.session?.bag;
    if (bag) return [Number(BigInt(bag.start_ns)) / 1e9, Number(BigInt(bag.end_ns)) / 1e9];
    // Never shorter than ten minutes: a young hour would be all bars.
    const first = this.hour.length > 0 ? this.hour.time(0) : this.now;
    return [Math.min(first, this.now - 600), this.now];
  }

  /** Looks at a time (s), or at the newest; a bag is brought there. */
  lookAt(time: number | null): void {
    if (this.isBag) {
      if (time === null || !this.playback) return;
      const [start, end] = this.span;
      const at = BigInt(Math.round(Math.min(Math.max(time, start), end) * 1e6)) * 1000n;
      this.connection?.play(this.playback.playing, this.playback.speed, at);
      this.playback = { ...this.playback, time: at };
      return;
    }
    const [start, end] = this.span;
    this.cursorTime = time === null || time >= end - 0.5 ? null : Math.max(time, start);
  }

  /** Time that all views show (s). */
  get shown(): number {
    return this.cursorTime ?? this.now;
  }

  /** The tool as it was at the shown time; null until enough has been heard. */
  moment(): Moment | null {
    const { layout } = this;
    if (!layout) return null;
    const row = this.cursorTime === null ? this.trace.live() : null;
    if (row) return { time: this.now, live: true, layout, row };
    if (this.hour.length === 0) return null;
    const at = Math.max(0, this.hour.before(this.shown));
    return { time: this.hour.time(at), live: false, layout, row: this.hour.row(at) };
  }

  /** Alarms as they stood at the shown time; null when that is not known. */
  alarmsShown(): AlarmList | null {
    return this.cursorTime === null ? this.alarms : this.book.at(this.cursorTime);
  }

  /** What plausible tools do at present; null where that is not known, or the views show the past. */
  get plausible(): Bands | null {
    return this.cursorTime === null && !this.silent ? this.bands.fresh(this.now) : null;
  }

  /** Where the tool drills; null where that is not of the present, or the views show the past. */
  get holeNow(): HoleAhead | null {
    if (!this.hole || this.cursorTime !== null || this.silent) return null;
    const age = this.now - stamp(this.hole.header);
    return age <= HOLE_HOLDS && age > -1 ? this.hole : null;
  }

  /** Ageing of the joints; null where the views show the past or the twin is silent. */
  get ageingNow(): Ageing | null {
    return this.cursorTime === null && !this.silent ? this.ageing : null;
  }

  /** Takes the server's hour, older than what has been heard here; with a bag all of it. */
  takeHistory(history: History): void {
    this.trace.takeHistory(history);
  }

  takeJournal(events: JournalEntry[]): void {
    this.book.takeJournal(events);
  }

  takePlayback(playback: Playback): void {
    this.playback = playback;
  }
}
