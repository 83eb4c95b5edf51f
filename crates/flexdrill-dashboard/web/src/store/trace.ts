// The tool's motion as it is heard: the second that runs, the hour, a minute at full rate. Everything that grows is a ring.

import type { History, HistoryHead, Session } from "../api";
import type {
  AlarmList,
  BitState,
  ContactForces,
  Header,
  JointDeflections,
  MarkerArray,
  TwinStatus,
  WhirlState,
} from "../messages";
import { displacements, geometryOf, geometryOfTool, watching, type Geometry } from "./geometry";
import { merged } from "./history";
import { Layout, type Counts } from "./layout";
import { Ring } from "./ring";
import { Second } from "./second";
import { stamp } from "./topics";

/** Rows of an hour at one a second. */
const HOUR = 3600;
/** Rows of a minute at 50 Hz and at 10 Hz: what the place is drawn from. */
const QUICK = 3000;
const SHAPES = 600;
/**
 * A topic whose time steps back further than this (s) is of another time. On a loaded machine one topic may come long after
 * another, but each by itself in order; those of a recording are in order together. A recording that leaps ahead is
 * elsewhere too.
 */
const SET_BACK = 10;
const BAG_BACK = 0.5;
const BAG_AHEAD = 2;

/** Largest of some values; NaN of none, as in messages of before a field was added. */
function largest(values: ArrayLike<number> = []): number {
  let most = NaN;
  for (let index = 0; index < values.length; index++) if (!(most >= values[index])) most = values[index];
  return most;
}

/** What the messages come from. */
export interface Source {
  readonly isBag: boolean;
  readonly session: Session | null;
}

export class Trace {
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
  /** Newest time on the rig's clock (s), NaN before the first message. */
  newest = NaN;
  /** A message of the tool as it is now has been processed; else only the server's hour is known. */
  hasLive = false;

  /** Newest time of each topic (s). */
  private heard = new Map<string, number>();
  private second: Second | null = null;
  private secondNumber = NaN;
  private firstContacts: ContactForces | null = null;
  private firstJoints: JointDeflections | null = null;
  private firstWhirl: WhirlState | null = null;
  private firstShape: MarkerArray | null = null;

  /** `onBreak` is called when what is known is of another time or tool. */
  constructor(
    private readonly source: Source,
    private readonly onBreak: () => void,
  ) {}

  /** The newest second; null until enough has been heard. */
  live(): Float32Array | null {
    return this.hasLive ? (this.second?.live() ?? null) : null;
  }

  /** Takes the server's hour, older than what has been heard here; with a bag all of it. */
  takeHistory(history: History): void {
    const { source } = this;
    // A page that is opened after the twin has ended hears nothing: sizes and places come from the server then.
    if (!this.layout) this.buildFrom(history.head);
    const { layout } = this;
    if (!layout) return;
    this.hour = merged(history, layout, source.isBag ? null : this.hour, HOUR);
    this.period = source.isBag ? Math.max(1, history.head.period_s || 1) : 1;
    this.hourRevision++;
  }

  takeAlarms(list: AlarmList): void {
    const active = list.alarms.filter((alarm) => alarm.state >= 1 && alarm.state <= 3);
    this.second?.set("unacknowledged_alarms", list.unacknowledged);
    this.second?.set("worst_alarm_priority", Math.max(0, ...active.map((alarm) => alarm.priority)));
  }

  takeStatus(status: TwinStatus): void {
    const second = this.begin("status", status.header);
    if (!second) return;
    second.set("state", status.state);
    second.set("real_time_factor", status.real_time_factor);
    second.set("model_quality", status.model_quality);
    status.input_name.forEach((name, index) => {
      // The optional inputs have no columns; they must not stand in those of speed and weight.
      if (name !== "rotary_speed" && name !== "weight_on_bit") return;
      const input = name;
      second.set(`${input}_state`, status.input_state[index]);
      second.set(`${input}_received`, status.input_received[index]);
      second.set(`${input}_applied`, status.input_applied[index]);
    });
  }

  takeBit(bit: BitState): void {
    const second = this.begin("bit", bit.header);
    if (!second) return;
    second.means({ bit_speed_mean: bit.rotary_speed, bit_torque_mean: bit.torque });
    second.smallest("bit_speed_min", bit.rotary_speed);
    second.largest("bit_speed_max", bit.rotary_speed);
    second.largest("bit_torque_max", bit.torque);
    second.largest("stick_slip_index", bit.stick_slip_index);
    second.largest("stick_slip_severity", bit.stick_slip_severity);
  }

