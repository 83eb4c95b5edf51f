// What the server answers besides the live data.

export interface Limit {
  min: number;
  max: number;
  slew_per_s: number;
}

export interface Incident {
  time_ns: string;
  duration_s: number | null;
  severity: number;
  alarm: string;
  text: string;
}

/** The planned hole of the configuration, SI: stations, or the name of a file on the twin's computer. */
export interface Plan {
  target: number;
  file: string | null;
  /** Where it begins, from the point of the hole at the depth of its first station (m); a server of an earlier version sends none. */
  offset?: [number, number, number];
  stations: { measured_depth: number; inclination: number; azimuth: number }[];
}

export interface Tool {
  stations: { measured_depth: number; inclination: number; position?: [number, number, number] }[];
  joints: { measured_depth: number; inclination: number; station: number }[];
  bore_radius: number;
  guide_radius_outer: number;
  guide_radius_inner: number;
  pipe_radius_outer: number;
  pipe_clearance: number;
  guide_clearance: number;
  joint_limit: number;
  exaggeration: number;
  title?: string;
  /** A server of an earlier version sends none. */
  plan?: Plan | null;
}

export interface Session {
  version: string;
  /** Identifies this run of the server. */
  instance: string;
  mode: "live" | "bag";
  namespace: string;
  node: string;
  control: boolean;
  /** Whether the server has a table of joints' lives; a server of an earlier version does not say. */
  life?: boolean;
  limits: { rotary_speed_rpm: Limit; weight_on_bit_kn: Limit } | null;
  bag: { name: string; start_ns: string; end_ns: string; ready?: boolean; incidents: Incident[] } | null;
  tool: Tool | null;
  config_hash?: string | null;
  /** When the twin's run began (ns since 1970); null until it is known. */
  start_ns?: string | null;
}

/** The server's clock, and the age of its newest data. */
export interface Pulse {
  instance: string;
  time_ns: string;
  newest: Record<string, { time_ns: string; age_s: number }>;
}

export interface ControlState {
  allowed: boolean;
  driving: boolean;
  by: string | null;
  target_rpm: number | null;
  target_wob_kn: number | null;
  sent_rpm: number | null;
  sent_wob_kn: number | null;
  applied_rpm: number | null;
  applied_wob_kn: number | null;
  other_driver: string | null;
  ended: string | null;
}

export interface HistoryHead {
  base_ns: string;
  period_s: number;
  count: number;
  stride: number;
  complete?: boolean;
  /** Of each watched station: body and measured depth (m). */
  watched_body?: number[];
  watched_depth?: (number | null)[];
  columns: { name: string; unit: string; offset: number; length: number }[];
}

export interface History {
  head: HistoryHead;
  values: Float32Array;
}

export interface JournalEntry {
  stamp_ns: string;
  sequence: number;
  id: string;
  name: string;
  change: number;
  priority: number;
  annunciates: boolean;
  operator_name: string;
  reason: string;
  evidence: string;
}

/** Answer to a request. */
export interface Answer {
  ok: boolean;
  message: string;
}

/** A number, or null where it is not one. */
type Figure = number | null;

export interface AlarmChance {
  id: string;
  name: string;
  priority: number;
  seen: number;
  members: number;
  probability: Figure;
  lower: Figure;
  upper: Figure;
  time_to_first: Figure;
}

export interface FigureBand {
  name: string;
  unit: string;
  p5: Figure;
  p50: Figure;
  p95: Figure;
}

/** What a look-ahead says of one speed and weight. */
export interface WhatIfAnswer {
  candidate: { rotary_speed: number; weight_on_bit: number };
  run_up: Figure;
  members: number;
  failed: number;
  failure: string;
  decided: boolean;
  any_alarm: Figure;
  any_alarm_lower: Figure;
  any_alarm_upper: Figure;
  alarms: AlarmChance[];
  figures: FigureBand[];
  hole_known: boolean;
  hole_because: string;
  hole_radius: Figure;
  hole_radius_low: Figure;
  hole_radius_high: Figure;
  hole_plan_distance: Figure;
  hole_plan_ahead: Figure;
  /** Plausible tools that the members are runs of; none, or 0, where they are runs of the twin. */
  tools?: number;
  /**
   * Runs of the twin with the friction of both layers times each factor, those among them that failed, and those that saw
   * an alarm: in the result alone.
   */
  friction_factors?: number[];
  friction_members?: number[];
  friction_failed?: number[];
  friction_any_alarm?: number[];
}

/** The newest question to the look-ahead, with its answers so far. */
export interface WhatIf {
  /** 0 before the first question. */
  number: number;
  by: string;
  horizon: number;
  members: number;
  running: boolean;
  done: number;
  remaining: number;
  failed: boolean;
  message: string;
  answers: WhatIfAnswer[];
}

/** An item of a rig's line; `quantity` is empty where it is not read. */
export interface MappedItem {
  item: string;
  quantity: string;
  /** Its first value with the mapping's unit. */
  sent: string;
  /** The same in the unit in which people know it. */
  used: string;
}

