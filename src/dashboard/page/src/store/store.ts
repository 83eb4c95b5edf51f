// What the page knows: the newest messages, an hour of seconds, a minute at full rate. Everything that grows is a ring.

import type { History, JournalEntry, Session } from "../api";
import { CdrReader } from "../cdr";
import type { Connection, Playback } from "../connection";
import {
  DECODERS,
  type AlarmEvent,
  type AlarmList,
  type BitState,
  type ContactForces,
  type Header,
  type JointDeflections,
  type MarkerArray,
  type SessionInfo,
  type TwinStatus,
  type WhirlState,
} from "../messages";
import { displacements, geometryOf, type Geometry } from "./geometry";
import { merged } from "./history";
import { Layout, type Counts } from "./layout";
import { Ring } from "./ring";
import { Second } from "./second";

/** Topics that the page listens to, without namespace. */
export const TOPICS = [
  "twin/status",
  "twin/session",
  "twin/alarms",
  "twin/alarm_events",
  "twin/bit_state",
  "twin/contact_forces",
  "twin/joint_deflections",
  "twin/whirl",
  "twin/tool_shape",
] as const;
export type Topic = (typeof TOPICS)[number];

/** Rows of an hour at one a second. */
const HOUR = 3600;
/** Rows of a minute at 50 Hz and at 10 Hz: what the place is drawn from. */
const QUICK = 3000;
const SHAPES = 600;
/** Most entries of the journal, and of alarm lists to drag back through. */
const JOURNAL = 2000;
const LISTS = 500;
/** Topics of which the newest holds, however old. */
const LATCHED: readonly string[] = ["twin/session", "twin/alarms"];
/**
 * Messages of a recording are of the player's time within this (s) and half a second of playing: it fetches those of up
 * to two seconds before a time that it is brought to.
 */
const FETCHED = 2.5;
/**
 * Time that goes back further than this (s) is another time: topics of a loaded machine come out of order by some
 * seconds, those of a recording hardly. A recording that leaps ahead is elsewhere too.
 */