  takeContacts(contacts: ContactForces): void {
    this.firstContacts ??= contacts;
    const second = this.begin("contacts", contacts.header);
    const stations = this.layout?.counts.stations ?? 0;
    if (!second) return;
    if (contacts.measured_depth.length !== stations) return this.forget();
    second.largest("max_pipe_guide_force", contacts.max_pipe_guide_force);
    second.largest("max_guide_wall_force", contacts.max_guide_wall_force);
    second.largest("shock_severity", contacts.shock_severity);
    second.largest("pipe_guide_shock", largest(contacts.pipe_guide_shock));
    second.largest("guide_wall_shock", largest(contacts.guide_wall_shock));
    second.setAll("contact_state", contacts.state);
    const quick = this.contacts.push(stamp(contacts.header));
    for (let station = 0; station < stations; station++) {
      second.largest("pipe_guide_normal_peak", contacts.pipe_guide_normal_peak[station], station);
      second.largest("guide_wall_normal_peak", contacts.guide_wall_normal_peak[station], station);
      quick[station] = contacts.pipe_guide_normal_peak[station];
      quick[stations + station] = contacts.guide_wall_normal_peak[station];
    }
  }

  takeJoints(joints: JointDeflections): void {
    this.firstJoints ??= joints;
    const second = this.begin("joints", joints.header);
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

  takeWhirl(whirl: WhirlState): void {
    this.firstWhirl ??= whirl;
    const second = this.begin("whirl", whirl.header);
    if (!second) return;
    if (whirl.measured_depth.length !== this.layout?.counts.watched) return this.forget();
    if (this.geometry) this.geometry = watching(this.geometry, whirl);
    second.setAll("whirl_kind", whirl.kind);
    second.setAll("whirl_severity", whirl.severity);
    second.setAll("whirl_ratio", whirl.whirl_ratio);
    second.setAll("clearance_ratio", whirl.clearance_ratio);
    second.setAll("contact_duty", whirl.contact_duty);
  }

  takeShape(shape: MarkerArray): void {
    this.firstShape ??= shape;
    const header = shape.markers[0]?.header;
    const second = header ? this.begin("shape", header) : null;
    const { geometry, layout } = this;
    if (!second || !geometry || !layout || !header) return;
    const stations = layout.counts.stations;
    const quick = this.shapes.push(stamp(header)).fill(NaN);
    displacements(shape, geometry, this.source.session?.tool?.exaggeration || 10, (body, station, across, low) => {
      const first = body === "pipe" ? 0 : 2 * stations;
      quick[first + station] = across;
      quick[first + stations + station] = low;
      second.setAt(body === "pipe" ? "pipe_y" : "guide_y", station, across);
      second.setAt(body === "pipe" ? "pipe_z" : "guide_z", station, low);
    });
    this.shapeRevision++;
  }

  /** Takes note of a message's time; gives the running second once the tool is known. */
  private begin(topic: string, header: Header): Second | null {
    const time = stamp(header);
    if (!this.layout) this.build();
    const second = this.second;
    if (!second) return null;
    const isElsewhere = this.source.isBag
      ? this.newest - time > BAG_BACK || time - this.newest > BAG_AHEAD
      : (this.heard.get(topic) ?? time) - time > SET_BACK;
    if (isElsewhere) this.rewind(time);
    this.hasLive = true;
    this.heard.set(topic, time);
    this.newest = Number.isNaN(this.newest) ? time : Math.max(this.newest, time);
    const number = Math.floor(time);
    if (Number.isNaN(this.secondNumber)) this.secondNumber = number;
    if (number > this.secondNumber) this.endSecond(second, number);
    return second;
  }

  /** Discards the rows after a step back of time or a move in a bag, since they belong to another time. */
  private rewind(time: number): void {
    this.newest = time;
    this.heard.clear();
    this.secondNumber = Math.floor(time);
    this.second?.clear();
    this.joints.clear();
    this.contacts.clear();
    this.shapes.clear();
    if (this.source.isBag) return;
    this.hour.clear();
    this.hourRevision++;
    this.onBreak();
  }

  private endSecond(second: Second, number: number): void {
    if (!this.source.isBag) {
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
    this.hasLive = false;
    this.heard.clear();
    this.hourRevision++;
    this.onBreak();
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
    this.make(counts, geometryOf({ contacts, joints, whirl, shape }));
  }

  /** The same from what the server says of the tool; nothing where its hour is of another one. */
  private buildFrom(head: HistoryHead): void {
    const tool = this.source.session?.tool;
    const length = (name: string) => head.columns.find((column) => column.name === name)?.length ?? 0;
    const counts: Counts = {
      stations: length("contact_state"),
      joints: length("joint_bend_angle"),
      watched: length("whirl_kind"),
    };
    if (!tool || tool.stations.length !== counts.stations || tool.joints.length !== counts.joints) return;
    this.make(counts, geometryOfTool(tool, counts.watched, head.watched_body ?? [], head.watched_depth ?? []));
    this.shapeRevision++;
  }

  private make(counts: Counts, geometry: Geometry): void {
    this.layout = new Layout(counts);
    this.second = new Second(this.layout);
    this.hour = new Ring(HOUR, this.layout.stride);
    this.joints = new Ring(QUICK, 3 * counts.joints);
    this.contacts = new Ring(QUICK, 2 * counts.stations);
    this.shapes = new Ring(SHAPES, 4 * counts.stations);
    this.geometry = geometry;
  }
}