/** What a bridge makes of a source. */
export interface Mapping {
  node: string;
  source: string;
  address: string;
  /** First digits of the mapping's hash. */
  mapping: string;
  file: string;
  /** When and by whom; empty where no person has confirmed it. */
  confirmed: string;
  /** Whether this page may confirm it. */
  can_confirm: boolean;
  /** How many items are left out; empty where none is. */
  not_shown: string;
  items: MappedItem[];
}

async function json<T>(path: string, timeout?: number): Promise<T | null> {
  try {
    const signal = timeout === undefined ? null : AbortSignal.timeout(timeout);
    const response = await fetch(path, { cache: "no-store", signal });
    return response.ok ? ((await response.json()) as T) : null;
  } catch {
    return null;
  }
}

export const session = (): Promise<Session | null> => json<Session>("/api/session");
/** Asked twice a second; an answer that takes longer than this (ms) is of no use. */
export const pulse = (): Promise<Pulse | null> => json<Pulse>("/api/pulse", 2500);
export const control = (): Promise<ControlState | null> => json<ControlState>("/api/control");

/** A joint of the table of lives; texts are those of `flexdrill life show`. */
export interface JointLife {
  serial: string;
  /** Place from the bit up in its newest run. */
  place: number | null;
  hours: number;
  runs: number;
  /** The more damaged part, with its damage and that of the other one. */
  part: string;
  damage: string;
  other: string;
  verdict: string;
  /** 0 where nothing is due, up to 3: take it out. */
  level: number;
  hours_left: number | null;
}

export interface Life {
  error: string | null;
  class?: string;
  environment?: string;
  runs?: number;
  count?: number;
  joints: JointLife[];
  unknown?: string;
}

export const life = (): Promise<Life | null> => json<Life>("/api/life");

export const mappings = (): Promise<Mapping[] | null> => json<Mapping[]>("/api/mappings");

export const whatIf = (): Promise<WhatIf | null> => json<WhatIf>("/api/what_if");

/** Three seconds of a joint's motion, longer ago than a minute. */
export interface Orbit {
  from_ns: string;
  times_s: number[];
  y_m: number[];
  z_m: number[];
}

/** A joint's motion at a time (s), where the server has kept it. */
export const orbit = (joint: number, time: number): Promise<Orbit | null> =>
  json<Orbit>(`/api/orbit/${joint}/${BigInt(Math.round(time * 1e3)) * 1_000_000n}`);

export async function journal(): Promise<JournalEntry[] | null> {
  return (await json<{ events: JournalEntry[] }>("/api/journal"))?.events ?? null;
}

export async function history(): Promise<History | null> {
  try {
    const response = await fetch("/api/history", { cache: "no-store" });
    return response.ok ? parseHistory(await response.arrayBuffer()) : null;
  } catch {
    return null;
  }
}

/** Takes the hour apart: length of the head, head as JSON, frames. Null when it is not that. */
export function parseHistory(bytes: ArrayBuffer): History | null {
  if (bytes.byteLength < 4) return null;
  const length = new DataView(bytes).getUint32(0, true);
  if (4 + length > bytes.byteLength || (4 + length) % 4 !== 0) return null;
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)).trimEnd()) as HistoryHead;
  const count = head.count * head.stride;
  if (4 + length + 4 * count > bytes.byteLength) return null;
  return { head, values: new Float32Array(bytes, 4 + length, count) };
}

const TOKEN_KEY = "flexdrill-token";

/** The token of this tab: from the address once, then kept for as long as the tab is open. */
export function token(): string {
  const match = /(?:^#|&)token=([^&]+)/.exec(location.hash);
  if (match) {
    sessionStorage.setItem(TOKEN_KEY, decodeURIComponent(match[1]));
    const rest = location.hash.replace(match[0], "").replace(/^#?&?/, "");
    window.history.replaceState(null, "", location.pathname + location.search + (rest === "" ? "" : `#${rest}`));
  }
  return sessionStorage.getItem(TOKEN_KEY) ?? "";
}

export function setToken(value: string): void {
  sessionStorage.setItem(TOKEN_KEY, value.trim());
}

/** The server that this page is bound to: no other one carries its requests out. */
let bound = "";

export function bindTo(instance: string): void {
  bound = instance;
}

/** Asks for something that changes the twin or its alarms. */
export async function request(path: string, body: object): Promise<Answer> {
  try {
    const response = await fetch(`/api/control/${path}`, {
      method: "POST",
      headers: {
        "content-type": "application/json",
        authorization: `Bearer ${token()}`,
        ...(bound === "" ? {} : { "x-flexdrill-instance": bound }),
      },
      body: JSON.stringify(body),
    });
    const answer = (await response.json().catch(() => null)) as Answer | null;
    if (response.status === 401) return { ok: false, message: answer?.message || "refused: the token is wrong" };
    return { ok: response.ok && (answer?.ok ?? true), message: answer?.message ?? `HTTP ${response.status}` };
  } catch {
    return { ok: false, message: "the server does not answer" };
  }
}