const SET_BACK = 10;
const BAG_BACK = 0.5;
const BAG_AHEAD = 2;
/** Without a heartbeat for this long the twin is gone (ms): ten beats at 5 Hz, as in the terminal. */
export const SILENT = 2000;

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
  alarms: AlarmList | null = null;
  sessionInfo: SessionInfo | null = null;
  journal: JournalEntry[] = [];
  journalRevision = 0;
  /** Messages that were not understood: page and twin are of different versions. */
  unreadable = 0;

  layout: Layout | null = null;
  geometry: Geometry | null = null;
  hour = new Ring(1, 1);
  /** Time between its rows (s): that of a long recording is thinned. */
  period = 1;
  /** Per joint: y, z, stop moment. Per station: both peaks. Per station: pipe y, z, guide y, z. */
  joints = new Ring(1, 1);
  contacts = new Ring(1, 1);
  shapes = new Ring(1, 1);
  /** Counts what was added to the hour, and shapes; views redraw when they change. */
  hourRevision = 0;
  shapeRevision = 0;

  private cursorTime: number | null = null;
  private arrived = new Map<string, number>();
  private second: Second | null = null;
  private secondNumber = NaN;
  private newest = NaN;
  private lists: { time: number; list: AlarmList }[] = [];
  private firstContacts: ContactForces | null = null;
  private firstJoints: JointDeflections | null = null;
  private firstWhirl: WhirlState | null = null;
  private firstShape: MarkerArray | null = null;

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
    this.accept(topic as Topic, message);
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

  /** Takes a message that has been decoded. */
  accept(topic: Topic, message: unknown): void {
    this.arrived.set(topic, performance.now());
    switch (topic) {
      case "twin/status":
        return this.takeStatus(message as TwinStatus);
      case "twin/session":
        this.sessionInfo = message as SessionInfo;
        return;
      case "twin/alarms":
        return this.takeAlarms(message as AlarmList);
      case "twin/alarm_events":
        return this.takeEvent(message as AlarmEvent);
      case "twin/bit_state":
        return this.takeBit(message as BitState);
      case "twin/contact_forces":
        return this.takeContacts(message as ContactForces);
      case "twin/joint_deflections":
        return this.takeJoints(message as JointDeflections);
      case "twin/whirl":
        return this.takeWhirl(message as WhirlState);
      case "twin/tool_shape":
        return this.takeShape(message as MarkerArray);
    }
  }

  /** Time since a topic was last heard (ms); infinite before the first. */
  age(topic: Topic): number {
    const at = this.arrived.get(topic);
    return at === undefined ? Infinity : performance.now() - at;
  }

  /** The twin's heart does not beat, or nothing can be heard at all. */
  get silent(): boolean {
    if (this.session?.mode === "bag") return false;
    return !this.connected || this.age("twin/status") > SILENT;
  }

  get isBag(): boolean {
    return this.session?.mode === "bag";
  }

  /** Time that is looked back to (s); null is the newest. With a bag the player's time is the cursor. */
  get cursor(): number | null {
    return this.cursorTime;
  }

  /** Newest time on the rig's clock (s), NaN before the first message. */
  get now(): number {
    return this.newest;
  }

  /** Where the hour or the bag begins and ends (s). */
  get span(): [number, number] {
    const bag = this.session?.bag;
    if (bag) return [Number(BigInt(bag.start_ns)) / 1e9, Number(BigInt(bag.end_ns)) / 1e9];
    // Never shorter than ten minutes: a young hour would be all bars.
    const first = this.hour.length > 0 ? this.hour.time(0) : this.newest;
    return [Math.min(first, this.newest - 600), this.newest];
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
    return this.cursorTime ?? this.newest;
  }

  /** The tool as it was at the shown time; null until enough has been heard. */
  moment(): Moment | null {
    const { layout, second } = this;
    if (!layout || !second) return null;
    if (this.cursorTime !== null) {
      if (this.hour.length === 0) return null;
      const at = Math.max(0, this.hour.before(this.cursorTime));
      return { time: this.hour.time(at), live: false, layout, row: this.hour.row(at) };
    }
    return { time: this.newest, live: true, layout, row: second.live() };
  }

  /** Alarms as they stood at the shown time; null when that is not known. */
  alarmsShown(): AlarmList | null {
    if (this.cursorTime === null) return this.alarms;
    let found: AlarmList | null = null;
    for (const { time, list } of this.lists) {
      if (time > this.cursorTime) break;
      found = list;
    }
    return found;
  }

  /** Takes the server's hour, older than what has been heard here; with a bag all of it. */
  takeHistory(history: History): void {
    const layout = this.layout;
    if (!layout) return;
    const own = this.isBag ? null : this.hour;
    this.hour = merged(history, layout, own, HOUR);
    this.period = this.isBag ? Math.max(1, history.head.period_s || 1) : 1;
    this.hourRevision++;
  }

  takeJournal(events: JournalEntry[]): void {
    const known = new Set(events.map((event) => event.sequence));
    this.journal = [...events, ...this.journal.filter((event) => !known.has(event.sequence))].slice(-JOURNAL);
    this.journalRevision++;
  }

  takePlayback(playback: Playback): void {
    this.playback = playback;
  }

  private takeStatus(status: TwinStatus): void {
    this.status = status;
    const second = this.begin(status.header);
    if (!second) return;
    second.set("state", status.state);
    second.set("real_time_factor", status.real_time_factor);
    second.set("model_quality", status.model_quality);
    status.input_name.forEach((name, index) => {
      const input = name === "rotary_speed" ? "rotary_speed" : "weight_on_bit";
      second.set(`${input}_state`, status.input_state[index]);
      second.set(`${input}_received`, status.input_received[index]);
      second.set(`${input}_applied`, status.input_applied[index]);
    });
  }

  private takeAlarms(list: AlarmList): void {
    const last = this.alarms;
    // Of a latched topic old samples may come too: the highest sequence holds, then the newest.
    if (last && !this.isBag && stamp(list.header) < stamp(last.header) && list.sequence <= last.sequence) return;
    this.alarms = list;
    if (!last || last.sequence !== list.sequence) {
      this.lists.push({ time: stamp(list.header), list });
      if (this.lists.length > LISTS) this.lists.shift();
    }
    const active = list.alarms.filter((alarm) => alarm.state >= 1 && alarm.state <= 3);
    this.second?.set("unacknowledged_alarms", list.unacknowledged);
    this.second?.set("worst_alarm_priority", Math.max(0, ...active.map((alarm) => alarm.priority)));
  }

  private takeEvent(event: AlarmEvent): void {
    if (this.journal.some((entry) => entry.sequence === event.sequence)) return;
    const { sec, nanosec } = event.header.stamp;
    this.journal.push({ ...event, stamp_ns: (BigInt(sec) * 1_000_000_000n + BigInt(nanosec)).toString() });
    if (this.journal.length > JOURNAL) this.journal.shift();
    this.journalRevision++;
  }

  private takeBit(bit: BitState): void {
    const second = this.begin(bit.header);
    if (!second) return;
    second.means({ bit_speed_mean: bit.rotary_speed, bit_torque_mean: bit.torque });
    second.smallest("bit_speed_min", bit.rotary_speed);
    second.largest("bit_speed_max", bit.rotary_speed);
    second.largest("bit_torque_max", bit.torque);
    second.largest("stick_slip_index", bit.stick_slip_index);
    second.largest("stick_slip_severity", bit.stick_slip_severity);
  }

  private takeContacts(contacts: ContactForces): void {
    this.firstContacts ??= contacts;
    const second = this.begin(contacts.header);
    const stations = this.layout?.counts.stations ?? 0;
    if (!second) return;
    if (contacts.measured_depth.length !== stations) return this.forget();
    second.largest("max_pipe_guide_force", contacts.max_pipe_guide_force);
    second.largest("max_guide_wall_force", contacts.max_guide_wall_force);
    second.largest("shock_severity", contacts.shock_severity);
    second.setAll("contact_state", contacts.state);
    const quick = this.contacts.push(stamp(contacts.header));
    for (let station = 0; station < stations; station++) {
      second.largest("pipe_guide_normal_peak", contacts.pipe_guide_normal_peak[station], station);
      second.largest("guide_wall_normal_peak", contacts.guide_wall_normal_peak[station], station);
      quick[station] = contacts.pipe_guide_normal_peak[station];
      quick[stations + station] = contacts.guide_wall_normal_peak[station];
    }
  }

  private takeJoints(joints: JointDeflections): void {
    this.firstJoints ??= joints;
    const second = this.begin(joints.header);
    const count = this.layout?.counts.joints ?? 0;
    if (!second) return;
    if (joints.measured_depth.length !== count) return this.forget();
    second.largest("max_bend_angle", joints.max_bend_angle);
    second.largest("joints_at_limit", joints.joints_at_limit);
    second.setAll("joint_lateral_y", joints.lateral_y);
    second.setAll("joint_lateral_z", joints.lateral_z);
    const quick = this.joints.push(stamp(joints.header));
    for (let joint = 0; joint < count; joint++) {
      second.largest("joint_bend_angle", joints.bend_angle[joint], joint);
      second.largest("joint_stop_moment", joints.stop_moment[joint], joint);
      quick[joint] = joints.lateral_y[joint];
      quick[count + joint] = joints.lateral_z[joint];
      quick[2 * count + joint] = joints.stop_moment[joint];
    }
  }

  private takeWhirl(whirl: WhirlState): void {
    this.firstWhirl ??= whirl;
    const second = this.begin(whirl.header);
    if (!second) return;
    if (whirl.measured_depth.length !== this.layout?.counts.watched) return this.forget();
    second.setAll("whirl_kind", whirl.kind);
    second.setAll("whirl_severity", whirl.severity);
    second.setAll("whirl_ratio", whirl.whirl_ratio);
    second.setAll("clearance_ratio", whirl.clearance_ratio);
    second.setAll("contact_duty", whirl.contact_duty);
  }

  private takeShape(shape: MarkerArray): void {
    this.firstShape ??= shape;
    const header = shape.markers[0]?.header;
    const second = header ? this.begin(header) : null;
    const { geometry, layout } = this;
    if (!second || !geometry || !layout || !header) return;
    const stations = layout.counts.stations;
    const quick = this.shapes.push(stamp(header)).fill(NaN);
    displacements(shape, geometry, this.session?.tool?.exaggeration || 10, (body, station, across, low) => {
      const first = body === "pipe" ? 0 : 2 * stations;
      quick[first + station] = across;
      quick[first + stations + station] = low;
      second.setAt(body === "pipe" ? "pipe_y" : "guide_y", station, across);
      second.setAt(body === "pipe" ? "pipe_z" : "guide_z", station, low);
    });
    this.shapeRevision++;
  }

  /** Takes note of a message's time; gives the running second once the tool is known. */
  private begin(header: Header): Second | null {
    const time = stamp(header);
    if (!this.layout) this.build();
    const second = this.second;
    if (!second) return null;
    const back = this.newest - time;
    if (back > (this.isBag ? BAG_BACK : SET_BACK) || (this.isBag && -back > BAG_AHEAD)) this.rewind(time);
    this.newest = Number.isNaN(this.newest) ? time : Math.max(this.newest, time);
    const number = Math.floor(time);
    if (Number.isNaN(this.secondNumber)) this.secondNumber = number;
    if (number > this.secondNumber) this.endSecond(second, number);
    return second;
  }

  /** Time went back, or a bag was brought elsewhere: what is at hand belongs to another time. */
  private rewind(time: number): void {
    this.newest = time;
    this.secondNumber = Math.floor(time);
    this.second?.clear();
    this.joints.clear();
    this.contacts.clear();
    this.shapes.clear();
    if (this.isBag) return;
    this.hour.clear();
    this.lists = [];
    this.cursorTime = null;
    this.hourRevision++;
  }

  private endSecond(second: Second, number: number): void {
    if (!this.isBag) {
      second.set("time", 0);
      this.hour.push(this.secondNumber + 1).set(second.row);
      // A gap: the twin was away.
      if (number > this.secondNumber + 2) this.hour.push(number - 1).fill(NaN);
      this.hourRevision++;
    }
    this.secondNumber = number;
    second.end();
  }

  /** Another tool: all that is known is of the last one. */
  private forget(): void {
    this.layout = null;
    this.geometry = null;
    this.second = null;
    this.firstContacts = this.firstJoints = this.firstWhirl = null;
    this.firstShape = null;
    this.newest = this.secondNumber = NaN;
    this.cursorTime = null;
    this.lists = [];
    this.hourRevision++;
  }

  /** Makes room for a tool once one of each message has said how large it is. */
  private build(): void {
    const [contacts, joints, whirl, shape] = [this.firstContacts, this.firstJoints, this.firstWhirl, this.firstShape];
    if (!contacts || !joints || !whirl || !shape) return;
    const counts: Counts = {
      stations: contacts.measured_depth.length,
      joints: joints.measured_depth.length,
      watched: whirl.measured_depth.length,
    };
    this.layout = new Layout(counts);
    this.second = new Second(this.layout);
    this.hour = new Ring(HOUR, this.layout.stride);
    this.joints = new Ring(QUICK, 3 * counts.joints);
    this.contacts = new Ring(QUICK, 2 * counts.stations);
    this.shapes = new Ring(SHAPES, 4 * counts.stations);
    this.geometry = geometryOf({ contacts, joints, whirl, shape });
  }
}

/** A header's time (s). */
export function stamp(header: Header): number {
  return header.stamp.sec + header.stamp.nanosec * 1e-9;
}
