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
import { Layout, type Counts, type Scalar, type Vector } from "./layout";
import { Ring } from "./ring";

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
/** Without a heartbeat for this long the twin is gone (ms): ten beats at 5 Hz, as in the terminal. */
export const SILENT = 2000;

/** Columns that keep the largest value of their second. */
const LARGEST: readonly (Scalar | Vector)[] = [
  "bit_speed_max",
  "bit_torque_max",
  "stick_slip_index",
  "stick_slip_severity",
  "max_pipe_guide_force",
  "max_guide_wall_force",
  "shock_severity",
  "max_bend_angle",
  "joints_at_limit",
  "joint_bend_angle",
  "joint_stop_moment",
  "pipe_guide_normal_peak",
  "guide_wall_normal_peak",
];

/** Where things are along the tool; does not change while a configuration runs. */
export interface Geometry {
  /** Measured depth of stations (m), their inclination (rad) and place in the world (x, y, z each, m). */
  stationDepth: Float64Array;
  stationInclination: Float64Array;
  stationPosition: Float32Array;
  /** Measured depth of joints (m), their station and the angle of their stop (rad). */
  jointDepth: Float64Array;
  jointStation: Int32Array;
  jointLimit: number;
  /** Measured depth of watched places (m), their body and station. */
  watchedDepth: Float64Array;
  watchedBody: Uint8Array;
  watchedStation: Int32Array;
}

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
  /** Per joint: y, z, stop moment. Per station: both peaks. Per station: pipe y, z, guide y, z. */
  joints = new Ring(1, 1);
  contacts = new Ring(1, 1);
  shapes = new Ring(1, 1);
  /** Counts what was added to the hour, and shapes; views redraw when they change. */
  hourRevision = 0;
  shapeRevision = 0;

  private cursorTime: number | null = null;
  private arrived = new Map<string, number>();
  private second = new Float32Array(0);
  private live = new Float32Array(0);
  private secondNumber = NaN;
  private speedSum = 0;
  private torqueSum = 0;
  private bitCount = 0;
  private newest = NaN;
  private lists: { time: number; list: AlarmList }[] = [];
  private firstContacts: ContactForces | null = null;
  private firstJoints: JointDeflections | null = null;
  private firstWhirl: WhirlState | null = null;
  private firstShape: MarkerArray | null = null;

  /** Takes one message. */
  take(topic: string, schema: string, data: DataView): void {
    const decode = DECODERS[schema as keyof typeof DECODERS];
    if (!decode) return;
    let message;
    try {
      message = decode(new CdrReader(data));
    } catch {
      this.unreadable++;
      return;
    }
    this.arrived.set(topic, performance.now());
    switch (topic as Topic) {
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
      const at = Math.min(Math.max(time, start), end);
      this.connection?.play(this.playback.playing, this.playback.speed, BigInt(Math.round(at * 1e6)) * 1000n);
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
    const layout = this.layout;
    if (!layout) return null;
    if (this.cursorTime !== null) {
      if (this.hour.length === 0) return null;
      const at = Math.max(0, this.hour.before(this.cursorTime));
      return { time: this.hour.time(at), live: false, layout, row: this.hour.row(at) };
    }
    this.refreshLive(layout);
    return { time: this.newest, live: true, layout, row: this.live };
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
    const column = new Map(history.head.columns.map((entry) => [entry.name, entry]));
    const length = (name: string) => column.get(name)?.length ?? 0;
    if (!this.layout) {
      this.build({ stations: length("pipe_y"), joints: length("joint_bend_angle"), watched: length("whirl_kind") });
    }
    const layout = this.layout;
    if (!layout) return;
    const base = Number(BigInt(history.head.base_ns)) / 1e9;
    const before = this.isBag || this.hour.length === 0 ? Infinity : this.hour.time(0) - 0.5;
    const hour = new Ring(HOUR, layout.stride);
    const timeColumn = column.get("time")?.offset ?? 0;
    for (let frame = 0; frame < history.head.count; frame++) {
      const from = frame * history.head.stride;
      const time = base + history.values[from + timeColumn];
      if (!Number.isFinite(time) || time >= before) continue;
      const row = hour.push(time).fill(NaN);
      for (const { name, offset, length } of history.head.columns) {
        const ours = layout.find(name);
        if (!ours || ours.length !== length) continue;
        row.set(history.values.subarray(from + offset, from + offset + length), ours.offset);
      }
    }
    if (!this.isBag) {
      for (let index = 0; index < this.hour.length; index++) hour.push(this.hour.time(index)).set(this.hour.row(index));
    }
    this.hour = hour;
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
    const layout = this.begin(status.header);
    if (!layout) return;
    const row = this.second;
    const set = (name: Scalar, value: number) => (row[layout.offset(name)] = value);
    set("state", status.state);
    set("real_time_factor", status.real_time_factor);
    set("model_quality", status.model_quality);
    status.input_name.forEach((name, index) => {
      const input = name === "rotary_speed" ? "rotary_speed" : "weight_on_bit";
      set(`${input}_state`, status.input_state[index]);
      set(`${input}_received`, status.input_received[index]);
      set(`${input}_applied`, status.input_applied[index]);
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
    const layout = this.layout;
    if (!layout) return;
    const active = list.alarms.filter((alarm) => alarm.state >= 1 && alarm.state <= 3);
    this.second[layout.offset("unacknowledged_alarms")] = list.unacknowledged;
    this.second[layout.offset("worst_alarm_priority")] = Math.max(0, ...active.map((alarm) => alarm.priority));
  }

  private takeEvent(event: AlarmEvent): void {
    if (this.journal.some((entry) => entry.sequence === event.sequence)) return;
    const { sec, nanosec } = event.header.stamp;
    this.journal.push({ ...event, stamp_ns: (BigInt(sec) * 1_000_000_000n + BigInt(nanosec)).toString() });
    if (this.journal.length > JOURNAL) this.journal.shift();
    this.journalRevision++;
  }

  private takeBit(bit: BitState): void {
    const layout = this.begin(bit.header);
    if (!layout) return;
    const row = this.second;
    this.speedSum += bit.rotary_speed;
    this.torqueSum += bit.torque;
    this.bitCount++;
    row[layout.offset("bit_speed_mean")] = this.speedSum / this.bitCount;
    row[layout.offset("bit_torque_mean")] = this.torqueSum / this.bitCount;
    smallest(row, layout.offset("bit_speed_min"), bit.rotary_speed);
    largest(row, layout.offset("bit_speed_max"), bit.rotary_speed);
    largest(row, layout.offset("bit_torque_max"), bit.torque);
    largest(row, layout.offset("stick_slip_index"), bit.stick_slip_index);
    largest(row, layout.offset("stick_slip_severity"), bit.stick_slip_severity);
  }

  private takeContacts(contacts: ContactForces): void {
    this.firstContacts ??= contacts;
    const layout = this.begin(contacts.header);
    if (!layout) return;
    if (contacts.measured_depth.length !== layout.counts.stations) return this.forget();
    const row = this.second;
    largest(row, layout.offset("max_pipe_guide_force"), contacts.max_pipe_guide_force);
    largest(row, layout.offset("max_guide_wall_force"), contacts.max_guide_wall_force);
    largest(row, layout.offset("shock_severity"), contacts.shock_severity);
    const pipeGuide = layout.offset("pipe_guide_normal_peak");
    const guideWall = layout.offset("guide_wall_normal_peak");
    const state = layout.offset("contact_state");
    const stations = layout.counts.stations;
    const quick = this.contacts.push(stamp(contacts.header));
    for (let station = 0; station < stations; station++) {
      largest(row, pipeGuide + station, contacts.pipe_guide_normal_peak[station]);
      largest(row, guideWall + station, contacts.guide_wall_normal_peak[station]);
      row[state + station] = contacts.state[station];
      quick[station] = contacts.pipe_guide_normal_peak[station];
      quick[stations + station] = contacts.guide_wall_normal_peak[station];
    }
  }

  private takeJoints(joints: JointDeflections): void {
    this.firstJoints ??= joints;
    const layout = this.begin(joints.header);
    if (!layout) return;
    const count = layout.counts.joints;
    if (joints.measured_depth.length !== count) return this.forget();
    const row = this.second;
    largest(row, layout.offset("max_bend_angle"), joints.max_bend_angle);
    largest(row, layout.offset("joints_at_limit"), joints.joints_at_limit);
    const quick = this.joints.push(stamp(joints.header));
    for (let joint = 0; joint < count; joint++) {
      largest(row, layout.offset("joint_bend_angle") + joint, joints.bend_angle[joint]);
      largest(row, layout.offset("joint_stop_moment") + joint, joints.stop_moment[joint]);
      row[layout.offset("joint_lateral_y") + joint] = joints.lateral_y[joint];
      row[layout.offset("joint_lateral_z") + joint] = joints.lateral_z[joint];
      quick[joint] = joints.lateral_y[joint];
      quick[count + joint] = joints.lateral_z[joint];
      quick[2 * count + joint] = joints.stop_moment[joint];
    }
  }

  private takeWhirl(whirl: WhirlState): void {
    this.firstWhirl ??= whirl;
    const layout = this.begin(whirl.header);
    if (!layout) return;
    if (whirl.measured_depth.length !== layout.counts.watched) return this.forget();
    const set = (name: Vector, values: ArrayLike<number>) => this.second.set(values, layout.offset(name));
    set("whirl_kind", whirl.kind);
    set("whirl_severity", whirl.severity);
    set("whirl_ratio", whirl.whirl_ratio);
    set("clearance_ratio", whirl.clearance_ratio);
    set("contact_duty", whirl.contact_duty);
  }

  private takeShape(shape: MarkerArray): void {
    this.firstShape ??= shape;
    const header = shape.markers[0]?.header;
    const layout = header ? this.begin(header) : null;
    const geometry = this.geometry;
    if (!layout || !geometry || !header) return;
    const find = (name: string) => shape.markers.find((marker) => marker.ns === name)?.points ?? [];
    const [bore, pipe, guide] = [find("bore"), find("flexible_pipe"), find("guide_pipe")];
    const stations = layout.counts.stations;
    const factor = 1 / (this.session?.tool?.exaggeration || 10);
    if (bore.length !== stations || pipe.length !== stations || guide.length !== stations) return;
    const row = this.second;
    const quick = this.shapes.push(stamp(header));
    for (let station = 0; station < stations; station++) {
      const angle = geometry.stationInclination[station];
      const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
      [pipe, guide].forEach((body, index) => {
        const x = body[station].x - bore[station].x;
        const y = body[station].y - bore[station].y;
        const z = body[station].z - bore[station].z;
        const across = y * factor;
        const low = (sin * z - cos * x) * factor;
        quick[(2 * index) * stations + station] = across;
        quick[(2 * index + 1) * stations + station] = low;
        row[layout.offset(index === 0 ? "pipe_y" : "guide_y") + station] = across;
        row[layout.offset(index === 0 ? "pipe_z" : "guide_z") + station] = low;
      });
    }
    this.shapeRevision++;
  }

  /** Takes note of a message's time; gives the layout once it is known. */
  private begin(header: Header): Layout | null {
    const time = stamp(header);
    if (!this.layout) this.buildFromMessages();
    const layout = this.layout;
    if (!layout) return null;
    if (time < this.newest - 1 || (this.isBag && Math.abs(time - this.newest) > 2)) this.rewind(time);
    this.newest = Number.isNaN(this.newest) ? time : Math.max(this.newest, time);
    const number = Math.floor(time);
    if (Number.isNaN(this.secondNumber)) this.secondNumber = number;
    if (number > this.secondNumber) this.endSecond(layout, number);
    return layout;
  }

  /** Time went back, or a bag was brought elsewhere: what is at hand belongs to another time. */
  private rewind(time: number): void {
    this.newest = time;
    this.secondNumber = Math.floor(time);
    this.second.fill(NaN);
    this.joints.clear();
    this.contacts.clear();
    this.shapes.clear();
    if (this.isBag) return;
    this.hour.clear();
    this.lists = [];
    this.cursorTime = null;
    this.hourRevision++;
  }

  private endSecond(layout: Layout, number: number): void {
    if (!this.isBag) {
      const before = this.secondNumber;
      this.second[layout.offset("time")] = 0;
      this.hour.push(before + 1).set(this.second);
      // A gap: the twin was away.
      if (number > before + 2) this.hour.push(number - 1).fill(NaN);
      this.hourRevision++;
    }
    this.live.set(this.second);
    this.secondNumber = number;
    for (const name of LARGEST) {
      const column = layout.find(name);
      if (column) this.second.fill(NaN, column.offset, column.offset + column.length);
    }
    this.second[layout.offset("bit_speed_min")] = NaN;
    this.speedSum = this.torqueSum = this.bitCount = 0;
    this.ended.set(this.live);
  }

  /** The last whole second, for the largest values of a running one. */
  private ended = new Float32Array(0);

  private refreshLive(layout: Layout): void {
    this.live.set(this.second);
    for (const name of LARGEST) {
      const column = layout.find(name);
      if (!column) continue;
      for (let index = column.offset; index < column.offset + column.length; index++) {
        const before = this.ended[index];
        if (Number.isNaN(this.live[index]) || before > this.live[index]) this.live[index] = before;
      }
    }
    const low = layout.offset("bit_speed_min");
    if (Number.isNaN(this.live[low]) || this.ended[low] < this.live[low]) this.live[low] = this.ended[low];
  }

  /** Another tool: all that is known is of the last one. */
  private forget(): void {
    this.layout = null;
    this.geometry = null;
    this.firstContacts = this.firstJoints = this.firstWhirl = null;
    this.firstShape = null;
    this.newest = this.secondNumber = NaN;
    this.cursorTime = null;
    this.lists = [];
    this.hourRevision++;
  }

  private buildFromMessages(): void {
    const [contacts, joints, whirl, shape] = [this.firstContacts, this.firstJoints, this.firstWhirl, this.firstShape];
    if (!contacts || !joints || !whirl || !shape) return;
    this.build({
      stations: contacts.measured_depth.length,
      joints: joints.measured_depth.length,
      watched: whirl.measured_depth.length,
    });
  }

  private build(counts: Counts): void {
    const [contacts, joints, whirl, shape] = [this.firstContacts, this.firstJoints, this.firstWhirl, this.firstShape];
    if (!contacts || !joints || !whirl || !shape) return;
    this.layout = new Layout(counts);
    this.second = new Float32Array(this.layout.stride).fill(NaN);
    this.live = this.second.slice();
    this.ended = this.second.slice();
    this.hour = new Ring(HOUR, this.layout.stride);
    this.joints = new Ring(QUICK, 3 * counts.joints);
    this.contacts = new Ring(QUICK, 2 * counts.stations);
    this.shapes = new Ring(SHAPES, 4 * counts.stations);
    const depth = contacts.measured_depth.slice();
    const bore = shape.markers.find((marker) => marker.ns === "bore")?.points ?? [];
    const position = new Float32Array(3 * counts.stations);
    bore.forEach((point, index) => position.set([point.x, point.y, point.z], 3 * index));
    this.geometry = {
      stationDepth: depth,
      stationInclination: contacts.inclination.slice(),
      stationPosition: position,
      jointDepth: joints.measured_depth.slice(),
      jointStation: Int32Array.from(joints.measured_depth, (at) => nearest(depth, at)),
      jointLimit: joints.limit_angle[0] ?? NaN,
      watchedDepth: whirl.measured_depth.slice(),
      watchedBody: whirl.body.slice(),
      watchedStation: Int32Array.from(whirl.measured_depth, (at) => nearest(depth, at)),
    };
  }
}

/** A header's time (s). */
export function stamp(header: Header): number {
  return header.stamp.sec + header.stamp.nanosec * 1e-9;
}

function largest(row: Float32Array, at: number, value: number): void {
  if (!(row[at] >= value)) row[at] = value;
}

function smallest(row: Float32Array, at: number, value: number): void {
  if (!(row[at] <= value)) row[at] = value;
}

/** Index of the entry nearest to a value. */
export function nearest(values: ArrayLike<number>, value: number): number {
  let best = 0;
  for (let index = 1; index < values.length; index++) {
    if (Math.abs(values[index] - value) < Math.abs(values[best] - value)) best = index;
  }
  return best;
}
