// Generated from `msg/` and `crates/flexdrill-messages/external/` by `cargo xtask messages`. Do not edit.

import { CdrReader } from "./cdr";

export interface Time {
  sec: number;
  nanosec: number;
}
/** Reads a `builtin_interfaces/msg/Time`. */
export function decodeTime(reader: CdrReader): Time {
  return {
    sec: reader.int32(),
    nanosec: reader.uint32(),
  };
}

export interface Header {
  stamp: Time;
  frame_id: string;
}
/** Reads a `std_msgs/msg/Header`. */
export function decodeHeader(reader: CdrReader): Header {
  return {
    stamp: decodeTime(reader),
    frame_id: reader.string(),
  };
}

/**
 * Fatigue damage and friction work since the start or the last reset, to compare joints, stations and drilling
 * parameters with each other. No absolute life follows from them. The damages by serial number at the end are parts of a
 * life.
 */
export interface Ageing {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Model time over which the sums were taken (s). */
  duration: number;
  /** Slope m of the Woehler line: a load cycle of range r counts (r / rated_moment)^m. */
  woehler_slope: number;
  /** Rated moment of a joint's stop (N m). */
  rated_moment: number;
  /** Per joint: measured depth from the kick-off (m). */
  joint_measured_depth: Float64Array;
  /** Inclination of the bore there, 0 is straight down (rad). */
  joint_inclination: Float64Array;
  /** Damage of the joint's stop per hour (1/h). */
  stop_damage_rate: Float64Array;
  /** Damage per hour of the link below the joint by bending at its middle, on its worse side (1/h). */
  bending_damage_rate: Float64Array;
  /** The larger of the two damage rates, divided by that of the joint that ages fastest (0 to 1). */
  relative_damage: Float64Array;
  /** Per station: measured depth from the kick-off (m). */
  station_measured_depth: Float64Array;
  /** Inclination of the bore there (rad). */
  station_inclination: Float64Array;
  /** Work of the friction between pipe and guide pipe (J). */
  pipe_guide_friction_work: Float64Array;
  /** Work of the friction between guide pipe and wall (J). */
  guide_wall_friction_work: Float64Array;
  /** Per joint: serial number. This list and those below are empty unless the run began with a table of lives. */
  joint_serial_number: string[];
  /** Damage of the joint's stop in all its runs: the median. 1 is a life, by which half of such details have a crack. */
  stop_life_damage: Float64Array;
  /** End of its band: 5 % of the scatter of class and stress concentration are below. */
  stop_life_damage_low: Float64Array;
  /** End of its band: 5 % are above. */
  stop_life_damage_high: Float64Array;
  /** Its part from the runs before this one, by the table as it was when this run began: the median. */
  stop_life_damage_before: Float64Array;
  /** The same of the link below the joint, by bending at its middle: the median. */
  link_life_damage: Float64Array;
  /** End of its band: 5 % of the scatter of class and stress concentration are below. */
  link_life_damage_low: Float64Array;
  /** End of its band: 5 % are above. */
  link_life_damage_high: Float64Array;
  /** Its part from the runs before this one, by the table as it was when this run began: the median. */
  link_life_damage_before: Float64Array;
}
/** Reads a `flexdrill/msg/Ageing`. */
export function decodeAgeing(reader: CdrReader): Ageing {
  return {
    header: decodeHeader(reader),
    duration: reader.float64(),
    woehler_slope: reader.float64(),
    rated_moment: reader.float64(),
    joint_measured_depth: reader.float64Array(reader.length()),
    joint_inclination: reader.float64Array(reader.length()),
    stop_damage_rate: reader.float64Array(reader.length()),
    bending_damage_rate: reader.float64Array(reader.length()),
    relative_damage: reader.float64Array(reader.length()),
    station_measured_depth: reader.float64Array(reader.length()),
    station_inclination: reader.float64Array(reader.length()),
    pipe_guide_friction_work: reader.float64Array(reader.length()),
    guide_wall_friction_work: reader.float64Array(reader.length()),
    joint_serial_number: reader.many(reader.length(), () => reader.string()),
    stop_life_damage: reader.float64Array(reader.length()),
    stop_life_damage_low: reader.float64Array(reader.length()),
    stop_life_damage_high: reader.float64Array(reader.length()),
    stop_life_damage_before: reader.float64Array(reader.length()),
    link_life_damage: reader.float64Array(reader.length()),
    link_life_damage_low: reader.float64Array(reader.length()),
    link_life_damage_high: reader.float64Array(reader.length()),
    link_life_damage_before: reader.float64Array(reader.length()),
  };
}

/** The state of one alarm: one condition that an operator can act on. docs/alarms.md explains each alarm. */
export interface Alarm {
  /** Identifier for programs and requests, such as backward_whirl. */
  id: string;
  /** Name for displays. */
  name: string;
  /**
   * NORMAL, ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, RETURNED_UNACKNOWLEDGED, SHELVED, SUPPRESSED_BY_DESIGN or
   * OUT_OF_SERVICE.
   */
  state: number;
  /** Priority of the condition, or of the alarm to be acknowledged, whichever is higher: NO_PRIORITY, LOW, MEDIUM or HIGH. */
  priority: number;
  /** The condition stands, also while the alarm is shelved. */
  active: boolean;
  /** No acknowledgement is needed. */
  acknowledged: boolean;
  /** When this state began, on the rig's clock; zero before the first change. */
  since: Time;
  /** When shelving ends at the latest, on the rig's clock; zero while not shelved. */
  shelved_until: Time;
  /** Shelving ends when the condition ends. */
  shelved_one_shot: boolean;
  /** Body with the worst value, see worst_at: NOWHERE, PIPE or GUIDE. */
  body: number;
  /** Measured depth from the kick-off (m), NaN where there is none. */
  measured_depth: number;
  /** Inclination of the bore there, 0 is straight down (rad), NaN where there is none. */
  inclination: number;
  /** The value that is judged, in unit; NaN where there is no such number. */
  value: number;
  /** The threshold that value is compared with, in unit; NaN where there is no such number. */
  threshold: number;
  /** Unit of value and threshold; empty where they have none. */
  unit: string;
  /** How far the evidence can be trusted (0 to 1). */
  confidence: number;
  /**
   * What happened at worst_at, in a sentence; it says when the condition has ended. This text and the next three are empty
   * while the alarm is normal.
   */
  evidence: string;
  /** Why it happens. */
  cause: string;
  /** Why it matters: the consequence without action. */
  consequence: string;
  /**
   * What the driller can do: weight on bit, rotary speed, pick up, call the engineer. It never contradicts the other
   * alarms in the list.
   */
  what_to_do: string;
  /** Number of annunciations since the count began; a restart continues the count. */
  annunciations: number;
  /** Number of annunciations in the last minute; from three on the alarm chatters. */
  annunciations_last_minute: number;
  /** Addressee of the alarm: DRILLING or SYSTEM. Show SYSTEM alarms separately from the driller's. */
  category: number;
  /** The present state began in an earlier run of the node; since is a time of that run. */
  from_earlier_run: boolean;
  /** What the engineer can do: settings of the model and the machine, measurements, inspection. */
  what_the_engineer_can_do: string;
  /**
   * Time of location, value, confidence and evidence, on the rig's clock: the worst moment since the priority was reached.
   * Zero while the alarm is normal.
   */
  worst_at: Time;
  /** The condition has ended: the alarm is held in case it returns, or waits to be acknowledged. */
  ended: boolean;
  /** When the condition was last met, on the rig's clock; zero unless ended. */
  ended_at: Time;
  /**
   * When the condition last reached the priority of the alarm, on the rig's clock: it stands since then at a lower one.
   * Zero while it stands at the alarm's priority, and once it has ended.
   */
  less_severe_since: Time;
  /**
   * Number of times that the condition has come since the alarm was normal or the node began: 1 for a condition that stands
   * without a pause, more for an intermittent one. Zero while the alarm is normal.
   */
  episodes: number;
  /** Id of the alarm whose action comes first: what_to_do refers to it. Empty for an alarm with an action of its own. */
  follows: string;
}
export const Alarm = {
  /** No action is needed. */
  NORMAL: 0,
  /** The condition stands and is not yet acknowledged. */
  ACTIVE_UNACKNOWLEDGED: 1,
  /** The condition stands and is acknowledged. */
  ACTIVE_ACKNOWLEDGED: 2,
  /** The condition has ended and is not yet acknowledged. */
  RETURNED_UNACKNOWLEDGED: 3,
  /** An operator has put it aside for a time. */
  SHELVED: 4,
  /**
   * The condition has no meaning at present: the drive stands or runs up, the model is paused, or the first sample of an
   * input is awaited.
   */
  SUPPRESSED_BY_DESIGN: 5,
  /** Switched off by the configuration. */
  OUT_OF_SERVICE: 6,
  /** No priority: no action is needed. */
  NO_PRIORITY: 0,
  /** Act when there is time. */
  LOW: 1,
  /** Act soon. */
  MEDIUM: 2,
  /** Act at once. */
  HIGH: 3,
  /** The alarm concerns drilling and is for the driller. */
  DRILLING: 0,
  /** The alarm concerns the twin's computer, disk or network and is for its administrator. */
  SYSTEM: 1,
  /** The alarm has no location along the tool, or none at present. */
  NOWHERE: 0,
  /** The flexible pipe. */
  PIPE: 1,
  /** The guide pipe. */
  GUIDE: 2,
} as const;
/** Reads a `flexdrill/msg/Alarm`. */
export function decodeAlarm(reader: CdrReader): Alarm {
  return {
    id: reader.string(),
    name: reader.string(),
    state: reader.uint8(),
    priority: reader.uint8(),
    active: reader.bool(),
    acknowledged: reader.bool(),
    since: decodeTime(reader),
    shelved_until: decodeTime(reader),
    shelved_one_shot: reader.bool(),
    body: reader.uint8(),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    value: reader.float64(),
    threshold: reader.float64(),
    unit: reader.string(),
    confidence: reader.float64(),
    evidence: reader.string(),
    cause: reader.string(),
    consequence: reader.string(),
    what_to_do: reader.string(),
    annunciations: reader.uint64(),
    annunciations_last_minute: reader.uint32(),
    category: reader.uint8(),
    from_earlier_run: reader.bool(),
    what_the_engineer_can_do: reader.string(),
    worst_at: decodeTime(reader),
    ended: reader.bool(),
    ended_at: decodeTime(reader),
    less_severe_since: decodeTime(reader),
    episodes: reader.uint32(),
    follows: reader.string(),
  };
}

/**
 * How many members of a look-ahead saw an alarm: raised after the first 5 s of the horizon, or standing in its second half.
 * On twin/bands: in how many plausible tools it stands.
 */
export interface AlarmChance {
  /** Id of the alarm, such as backward_whirl. */
  id: string;
  /** Its name for people. */
  name: string;
  /** Of this priority or a higher one: Alarm.LOW, MEDIUM or HIGH. */
  priority: number;
  /** Members that saw it. */
  seen: number;
  /** Members that ended. */
  members: number;
  /** Share of the members, on twin/bands by their weights; NaN where none ended. */
  probability: number;
  /** The 95 % interval of the probability (Wilson). */
  lower: number;
  upper: number;
  /**
   * Median of the time from the beginning of the horizon until the alarm counts (s), over the members that saw it. On
   * twin/bands: since it stands.
   */
  time_to_first: number;
}
/** Reads a `flexdrill/msg/AlarmChance`. */
export function decodeAlarmChance(reader: CdrReader): AlarmChance {
  return {
    id: reader.string(),
    name: reader.string(),
    priority: reader.uint8(),
    seen: reader.uint32(),
    members: reader.uint32(),
    probability: reader.float64(),
    lower: reader.float64(),
    upper: reader.float64(),
    time_to_first: reader.float64(),
  };
}

/** One change of one alarm: an entry of the journal. Alarm defines the states and priorities. */
export interface AlarmEvent {
  /** Stamp: time of the change, on the rig's clock. Frame: the tool. */
  header: Header;
  /** Number of the event, one more in every event, also across restarts. */
  sequence: number;
  /** Id of the alarm, as in Alarm. */
  id: string;
  /** Name for displays. */
  name: string;
  /**
   * ACTIVATED, RAISED, LOWERED, RETURNED, ACKNOWLEDGED, SHELVED, UNSHELVED, SUPPRESSED, RELEASED, TAKEN_OUT, PUT_BACK or
   * ADJUSTED.
   */
  change: number;
  /** State before the change, as in Alarm. */
  from_state: number;
  /** State after the change. */
  to_state: number;
  /**
   * The present priority of the condition; when it has ended, its last priority or the one to be acknowledged. As in
   * Alarm.
   */
  priority: number;
  /** The event is an annunciation. A rise of an alarm that is not yet acknowledged is none. */
  annunciates: boolean;
  /** Operator or client who requested it; empty if it was not requested. */
  operator_name: string;
  /** Reason; for UNSHELVED without a request, why the shelving ended. */
  reason: string;
  /** When shelving ends at the latest, for SHELVED. */
  shelved_until: Time;
  /** What happens, in a sentence; empty where the condition is absent. */
  evidence: string;
  /** What the driller can do, as in Alarm; empty where no action is needed. */
  what_to_do: string;
  /** Body with the worst value, as in Alarm: NOWHERE, PIPE or GUIDE. */
  body: number;
  /** Measured depth from the kick-off (m), NaN where there is none. */
  measured_depth: number;
  /** Inclination of the bore there (rad), NaN where there is none. */
  inclination: number;
  /** The value that was judged, NaN where there is no such number. */
  value: number;
  /** Addressee of the alarm, as in Alarm: DRILLING or SYSTEM. */
  category: number;
  /** What the engineer can do, as in Alarm. */
  what_the_engineer_can_do: string;
  /** Time of location, value and evidence, as in Alarm. */
  worst_at: Time;
  /**
   * When the condition ended, as in Alarm: earlier than the stamp of RETURNED by the time for which the alarm was held.
   * Zero while the condition is met.
   */
  ended_at: Time;
  /**
   * When the condition last reached the priority of the alarm, as in Alarm: earlier than the stamp of LOWERED by the time
   * for which the priority was held.
   */
  less_severe_since: Time;
  /** Number of times that the condition has come, as in Alarm. */
  episodes: number;
  /** Id of the alarm whose action comes first, as in Alarm. */
  follows: string;
}
export const AlarmEvent = {
  /** The condition has stood for its on-delay. */
  ACTIVATED: 0,
  /** Its priority has risen. */
  RAISED: 1,
  /** Its priority has fallen, but it stands. */
  LOWERED: 2,
  /** The condition has been absent for its off-delay. */
  RETURNED: 3,
  /** An operator has acknowledged it. */
  ACKNOWLEDGED: 4,
  /** An operator has shelved it. */
  SHELVED: 5,
  /** Its shelving has ended: by a request, after its time, with its condition, or by a rise to HIGH. */
  UNSHELVED: 6,
  /** The condition has no meaning from now on; SUPPRESSED_BY_DESIGN in Alarm gives the cases. */
  SUPPRESSED: 7,
  /** The condition has a meaning again. */
  RELEASED: 8,
  /** The configuration takes it out of service. */
  TAKEN_OUT: 9,
  /** The configuration returns it to service. */
  PUT_BACK: 10,
  /**
   * What the alarm is judged against was adjusted, by calibration.follow or by a client, which operator_name names; the
   * reason says how. The state stays.
   */
  ADJUSTED: 11,
} as const;
/** Reads a `flexdrill/msg/AlarmEvent`. */
export function decodeAlarmEvent(reader: CdrReader): AlarmEvent {
  return {
    header: decodeHeader(reader),
    sequence: reader.uint64(),
    id: reader.string(),
    name: reader.string(),
    change: reader.uint8(),
    from_state: reader.uint8(),
    to_state: reader.uint8(),
    priority: reader.uint8(),
    annunciates: reader.bool(),
    operator_name: reader.string(),
    reason: reader.string(),
    shelved_until: decodeTime(reader),
    evidence: reader.string(),
    what_to_do: reader.string(),
    body: reader.uint8(),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    value: reader.float64(),
    category: reader.uint8(),
    what_the_engineer_can_do: reader.string(),
    worst_at: decodeTime(reader),
    ended_at: decodeTime(reader),
    less_severe_since: decodeTime(reader),
    episodes: reader.uint32(),
    follows: reader.string(),
  };
}

/**
 * All alarms, the worst first, sent when one of them changes and every second. Latched: of several received messages,
 * the one with the highest sequence is valid, and of those with the same sequence the newest.
 */
export interface AlarmList {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Number of events so far, across restarts: the sequence of the newest AlarmEvent. */
  sequence: number;
  /**
   * All alarms, including normal ones, in this order: active ones whose condition stands, active ones whose condition has
   * ended, returned, shelved, suppressed, normal, out of service. Within each group the driller's before those of the
   * computer, those with an action of their own before those that follow another alarm's, then by priority, and the
   * unacknowledged before the acknowledged. So the first one stands if any stands, and its what_to_do is an action.
   */
  alarms: Alarm[];
  /** Number of alarms to be acknowledged. */
  unacknowledged: number;
  /** Number of annunciations in the last ten minutes. */
  annunciations_last_ten_minutes: number;
  /** There were more than ten annunciations in the last ten minutes. */
  flood: boolean;
  /** Mean number of annunciations per hour since the count began; a restart continues the count. NaN before one full hour. */
  annunciations_per_hour: number;
  /** Share of the time in flood (0 to 1); NaN before ten full minutes. */
  flood_share: number;
}
/** Reads a `flexdrill/msg/AlarmList`. */
export function decodeAlarmList(reader: CdrReader): AlarmList {
  return {
    header: decodeHeader(reader),
    sequence: reader.uint64(),
    alarms: reader.many(reader.length(), () => decodeAlarm(reader)),
    unacknowledged: reader.uint32(),
    annunciations_last_ten_minutes: reader.uint32(),
    flood: reader.bool(),
    annunciations_per_hour: reader.float64(),
    flood_share: reader.float64(),
  };
}

/**
 * The values that drive the model from a step on, sent when one of them changes. The sequence of these messages and the
 * configuration determine a run bit for bit. Without a change the message is repeated every second of model time, with
 * reset false and with all parameters changed since the start, for clients that join or record later.
 */
export interface AppliedInputs {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Number of model steps before these values act: they act on the next step. */
  step: number;
  /** Steps skipped so far because the model was late. */
  skipped_steps: number;
  /** The model was reset to its state after the start before this step; step counts from 0 again. */
  reset: boolean;
  /** Target speed of the drive, before the slew limit (rad/s). */
  rotary_speed: number;
  /** Target weight on bit, before the slew limit (N). */
  weight_on_bit: number;
  /**
   * The worst state of the inputs that the tool uses: INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE or
   * INPUT_REJECTED. An optional input of which no sample has arrived does not count.
   */
  input_quality: number;
  /** Slew limit of the rotary speed (rad/s2). */
  rotary_speed_slew: number;
  /** Slew limit of the weight on bit (N/s). */
  weight_on_bit_slew: number;
  /** Coulomb coefficients between pipe and guide pipe: around the circumference, along the axis. */
  inner_friction: Float64Array;
  /** Coulomb coefficients between guide pipe and wall: around the circumference, along the axis. */
  outer_friction: Float64Array;
  /** Friction factor between bit and rock. */
  bit_friction_factor: number;
  /** Other numeric parameters that were changed at this step, by their ROS name. */
  parameter_name: string[];
  /** Their new values, in the parameter's unit. */
  parameter_value: Float64Array;
  /** Client that requested them: the service and its client, as node @ host (id of its DDS writer). */
  parameter_asked_by: string[];
  /** Every model step is solved in 2^refinement equal parts: as many as the motion requires and the pace allows. */
  refinement: number;
  /** Target rate of penetration, before the slew limit (m/s); negative while the tool is pulled back. */
  rate_of_penetration: number;
  /** Target standpipe pressure, inside minus outside, before the slew limit (Pa). */
  standpipe_pressure: number;
  /** Slew limit of the rate of penetration (m/s2). */
  rate_of_penetration_slew: number;
  /** Slew limit of the standpipe pressure (Pa/s). */
  standpipe_pressure_slew: number;
}
export const AppliedInputs = {
  /** No sample has arrived yet: the twin runs on its configured start values. */
  INPUT_NOT_RECEIVED: 0,
  /** The newest sample is fresh. */
  INPUT_OK: 1,
  /** The newest sample is later than expected, but not yet stale. */
  INPUT_SLOW: 2,
  /** The newest sample is too old: the value is held, then brought to the safe value. */
  INPUT_STALE: 3,
  /** The newest sample was refused; the last good value is held. */
  INPUT_REJECTED: 4,
  /** An optional input of which no sample has arrived: the twin runs on its configured constant. */
  INPUT_ASSUMED: 5,
} as const;
/** Reads a `flexdrill/msg/AppliedInputs`. */
export function decodeAppliedInputs(reader: CdrReader): AppliedInputs {
  return {
    header: decodeHeader(reader),
    step: reader.uint64(),
    skipped_steps: reader.uint64(),
    reset: reader.bool(),
    rotary_speed: reader.float64(),
    weight_on_bit: reader.float64(),
    input_quality: reader.uint8(),
    rotary_speed_slew: reader.float64(),
    weight_on_bit_slew: reader.float64(),
    inner_friction: reader.float64Array(2),
    outer_friction: reader.float64Array(2),
    bit_friction_factor: reader.float64(),
    parameter_name: reader.many(reader.length(), () => reader.string()),
    parameter_value: reader.float64Array(reader.length()),
    parameter_asked_by: reader.many(reader.length(), () => reader.string()),
    refinement: reader.uint8(),
    rate_of_penetration: reader.float64(),
    standpipe_pressure: reader.float64(),
    rate_of_penetration_slew: reader.float64(),
    standpipe_pressure_slew: reader.float64(),
  };
}

/** A figure over the members of a look-ahead, or over plausible tools. */
export interface FigureBand {
  /**
   * Of a look-ahead: bit_speed_ripple, pipe_guide_force, guide_wall_force, stop_moment, bending_cycles, damage,
   * torque_transfer or weight_transfer. Of twin/bands: topic and field, such as transfer/bit_torque.
   */
  name: string;
  /** Unit; empty for a ratio. */
  unit: string;
  /** Quantiles over the members at 5, 50 and 95 %; NaN where no member has the figure. */
  p5: number;
  p50: number;
  p95: number;
}
/** Reads a `flexdrill/msg/FigureBand`. */
export function decodeFigureBand(reader: CdrReader): FigureBand {
  return {
    name: reader.string(),
    unit: reader.string(),
    p5: reader.float64(),
    p50: reader.float64(),
    p95: reader.float64(),
  };
}

/**
 * What plausible tools do under the inputs of the twin, once per second of model time: bands of its figures, and the share of
 * the tools in which each alarm stands.
 */
export interface Bands {
  /**
   * Stamp: the instant of the figures, on the rig's clock. The message comes once every member has been computed up to it, a
   * second or more later. Frame: the tool.
   */
  header: Header;
  /** Instant at which these members began. */
  begun: Time;
  /** Members: tools that were drawn from what is known of the tool and its rig. */
  members: number;
  /**
   * Members that could not be computed. What they do is unknown, not safe: they are in no band and no chance, and are replaced
   * within two minutes.
   */
  failed: number;
  /** Members that are prepared to replace others, and count for nothing yet. */
  prepared: number;
  /**
   * Number of members alike that those amount to by their weights, which what the rig measures gives them; without
   * measurements all that were computed. Bands need 8.
   */
  effective: number;
  /** How often members of little weight gave way to others near those of much weight. */
  renewals: number;
  /** Why there are no bands; empty where there are. */
  no_bands: string;
  /**
   * The figures: those of twin/bit_state, twin/joint_deflections, twin/contact_forces and twin/transfer that a table or a
   * bridge shows, over the last second. With fewer than 19 members the ends lie beyond the outermost, as of a normal distribution.
   */
  bands: FigureBand[];
  /** Measured depth of the stations of the two profiles below (m). */
  measured_depth: Float64Array;
  /**
   * Largest normal force of pipe and guide within the last second at each station (N): quantiles over plausible tools at 5, 50
   * and 95 %. Empty without bands.
   */
  pipe_guide_force_p5: Float64Array;
  pipe_guide_force_p50: Float64Array;
  pipe_guide_force_p95: Float64Array;
  /** The same of guide and wall (N). */
  guide_wall_force_p5: Float64Array;
  guide_wall_force_p50: Float64Array;
  guide_wall_force_p95: Float64Array;
  /** Alarms that stand in a plausible tool, with each priority: the share of the tools by their weights. */
  alarms: AlarmChance[];
  /**
   * Share of the plausible tools in which any alarm of the tool stands, with its 95 % interval (Wilson); NaN where no member
   * was computed.
   */
  any_alarm: number;
  any_alarm_lower: number;
  any_alarm_upper: number;
  /**
   * Sensors of the rig that the plausible tools are not weighed by, as in `uncertainty.sensors` (surface_torque, hook_load); empty
   * where all are believed. The alarms of the twin do not depend on it.
   */
  distrusted: string[];
  /** Why, in words, for each of them. */
  distrusted_why: string[];
  /**
   * Factors by which the bands of `bands` are wider than those of the members (ensemble.band_factors), in their order: 1 where none
   * is stated; empty without bands. The profiles have those of the largest force of their layer.
   */
  band_factors: Float64Array;
}
/** Reads a `flexdrill/msg/Bands`. */
export function decodeBands(reader: CdrReader): Bands {
  return {
    header: decodeHeader(reader),
    begun: decodeTime(reader),
    members: reader.uint32(),
    failed: reader.uint32(),
    prepared: reader.uint32(),
    effective: reader.float64(),
    renewals: reader.uint32(),
    no_bands: reader.string(),
    bands: reader.many(reader.length(), () => decodeFigureBand(reader)),
    measured_depth: reader.float64Array(reader.length()),
    pipe_guide_force_p5: reader.float64Array(reader.length()),
    pipe_guide_force_p50: reader.float64Array(reader.length()),
    pipe_guide_force_p95: reader.float64Array(reader.length()),
    guide_wall_force_p5: reader.float64Array(reader.length()),
    guide_wall_force_p50: reader.float64Array(reader.length()),
    guide_wall_force_p95: reader.float64Array(reader.length()),
    alarms: reader.many(reader.length(), () => decodeAlarmChance(reader)),
    any_alarm: reader.float64(),
    any_alarm_lower: reader.float64(),
    any_alarm_upper: reader.float64(),
    distrusted: reader.many(reader.length(), () => reader.string()),
    distrusted_why: reader.many(reader.length(), () => reader.string()),
    band_factors: reader.float64Array(reader.length()),
  };
}

/**
 * The bit. Torque, speed, weight and accelerations cover the time since the previous message, in which every step counts:
 * an instant would alias with the rotation. Only the first message of a run has torque, speed and weight of its instant.
 */
export interface BitState {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /**
   * Torque of the rock against the bit, mean (N m): positive where it opposes forward rotation, negative in
   * reverse, 0 off bottom.
   */
  torque: number;
  /** Rotary speed of the bit, mean (rad/s, negative in reverse). */
  rotary_speed: number;
  /** Weight on the bit, mean (N): given, or what the rock carries; 0 off bottom. */
  weight_on_bit: number;
  /**
   * (max - min) / (2 mean) of the rotary speed over its window; 0 while the drive is near standstill, at least 1 while the
   * bit stands and the drive turns.
   */
  stick_slip_index: number;
  /** Root mean square over the publishing interval of spin acceleration times bit radius (m/s2). */
  tangential_acceleration: number;
  /** Root mean square over the publishing interval of the axial acceleration (m/s2). */
  axial_acceleration: number;
  /** Root mean square over the publishing interval of the lateral acceleration one station above the bit (m/s2). */
  lateral_acceleration: number;
  /** Largest lateral acceleration one station above the bit in the publishing interval (m/s2). */
  lateral_acceleration_peak: number;
  /** Integral of the size of the lateral acceleration one station above the bit over the publishing interval (m/s). */
  lateral_impulse: number;
  /** Level that the stick-slip index has reached: OK, WATCH, WARNING or CRITICAL. */
  stick_slip_severity: number;
}
export const BitState = {
  /** No action is needed. */
  OK: 0,
  /** The driller should watch it. */
  WATCH: 1,
  /** Action is needed soon. */
  WARNING: 2,
  /** Action is needed now. */
  CRITICAL: 3,
} as const;
/** Reads a `flexdrill/msg/BitState`. */
export function decodeBitState(reader: CdrReader): BitState {
  return {
    header: decodeHeader(reader),
    torque: reader.float64(),
    rotary_speed: reader.float64(),
    weight_on_bit: reader.float64(),
    stick_slip_index: reader.float64(),
    tangential_acceleration: reader.float64(),
    axial_acceleration: reader.float64(),
    lateral_acceleration: reader.float64(),
    lateral_acceleration_peak: reader.float64(),
    lateral_impulse: reader.float64(),
    stick_slip_severity: reader.uint8(),
  };
}

/**
 * Contact between pipe and guide pipe and between guide pipe and bore wall. All arrays have one entry per station, top
 * to bottom. Collisions are shorter than the publishing interval: see the peak and rms arrays.
 */
export interface ContactForces {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Largest normal force between pipe and guide pipe in the publishing interval (N). */
  max_pipe_guide_force: number;
  /** Entry of its station in the arrays below. */
  max_pipe_guide_station: number;
  /** Largest normal force between guide pipe and wall in the publishing interval (N). */
  max_guide_wall_force: number;
  /** Entry of its station in the arrays below. */
  max_guide_wall_station: number;
  /** Measured depth from the kick-off (m). */
  measured_depth: Float64Array;
  /** Inclination of the bore there, 0 is straight down (rad). */
  inclination: Float64Array;
  /** FREE, INNER, OUTER or BOTH at the stamp. */
  state: Uint8Array;
  /** Gap between pipe and guide pipe (m, negative is penetration). */
  pipe_guide_gap: Float64Array;
  /** Normal force at the stamp (N, >= 0). */
  pipe_guide_normal: Float64Array;
  /** Friction around the circumference on the pipe (N, positive in the drive's sense). */
  pipe_guide_tangential: Float64Array;
  /** Friction along the axis on the pipe (N, positive downhole). */
  pipe_guide_axial: Float64Array;
  /** Largest normal force in the publishing interval (N). */
  pipe_guide_normal_peak: Float64Array;
  /** Root mean square of the normal force over the publishing interval (N). */
  pipe_guide_normal_rms: Float64Array;
  /** Gap between guide pipe and wall (m, negative is penetration). */
  guide_wall_gap: Float64Array;
  /** Normal force at the stamp (N, >= 0). */
  guide_wall_normal: Float64Array;
  /** Friction around the circumference on the guide pipe (N, positive in the drive's sense). */
  guide_wall_tangential: Float64Array;
  /** Friction along the axis on the guide pipe (N, positive downhole). */
  guide_wall_axial: Float64Array;
  /** Largest normal force in the publishing interval (N). */
  guide_wall_normal_peak: Float64Array;
  /** Root mean square of the normal force over the publishing interval (N). */
  guide_wall_normal_rms: Float64Array;
  /**
   * Shock: largest impulse of the normal force in a short interval (20 ms by default) in the publishing interval, minus
   * that of the resting force (N s).
   */
  pipe_guide_shock: Float64Array;
  /** The same between guide pipe and wall (N s). */
  guide_wall_shock: Float64Array;
  /** Level of shock of the tool: SHOCK_OK, SHOCK_WATCH, SHOCK_WARNING or SHOCK_CRITICAL. */
  shock_severity: number;
  /** Largest shock since that level was reached (N s). */
  shock_impulse: number;
  /** Entry of its station in the arrays. */
  shock_station: number;
  /** Its layer: INNER or OUTER. */
  shock_layer: number;
}
export const ContactForces = {
  /** No contact at this station. */
  FREE: 0,
  /** Pipe and guide pipe are in contact. */
  INNER: 1,
  /** Guide pipe and wall are in contact. */
  OUTER: 2,
  /** Both layers are in contact. */
  BOTH: 3,
  /** No action is needed. */
  SHOCK_OK: 0,
  /** The driller should watch it. */
  SHOCK_WATCH: 1,
  /** Action is needed soon. */
  SHOCK_WARNING: 2,
  /** Action is needed now. */
  SHOCK_CRITICAL: 3,
} as const;
/** Reads a `flexdrill/msg/ContactForces`. */
export function decodeContactForces(reader: CdrReader): ContactForces {
  return {
    header: decodeHeader(reader),
    max_pipe_guide_force: reader.float64(),
    max_pipe_guide_station: reader.uint32(),
    max_guide_wall_force: reader.float64(),
    max_guide_wall_station: reader.uint32(),
    measured_depth: reader.float64Array(reader.length()),
    inclination: reader.float64Array(reader.length()),
    state: reader.uint8Array(reader.length()),
    pipe_guide_gap: reader.float64Array(reader.length()),
    pipe_guide_normal: reader.float64Array(reader.length()),
    pipe_guide_tangential: reader.float64Array(reader.length()),
    pipe_guide_axial: reader.float64Array(reader.length()),
    pipe_guide_normal_peak: reader.float64Array(reader.length()),
    pipe_guide_normal_rms: reader.float64Array(reader.length()),
    guide_wall_gap: reader.float64Array(reader.length()),
    guide_wall_normal: reader.float64Array(reader.length()),
    guide_wall_tangential: reader.float64Array(reader.length()),
    guide_wall_axial: reader.float64Array(reader.length()),
    guide_wall_normal_peak: reader.float64Array(reader.length()),
    guide_wall_normal_rms: reader.float64Array(reader.length()),
    pipe_guide_shock: reader.float64Array(reader.length()),
    guide_wall_shock: reader.float64Array(reader.length()),
    shock_severity: reader.uint8(),
    shock_impulse: reader.float64(),
    shock_station: reader.uint32(),
    shock_layer: reader.uint8(),
  };
}

/** One figure of a forecast, second by second. */
export interface ForecastBand {
  /**
   * bit_speed, bit_torque, weight_on_bit, pipe_guide_force or guide_wall_force. Speed, torque and weight are means over
   * each second, forces the largest of each second at any station.
   */
  name: string;
  /** Unit: rad/s, N m or N. */
  unit: string;
  /**
   * The 90 % band and the median, one value per second of the horizon; NaN where no member ended. The band has been widened
   * or narrowed to the share of earlier seconds that it is to hold (see width), and is never narrower than the band of
   * plausible tools at present (twin/bands).
   */
  p5: Float64Array;
  p50: Float64Array;
  p95: Float64Array;
  /** Factor on the band of the members over the first seconds, lead_width[0]. */
  width: number;
  /** Seconds of earlier forecasts of this run that were compared with what came, while speed and weight stayed. */
  compared: number;
  /** Seconds among them in which the figure was in the published band. */
  inside: number;
  /** Seconds among them in which it was in the band of the members as they were. */
  inside_members: number;
  /**
   * How far ahead seconds are that are calibrated together, counted from the beginning of the bands: the i-th of the lists below
   * holds for seconds before lead_until[i] (s), and from lead_until[i - 1] on.
   */
  lead_until: Float64Array;
  /**
   * Factor on the band of the members. It is the one with which nine of ten of the last seconds that were compared at this
   * lead would have been in their band; 1 before that is known.
   */
  lead_width: Float64Array;
  /**
   * Whether it is known: nine forecasts at least were compared with what came at this lead. Where it is false, the band is
   * that of the members, and not calibrated yet.
   */
  lead_calibrated: boolean[];
  /** Seconds that were compared at this lead, and those among them in which the figure was in the published band. */
  lead_compared: Uint32Array;
  lead_inside: Uint32Array;
}
/** Reads a `flexdrill/msg/ForecastBand`. */
export function decodeForecastBand(reader: CdrReader): ForecastBand {
  return {
    name: reader.string(),
    unit: reader.string(),
    p5: reader.float64Array(reader.length()),
    p50: reader.float64Array(reader.length()),
    p95: reader.float64Array(reader.length()),
    width: reader.float64(),
    compared: reader.uint32(),
    inside: reader.uint32(),
    inside_members: reader.uint32(),
    lead_until: reader.float64Array(reader.length()),
    lead_width: reader.float64Array(reader.length()),
    lead_calibrated: reader.many(reader.length(), () => reader.bool()),
    lead_compared: reader.uint32Array(reader.length()),
    lead_inside: reader.uint32Array(reader.length()),
  };
}

/** The next minute at the present speed and weight, from runs that begin at the present state. */
export interface Forecast {
  /** Stamp: the instant of the state that the runs begin from, on the rig's clock. Frame: the tool. */
  header: Header;
  /** Model step of that state. */
  from_step: number;
  /** Rotary speed that is asked for during the forecast (rad/s). */
  rotary_speed: number;
  /** Weight on bit that is asked for during the forecast (N). */
  weight_on_bit: number;
  /** Start of the first second of the bands: the first whole second of model time after the state, on the rig's clock. */
  bands_from: Time;
  /** Time between two values of the bands (s). */
  interval: number;
  /** Members whose motion could be computed to the end. */
  members: number;
  /** Members that failed. They are in no band and no probability: what would have come is unknown, not safe. */
  failed: number;
  /** Why the first of these failed, or why there is no forecast; empty where none failed. */
  failure: string;
  /** One per figure. */
  bands: ForecastBand[];
  /** The alarms that a member saw, with each priority. */
  alarms: AlarmChance[];
  /** Chance that a member saw any alarm, with its 95 % interval (Wilson); NaN where no member ended. */
  any_alarm: number;
  any_alarm_lower: number;
  any_alarm_upper: number;
  /**
   * Plausible tools that the members, those that failed included, are runs of, each from its own state; 0 where they are runs of
   * the twin.
   */
  tools: number;
}
/** Reads a `flexdrill/msg/Forecast`. */
export function decodeForecast(reader: CdrReader): Forecast {
  return {
    header: decodeHeader(reader),
    from_step: reader.uint64(),
    rotary_speed: reader.float64(),
    weight_on_bit: reader.float64(),
    bands_from: decodeTime(reader),
    interval: reader.float64(),
    members: reader.uint32(),
    failed: reader.uint32(),
    failure: reader.string(),
    bands: reader.many(reader.length(), () => decodeForecastBand(reader)),
    alarms: reader.many(reader.length(), () => decodeAlarmChance(reader)),
    any_alarm: reader.float64(),
    any_alarm_lower: reader.float64(),
    any_alarm_upper: reader.float64(),
    tools: reader.uint32(),
  };
}

/**
 * Where this tool drills next: what the bit does now, and the next metres with the range of plausible tools, once per second
 * of model time. It reads the twin and acts on nothing.
 */
export interface HoleAhead {
  /**
   * Stamp: the instant at which the means end, on the rig's clock. Where an answer is to come the message follows once it is
   * there, some seconds later. Frame: the tool.
   */
  header: Header;
  /**
   * Whether the hole ahead is known. Where it is false, all from build_rate on that says where the tool drills is NaN, and the
   * arrays are empty.
   */
  known: boolean;
  /** Why it is not known, in one sentence; empty where it is. */
  because: string;
  /** Time that the means cover (s): whole turns, or all that is there where it is less than one turn. */
  window: number;
  /** Whole turns of the bit in that time; 0 where the bit stands or turns more slowly. */
  turns: number;
  /** Measured depth of the bit, from the kick-off (m). */
  measured_depth: number;
  /** Inclination of the hole at the bit (rad): 0 is straight down. */
  inclination: number;
  /** Azimuth of the hole at the bit (rad), clockwise seen from above: 0 is the plane of the configured hole. */
  azimuth: number;
  /** Force of the bit on the rock across the hole (N), to the low side: above 0 it drops. */
  side_force_low: number;
  /** The same to the right, seen down the hole (N): above 0 it walks to the right. */
  side_force_right: number;
  /** Standard errors of these means (N); NaN with fewer than 3 whole turns. */
  side_force_low_error: number;
  side_force_right_error: number;
  /** Tilt of the guide's last node against the hole (rad), to the low side: below 0 the bit points up and builds. */
  tilt_low: number;
  /** The same to the right (rad). */
  tilt_right: number;
  /**
   * Direction in which the bit drills against the hole's (rad), to the low side: tilt and side force together by the law of the
   * bit. Below 0 it builds more than the hole at the bit does. NaN where the bit cuts nothing.
   */
  turn_low: number;
  /** The same to the right (rad). */
  turn_right: number;
  /** Weight on the bit (N); 0 off bottom. */
  weight_on_bit: number;
  /** The part of it that cuts (N): without the wear flats. 0 where the bit cuts nothing. */
  weight_that_cuts: number;
  /** Torque of the rock against the bit (N m). */
  torque: number;
  /** The instant of the means that the answer is for, on the rig's clock; 0 without an answer. */
  answered: Time;
  /**
   * Side force to the low side of the guide at rest in this hole, by the statics that the hole is grown with (N). The hole ahead
   * is not known where that of the twin differs by more than 3 standard errors and 5 %, or 0.5 % of the weight where that is
   * more. NaN without an answer.
   */
  side_force_low_at_rest: number;
  /**
   * Build rate over the next metre (rad/m): above 0 the inclination rises. Low and high: 5 and 95 % of the plausible tools. NaN
   * where it is not known.
   */
  build_rate: number;
  build_rate_low: number;
  build_rate_high: number;
  /**
   * Walk rate over the next metre (rad/m): above 0 the azimuth turns to the right. NaN where it is not known, or the hole is
   * within 3 deg of the vertical.
   */
  walk_rate: number;
  walk_rate_low: number;
  walk_rate_high: number;
  /** Radius of the hole over the next metre (m), whatever its direction; infinite where it is straight. NaN where it is not known. */
  radius: number;
  radius_low: number;
  radius_high: number;
  /** Steering number P: lateral resistance of the bit against the bending of the guide, in a long arc. NaN where it is not known. */
  steering_number: number;
  /** Length between the bit and where the guide lies on the wall, in a long arc (m). NaN where it is not known. */
  free_length: number;
  /** Whether the hole ripples: P is below 2.2; false where it is not known. */
  ripples: boolean;
  /**
   * Smallest and largest radius in a long arc that this guide drills at the present weight, with any bit and any rock (m). NaN
   * where it is not known.
   */
  radius_any_bit_low: number;
  radius_any_bit_high: number;
  /** Measured depth from the kick-off (m); the first is that of the bit when the answer was computed. */
  measured_depths: Float64Array;
  /** Inclination (rad), and 5 and 95 % of the plausible tools. */
  inclinations: Float64Array;
  inclinations_low: Float64Array;
  inclinations_high: Float64Array;
  /** Azimuth (rad), and 5 and 95 % of the plausible tools. */
  azimuths: Float64Array;
  azimuths_low: Float64Array;
  azimuths_high: Float64Array;
  /** Position from the kick-off, X horizontal in the plane of the configured hole (m). */
  position_x: Float64Array;
  /** Position, Y horizontal, to the right (m). */
  position_y: Float64Array;
  /** Position, Z down (m). */
  position_z: Float64Array;
  /** Half of the width that 90 % of the plausible tools have across the hole, towards its high side (m). */
  half_width_high: Float64Array;
  /** The same to the right (m). */
  half_width_right: Float64Array;
  /** Plausible tools that were computed, and those without a result. What the latter drill is unknown. */
  members: number;
  failed: number;
  /** Surveys (rig/survey) that the answer rests on: those of the hole that this tool has drilled. */
  surveys_used: number;
  /** How far the bit is beyond the last of them (m); NaN without any. */
  since_survey: number;
  /** Why there is no comparison where the configuration has a plan; empty otherwise. */
  plan_because: string;
  /** Radius around the plan within which the bit is on plan (m). */
  plan_target: number;
  /** Build rate of the plan over the next metre (rad/m). */
  plan_build_rate: number;
  /**
   * By measured_depths, NaN beyond the end of the plan. Distance of the bit from the nearest point of the plan, to the high
   * side (m): above 0 the bit is above the plan.
   */
  plan_high: Float64Array;
  /** The same to the right (m). */
  plan_right: Float64Array;
  /** Inclination less that of the plan at the same measured depth (rad): below 0 the hole builds less than planned. */
  plan_inclination: Float64Array;
  /** Azimuth less that of the plan (rad): above 0 the hole is to the right of it. NaN within 3 deg of the vertical. */
  plan_azimuth: Float64Array;
  /** Share of the plausible tools that stay within plan_target from the bit up to there, 0 to 1. */
  plan_within: Float64Array;
  /**
   * How far the plan is from the middle of the range of the plausible tools, in half widths of that range: the largest of the
   * inclination and, outside plan_target, of the position, from 1 m ahead on. Above 1 the hole leaves its plan.
   */
  plan_off: number;
  /**
   * Where plan_off is above 0.9, the weights from plan_weight_low to plan_weight_high are searched: within a half of the present
   * one and inputs.weight_on_bit.
   */
  plan_weight_low: number;
  plan_weight_high: number;
  /** The weight of these with the smallest plan_off (N), with that and the radius of the next metre (m). NaN where none is known. */
  plan_nearest_weight: number;
  plan_nearest_off: number;
  plan_nearest_radius: number;
  /** The same weight where it brings the hole back to its plan, with a plan_off of at most 0.9 (N); NaN otherwise. */
  plan_weight: number;
  /** Whether plan_off is above 0.9 and no weight brings the hole back. */
  plan_no_weight: boolean;
  /**
   * Whether this guide drills no such hole with any bit, in any rock, at any weight that the inputs allow: the mean build rate of
   * the plan over 5 m is outside kf -+ sqrt(2 p c/EI).
   */
  plan_no_guide: boolean;
  /** Surveys of those used that correct the curvature too, not the direction alone. */
  surveys_learnt: number;
  /**
   * Direction of the hole at the bit by the surveys, with standard deviations (rad): inclination, and azimuth as azimuth is
   * counted. NaN without a survey that is used.
   */
  surveyed_inclination: number;
  surveyed_inclination_deviation: number;
  surveyed_azimuth: number;
  surveyed_azimuth_deviation: number;
  /**
   * How much more the tool builds than as configured, by the surveys, with its standard deviation (rad/m). NaN where none
   * corrects the curvature.
   */
  surveyed_build: number;
  surveyed_build_deviation: number;
  /**
   * Azimuth of the plane of the configured hole (rad), clockwise from the north of plan and surveys: that of the plan at the bit,
   * or else of the surveys; NaN where neither has one.
   */
  plane_azimuth: number;
  /** Measured depth from which on this tool has drilled (m); NaN without surveys. */
  drilled_from: number;
  /** Why surveys are not used, where that is so; empty otherwise. */
  surveys_because: string;
  /**
   * Every survey that is known when the means end, in the order of arrival; a new answer rests on them some seconds later.
   * Measured depth from the kick-off (m).
   */
  survey_depths: Float64Array;
  /** Inclination (rad). */
  survey_inclinations: Float64Array;
  /** Its standard deviation (rad). */
  survey_inclination_deviations: Float64Array;
  /** Azimuth (rad), clockwise from north; NaN of a tool that measures inclinations alone. */
  survey_azimuths: Float64Array;
  /** Its standard deviation (rad); NaN without an azimuth. */
  survey_azimuth_deviations: Float64Array;
}
/** Reads a `flexdrill/msg/HoleAhead`. */
export function decodeHoleAhead(reader: CdrReader): HoleAhead {
  return {
    header: decodeHeader(reader),
    known: reader.bool(),
    because: reader.string(),
    window: reader.float64(),
    turns: reader.uint32(),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    azimuth: reader.float64(),
    side_force_low: reader.float64(),
    side_force_right: reader.float64(),
    side_force_low_error: reader.float64(),
    side_force_right_error: reader.float64(),
    tilt_low: reader.float64(),
    tilt_right: reader.float64(),
    turn_low: reader.float64(),
    turn_right: reader.float64(),
    weight_on_bit: reader.float64(),
    weight_that_cuts: reader.float64(),
    torque: reader.float64(),
    answered: decodeTime(reader),
    side_force_low_at_rest: reader.float64(),
    build_rate: reader.float64(),
    build_rate_low: reader.float64(),
    build_rate_high: reader.float64(),
    walk_rate: reader.float64(),
    walk_rate_low: reader.float64(),
    walk_rate_high: reader.float64(),
    radius: reader.float64(),
    radius_low: reader.float64(),
    radius_high: reader.float64(),
    steering_number: reader.float64(),
    free_length: reader.float64(),
    ripples: reader.bool(),
    radius_any_bit_low: reader.float64(),
    radius_any_bit_high: reader.float64(),
    measured_depths: reader.float64Array(reader.length()),
    inclinations: reader.float64Array(reader.length()),
    inclinations_low: reader.float64Array(reader.length()),
    inclinations_high: reader.float64Array(reader.length()),
    azimuths: reader.float64Array(reader.length()),
    azimuths_low: reader.float64Array(reader.length()),
    azimuths_high: reader.float64Array(reader.length()),
    position_x: reader.float64Array(reader.length()),
    position_y: reader.float64Array(reader.length()),
    position_z: reader.float64Array(reader.length()),
    half_width_high: reader.float64Array(reader.length()),
    half_width_right: reader.float64Array(reader.length()),
    members: reader.uint32(),
    failed: reader.uint32(),
    surveys_used: reader.uint32(),
    since_survey: reader.float64(),
    plan_because: reader.string(),
    plan_target: reader.float64(),
    plan_build_rate: reader.float64(),
    plan_high: reader.float64Array(reader.length()),
    plan_right: reader.float64Array(reader.length()),
    plan_inclination: reader.float64Array(reader.length()),
    plan_azimuth: reader.float64Array(reader.length()),
    plan_within: reader.float64Array(reader.length()),
    plan_off: reader.float64(),
    plan_weight_low: reader.float64(),
    plan_weight_high: reader.float64(),
    plan_nearest_weight: reader.float64(),
    plan_nearest_off: reader.float64(),
    plan_nearest_radius: reader.float64(),
    plan_weight: reader.float64(),
    plan_no_weight: reader.bool(),
    plan_no_guide: reader.bool(),
    surveys_learnt: reader.uint32(),
    surveyed_inclination: reader.float64(),
    surveyed_inclination_deviation: reader.float64(),
    surveyed_azimuth: reader.float64(),
    surveyed_azimuth_deviation: reader.float64(),
    surveyed_build: reader.float64(),
    surveyed_build_deviation: reader.float64(),
    plane_azimuth: reader.float64(),
    drilled_from: reader.float64(),
    surveys_because: reader.string(),
    survey_depths: reader.float64Array(reader.length()),
    survey_inclinations: reader.float64Array(reader.length()),
    survey_inclination_deviations: reader.float64Array(reader.length()),
    survey_azimuths: reader.float64Array(reader.length()),
    survey_azimuth_deviations: reader.float64Array(reader.length()),
  };
}

/**
 * A point of the hole as this tool drills it, from the end of the configured hole on: one message per 20 mm of advance. A
 * point is final. The model stays in its configured hole until the next run; `flexdrill rebase` makes its configuration.
 */
export interface HoleDrilled {
  /**
   * Stamp: the instant of the means of `twin/hole_ahead` at which the point was complete, on the rig's clock; of points that a
   * checkpoint has brought, the start of the run. Frame: the tool.
   */
  header: Header;
  /** Number of the point, from 0 on. Where it is 0 again the motion has begun again, and the hole with it. */
  point: number;
  /** Length of hole of this point (m). */
  length: number;
  /** Length of hole from the end of the configured one to the lower end of this point (m). */
  drilled: number;
  /** Measured depth of the lower end, from the kick-off (m). */
  measured_depth: number;
  /** Inclination there (rad): 0 is straight down. */
  inclination: number;
  /** Azimuth there (rad), clockwise seen from above: 0 is the plane of the configured hole. */
  azimuth: number;
  /** Position there, from the kick-off (m): X horizontal in the plane of the configured hole, Y to its right, Z down. */
  position: Float64Array;
  /** Curvature of the hole over this point (1/m): above 0 the inclination rises. Axes are carried along the hole without twist. */
  build: number;
  /** The same to the right, seen down the hole (1/m). */
  right: number;
  /**
   * Whether the hole ahead was known there. Where it is false the curvatures are those of the newest answer, or of the point
   * above, or of the configured hole.
   */
  known: boolean;
  /** Why it is not known, in one sentence; empty where it is. */
  because: string;
  /** The instant of the means whose answer has these curvatures, on the rig's clock; 0 without one. */
  answered: Time;
}
/** Reads a `flexdrill/msg/HoleDrilled`. */
export function decodeHoleDrilled(reader: CdrReader): HoleDrilled {
  return {
    header: decodeHeader(reader),
    point: reader.uint32(),
    length: reader.float64(),
    drilled: reader.float64(),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    azimuth: reader.float64(),
    position: reader.float64Array(3),
    build: reader.float64(),
    right: reader.float64(),
    known: reader.bool(),
    because: reader.string(),
    answered: decodeTime(reader),
  };
}

/**
 * Deflection of and load on every joint of the flexible pipe. All arrays have one entry per joint, top to bottom:
 * entry 0 is joint_01 of joint_states.
 */
export interface JointDeflections {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Largest bend angle of all joints (rad, >= 0). */
  max_bend_angle: number;
  /** Entry of that joint in the arrays below. */
  max_bend_joint: number;
  /** Number of joints whose bend angle has reached the limit. */
  joints_at_limit: number;
  /** Measured depth from the kick-off (m). */
  measured_depth: Float64Array;
  /** Inclination of the bore there, 0 is straight down (rad). */
  inclination: Float64Array;
  /** Angle between the axes of the two links (rad, >= 0). */
  bend_angle: Float64Array;
  /**
   * Toolface of the bend: the direction in which the lower link turns away, from the high side, clockwise looking down
   * the hole (rad, -pi to pi).
   */
  bend_direction: Float64Array;
  /** Bend angle at which the joint's stop begins (rad). */
  limit_angle: Float64Array;
  /** Moment of the stop (N m, >= 0, zero below the limit). */
  stop_moment: Float64Array;
  /** Horizontal transverse displacement from the bore axis (m). */
  lateral_y: Float64Array;
  /** Displacement from the bore axis towards the low side (m). */
  lateral_z: Float64Array;
  /** Spin rate of the link below the joint (rad/s, positive in the drive's sense). */
  spin_rate: Float64Array;
  /** Axial force through the joint (N, tension positive). */
  axial_force: Float64Array;
  /** Magnitude of the shear force through the joint (N, >= 0). */
  shear_force: Float64Array;
  /** Torque through the joint (N m, positive in the drive's sense). */
  torque: Float64Array;
}
/** Reads a `flexdrill/msg/JointDeflections`. */
export function decodeJointDeflections(reader: CdrReader): JointDeflections {
  return {
    header: decodeHeader(reader),
    max_bend_angle: reader.float64(),
    max_bend_joint: reader.uint32(),
    joints_at_limit: reader.uint32(),
    measured_depth: reader.float64Array(reader.length()),
    inclination: reader.float64Array(reader.length()),
    bend_angle: reader.float64Array(reader.length()),
    bend_direction: reader.float64Array(reader.length()),
    limit_angle: reader.float64Array(reader.length()),
    stop_moment: reader.float64Array(reader.length()),
    lateral_y: reader.float64Array(reader.length()),
    lateral_z: reader.float64Array(reader.length()),
    spin_rate: reader.float64Array(reader.length()),
    axial_force: reader.float64Array(reader.length()),
    shear_force: reader.float64Array(reader.length()),
    torque: reader.float64Array(reader.length()),
  };
}

/**
 * The external forces on the tool, so that a reader can check the balance: supports, weight, wall, bit and loads. At
 * rest they sum to zero; in motion they do so together with inertia and damping. All vectors are along the axes of the
 * frame: X horizontal in the build's direction, Y horizontal, Z down. All figures are of the instant of the stamp.
 */
export interface Reactions {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Torque on the top of the pipe (N m), negative in reverse: the drive's, or below a string the string's. */
  drive_torque: number;
  /** Torque of the rock against the bit (N m), negative in reverse, 0 off bottom. */
  bit_torque: number;
  /** Sum of the forces in the list below (N). */
  support_force: Float64Array;
  /** Weight of both pipes and of the bodies on them, minus buoyancy (N). */
  weight: Float64Array;
  /** Sum of the forces of the wall on the guide pipe, friction included (N). */
  wall_force: Float64Array;
  /** Force of the rock on the tool: the weight on bit, along the axis at the bit (N). */
  bit_force: Float64Array;
  /** Sum of the configured point loads (N). */
  load_force: Float64Array;
  /** Minus mass times acceleration of the whole tool (N). */
  inertia_force: Float64Array;
  /** Damping of the motion of the tool as a whole (N). */
  damping_force: Float64Array;
  /** Sum of the seven forces: the residual of the solver (N). */
  unbalanced_force: Float64Array;
  /**
   * Per support, which holds a pipe in some directions, and last the string above where a hoist carries it: measured depth
   * from the kick-off (m).
   */
  measured_depth: Float64Array;
  /** Inclination of the bore there, 0 is straight down (rad). */
  inclination: Float64Array;
  /** PIPE, GUIDE or STRING. */
  body: Uint8Array;
  /** Force on the pipe, X (N); that of STRING on the guide. */
  force_x: Float64Array;
  /** Force, Y (N). */
  force_y: Float64Array;
  /** Force, Z (N). */
  force_z: Float64Array;
  /** Moment on the pipe about the location, X (N m), without drive_torque; 0 for STRING. */
  moment_x: Float64Array;
  /** Moment, Y (N m). */
  moment_y: Float64Array;
  /** Moment, Z (N m). */
  moment_z: Float64Array;
}
export const Reactions = {
  /** A support of the flexible pipe. */
  PIPE: 0,
  /** A support of the guide pipe. */
  GUIDE: 1,
  /** The string above, which pulls at the top of the guide pipe along the hole. */
  STRING: 2,
} as const;
/** Reads a `flexdrill/msg/Reactions`. */
export function decodeReactions(reader: CdrReader): Reactions {
  return {
    header: decodeHeader(reader),
    drive_torque: reader.float64(),
    bit_torque: reader.float64(),
    support_force: reader.float64Array(3),
    weight: reader.float64Array(3),
    wall_force: reader.float64Array(3),
    bit_force: reader.float64Array(3),
    load_force: reader.float64Array(3),
    inertia_force: reader.float64Array(3),
    damping_force: reader.float64Array(3),
    unbalanced_force: reader.float64Array(3),
    measured_depth: reader.float64Array(reader.length()),
    inclination: reader.float64Array(reader.length()),
    body: reader.uint8Array(reader.length()),
    force_x: reader.float64Array(reader.length()),
    force_y: reader.float64Array(reader.length()),
    force_z: reader.float64Array(reader.length()),
    moment_x: reader.float64Array(reader.length()),
    moment_y: reader.float64Array(reader.length()),
    moment_z: reader.float64Array(reader.length()),
  };
}

/** One quantity of the comparison of rig and twin. */
export interface Residual {
  /** surface_torque, hook_load, downhole_rotary_speed, downhole_torque or downhole_weight_on_bit. */
  name: string;
  /** Unit: N m, N or rad/s. */
  unit: string;
  /** What was measured since the message before, as received; NaN where nothing new came. Of several values the newest. */
  sample: number;
  /** Sliding mean of what was measured; NaN, as all below, while the quantity cannot be judged. */
  measured: number;
  /** The same of what the twin computes, with the tare of the sensor. */
  predicted: number;
  /** The band in which nine of ten means are expected. */
  low: number;
  high: number;
  /** Measured less predicted over half of the band: one of ten lies beyond -1 to 1. */
  ratio: number;
}
/** Reads a `flexdrill/msg/Residual`. */
export function decodeResidual(reader: CdrReader): Residual {
  return {
    name: reader.string(),
    unit: reader.string(),
    sample: reader.float64(),
    measured: reader.float64(),
    predicted: reader.float64(),
    low: reader.float64(),
    high: reader.float64(),
    ratio: reader.float64(),
  };
}

/**
 * What the rig measures less what the twin computes, with the band that is expected. Published every second of model time
 * once rig/measured has brought one of the quantities. Judged in steady motion only: after a change of speed or weight all
 * means are NaN until the string and the auto-driller have settled.
 */
export interface Residuals {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** One per quantity, always in the same order. */
  residuals: Residual[];
  /** Speed and weight are steady, and all inputs are good. */
  steady: boolean;
  /** The bit drills; otherwise it is off bottom. */
  drilling: boolean;
  /** Measured depth of the bit, from the rig's own zero (m); NaN where the rig does not give it. */
  bit_depth: number;
  /**
   * Running estimate, from the surface torque in steady motion, of calibration.friction_factor: the friction in both layers
   * over that of contact.inner and contact.outer, with its 90 % band. Where plausible tools run
   * with the twin, it is theirs by their weights; NaN where they say nothing.
   */
  friction_factor: number;
  friction_factor_low: number;
  friction_factor_high: number;
  /** The same of the offset of the torque's sensor (N m). */
  torque_tare: number;
  torque_tare_low: number;
  torque_tare_high: number;
  /**
   * Why the newest sample changed neither: an input is not good, the motion is not steady, a value is missing, the sample is
   * far from what is expected, or plausible tools have not come to it. Empty where it changed them.
   */
  estimate_frozen: string;
  /** What the residuals that are surely beyond their bands may mean, the likeliest first. */
  likely_causes: string[];
  /** Whether the twin's friction and the tare follow the running estimate (calibration.follow). */
  following: boolean;
  /** Factor on the friction of both layers that acts in the model: calibration.friction_factor in force and as configured. */
  applied_friction_factor: number;
  configured_friction_factor: number;
  /** The same of calibration.torque_tare_nm (N m). */
  applied_torque_tare: number;
  configured_torque_tare: number;
  /** Why both did not move at this comparison, or move no further. Empty where they follow. */
  following_held: string;
}
/** Reads a `flexdrill/msg/Residuals`. */
export function decodeResiduals(reader: CdrReader): Residuals {
  return {
    header: decodeHeader(reader),
    residuals: reader.many(reader.length(), () => decodeResidual(reader)),
    steady: reader.bool(),
    drilling: reader.bool(),
    bit_depth: reader.float64(),
    friction_factor: reader.float64(),
    friction_factor_low: reader.float64(),
    friction_factor_high: reader.float64(),
    torque_tare: reader.float64(),
    torque_tare_low: reader.float64(),
    torque_tare_high: reader.float64(),
    estimate_frozen: reader.string(),
    likely_causes: reader.many(reader.length(), () => reader.string()),
    following: reader.bool(),
    applied_friction_factor: reader.float64(),
    configured_friction_factor: reader.float64(),
    applied_torque_tare: reader.float64(),
    configured_torque_tare: reader.float64(),
    following_held: reader.string(),
  };
}

/**
 * The inputs of the rig with the time of their measurement, for rigs that provide it; the topics rig/rotary_speed_rpm,
 * rig/weight_on_bit_kn, rig/rate_of_penetration and rig/standpipe_pressure carry the numbers alone. Topic rig/inputs.
 */
export interface RigInputs {
  /** Stamp: time of the measurement, on the rig's clock. The age of the input counts from it. Frame: not used. */
  header: Header;
  /** Speed of the top drive (r/min), NaN if not given. */
  rotary_speed_rpm: number;
  /** Weight on bit (kN), NaN if not given. */
  weight_on_bit_kn: number;
  /** Quality of all values: GOOD, SUSPECT or BAD. */
  quality: number;
  /** Sensor or program of origin, for displays; may be empty. */
  source: string;
  /** Rate of penetration (m/h), negative while the tool is pulled back; NaN if not given. */
  rate_of_penetration_m_per_h: number;
  /** Standpipe pressure, inside minus outside at the tool's top (MPa), NaN if not given. */
  standpipe_pressure_mpa: number;
  /**
   * Which of the values are given: a sum of the GIVEN_ constants. With 0 the message does not say so, and a rate or pressure
   * of exactly 0 counts as not given: a program that does not know the field leaves it at 0.
   */
  given: number;
}
export const RigInputs = {
  /** The source considers the values correct. */
  GOOD: 0,
  /** The source has doubts; the twin accepts the values, and the status says so. */
  SUSPECT: 1,
  /** The values are wrong or not measured; the twin refuses them. */
  BAD: 2,
  /** Bits of `given`. */
  GIVEN_ROTARY_SPEED: 1,
  GIVEN_WEIGHT_ON_BIT: 2,
  GIVEN_RATE_OF_PENETRATION: 4,
  GIVEN_STANDPIPE_PRESSURE: 8,
} as const;
/** Reads a `flexdrill/msg/RigInputs`. */
export function decodeRigInputs(reader: CdrReader): RigInputs {
  return {
    header: decodeHeader(reader),
    rotary_speed_rpm: reader.float64(),
    weight_on_bit_kn: reader.float64(),
    quality: reader.uint8(),
    source: reader.string(),
    rate_of_penetration_m_per_h: reader.float64(),
    standpipe_pressure_mpa: reader.float64(),
    given: reader.uint32(),
  };
}

/**
 * What the rig and the tool's own sensors measure besides the inputs that drive the twin. The twin compares these values
 * with its own and never drives the model by them. Every value is optional: NaN where it is not given; see also `given`.
 * Topic rig/measured.
 */
export interface RigMeasured {
  /** Stamp: time of the measurement, on the rig's clock. Frame: not used. */
  header: Header;
  /** Torque of the drive at the surface (N m). */
  surface_torque: number;
  /** Standpipe pressure, inside minus outside at the tool's top (Pa). */
  standpipe_pressure: number;
  /** Load on the hook (N), the weight of the string in the mud minus the weight on bit and the friction along the hole. */
  hook_load: number;
  /** Rate of penetration (m/s), negative while the tool is pulled back. */
  rate_of_penetration: number;
  /** Measured depth of the bit, from the rig's own zero (m). */
  bit_depth: number;
  /** Measured depth of the hole, from the rig's own zero (m). */
  hole_depth: number;
  /** Rotary speed above the bit, measured in the hole (rad/s). */
  downhole_rotary_speed: number;
  /** Torque above the bit, measured in the hole (N m). */
  downhole_torque: number;
  /** Weight on bit, measured in the hole (N). */
  downhole_weight_on_bit: number;
  /** Axial acceleration in the hole, root mean square of the sensor's window (m/s2). */
  axial_vibration: number;
  /** Lateral acceleration in the hole, root mean square of the sensor's window (m/s2). */
  lateral_vibration: number;
  /** Largest axial acceleration in the sensor's window (m/s2). */
  axial_shock: number;
  /** Largest lateral acceleration in the sensor's window (m/s2). */
  lateral_shock: number;
  /** Quality of all values: GOOD, SUSPECT or BAD. */
  quality: number;
  /** Sensor or program of origin, for displays; may be empty. */
  source: string;
  /**
   * Which of the values are given: bit k for value k of the above, the surface torque being value 0. With 0 the message does
   * not say so, and a value of exactly 0 counts as not given: a program that does not know a field leaves it at 0.
   */
  given: number;
}
export const RigMeasured = {
  /** The source considers the values correct. */
  GOOD: 0,
  /** The source has doubts; comparisons leave the values out, and the recording keeps them. */
  SUSPECT: 1,
  /** The values are wrong or not measured. */
  BAD: 2,
} as const;
/** Reads a `flexdrill/msg/RigMeasured`. */
export function decodeRigMeasured(reader: CdrReader): RigMeasured {
  return {
    header: decodeHeader(reader),
    surface_torque: reader.float64(),
    standpipe_pressure: reader.float64(),
    hook_load: reader.float64(),
    rate_of_penetration: reader.float64(),
    bit_depth: reader.float64(),
    hole_depth: reader.float64(),
    downhole_rotary_speed: reader.float64(),
    downhole_torque: reader.float64(),
    downhole_weight_on_bit: reader.float64(),
    axial_vibration: reader.float64(),
    lateral_vibration: reader.float64(),
    axial_shock: reader.float64(),
    lateral_shock: reader.float64(),
    quality: reader.uint8(),
    source: reader.string(),
    given: reader.uint32(),
  };
}

/**
 * A survey: the direction of the hole at a measured depth. Late by metres is normal: the tool that measures sits above the
 * bit. The twin corrects by surveys where the tool drills next (twin/hole_ahead), and never drives the model by them. Topic
 * rig/survey.
 */
export interface RigSurvey {
  /**
   * Stamp: time of the measurement, on the rig's clock; of two surveys of one source at the same depth the newer one counts.
   * Frame: not used.
   */
  header: Header;
  /** Measured depth of the survey, from the rig's own zero (m); well.kick_off_depth is that of the kick-off. */
  measured_depth: number;
  /** Inclination of the hole (rad): 0 is straight down. */
  inclination: number;
  /**
   * Azimuth of the hole (rad), clockwise seen from above, from the same north as the plan; NaN of a tool that measures
   * inclinations alone.
   */
  azimuth: number;
  /** Standard deviation of the inclination (rad). NaN or 0 is the usual one, 0.2 deg. */
  inclination_deviation: number;
  /**
   * Standard deviation of the azimuth (rad). NaN or 0 is the usual one of a magnetic tool: 5 deg down to 10 m below the
   * kick-off, 1 deg below. A gyro has 0.5 deg.
   */
  azimuth_deviation: number;
  /** Quality of all values: GOOD, SUSPECT or BAD. */
  quality: number;
  /** Sensor or program of origin, for displays; may be empty. */
  source: string;
}
export const RigSurvey = {
  /** The source considers the values correct. */
  GOOD: 0,
  /** The source has doubts; the twin does not use the survey, and the recording keeps it. */
  SUSPECT: 1,
  /** The values are wrong or not measured. */
  BAD: 2,
} as const;
/** Reads a `flexdrill/msg/RigSurvey`. */
export function decodeRigSurvey(reader: CdrReader): RigSurvey {
  return {
    header: decodeHeader(reader),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    azimuth: reader.float64(),
    inclination_deviation: reader.float64(),
    azimuth_deviation: reader.float64(),
    quality: reader.uint8(),
    source: reader.string(),
  };
}

/**
 * The map of rotary speed and weight on bit that the node has loaded (map.file): where alarms must be expected, and where
 * not. It belongs to the tool of this run.
 */
export interface SafeWindow {
  /** Stamp: when the run began. Frame: the tool. */
  header: Header;
  /** Title of the configuration that the map was made for. */
  title: string;
  /** The program that made it. */
  program: string;
  /** Hash of what determines the motion of the tool and its alarms. */
  motion: string;
  /** Model time that each run of the map was judged over (s). */
  horizon: number;
  /** Runs per cell and start, at most. */
  members: number;
  /** Chance above which an alarm must be expected. */
  limit: number;
  /** Priority from which on an alarm counts: Alarm.LOW, MEDIUM or HIGH. */
  priority: number;
  /** Rotary speeds of the cells (r/min), rising. */
  rotary_speed_rpm: Float64Array;
  /** Weights on bit of the cells (kN), rising. */
  weight_on_bit_kn: Float64Array;
  /** What each cell is: row by row of the weight, the speed within a row. */
  verdict: Uint8Array;
  /** Largest chance of any alarm over the starts; NaN where the cell was not run or is unknown. */
  chance: Float64Array;
  /** The id of the likeliest alarm of that start; empty where none was seen. */
  alarm: string[];
  /** Whether the cell was run; otherwise its verdict is inferred from those that were. */
  was_run: boolean[];
  /** Fewest and most members that ended at a start that was run; 0 where none ended. A chance is known as well as these say. */
  least_members: number;
  most_members: number;
}
export const SafeWindow = {
  /** From no start must an alarm be expected. */
  CLEAR: 0,
  /** From every start an alarm must be expected. */
  ALARM: 1,
  /** From one start an alarm must be expected, from another not. */
  DEPENDS_ON_START: 2,
  /** A run of it failed: it is not safe. */
  UNKNOWN: 3,
  /** It was not run from some start, and the runs around it do not say with 95 % what it is: it is not safe. */
  NOT_KNOWN: 4,
} as const;
/** Reads a `flexdrill/msg/SafeWindow`. */
export function decodeSafeWindow(reader: CdrReader): SafeWindow {
  return {
    header: decodeHeader(reader),
    title: reader.string(),
    program: reader.string(),
    motion: reader.string(),
    horizon: reader.float64(),
    members: reader.uint32(),
    limit: reader.float64(),
    priority: reader.uint8(),
    rotary_speed_rpm: reader.float64Array(reader.length()),
    weight_on_bit_kn: reader.float64Array(reader.length()),
    verdict: reader.uint8Array(reader.length()),
    chance: reader.float64Array(reader.length()),
    alarm: reader.many(reader.length(), () => reader.string()),
    was_run: reader.many(reader.length(), () => reader.bool()),
    least_members: reader.uint32(),
    most_members: reader.uint32(),
  };
}

/** Configuration and version of a run, so that a recording is self-contained. */
export interface SessionInfo {
  /** Stamp: start of the run on the rig's clock. Frame: the tool, as in all messages of this run. */
  header: Header;
  /** Version of flexdrill. */
  version: string;
  /** SHA-256 of the configuration. */
  config_hash: string;
  /** Model step (s). */
  time_step: number;
  /** Time of model step 0 on the rig's clock. */
  start: Time;
  /** The whole configuration, YAML. */
  configuration: string;
}
/** Reads a `flexdrill/msg/SessionInfo`. */
export function decodeSessionInfo(reader: CdrReader): SessionInfo {
  return {
    header: decodeHeader(reader),
    version: reader.string(),
    config_hash: reader.string(),
    time_step: reader.float64(),
    start: decodeTime(reader),
    configuration: reader.string(),
  };
}

/**
 * Torque, weight and power from the surface to the bit, and where they are lost. All figures are means over the last
 * `duration` seconds, in which every step counts; those ending in `_rms` are root mean squares over the same time.
 * A figure that the tool does not have is NaN: surface torque, hook load and the drive's limit need the string above,
 * surface weight and drag of the string its hoist, the depth of cut a rock that holds the bit.
 * 
 * Signs: a torque is positive where it belongs to forward rotation, and negative in reverse: the drive's, the bit's and
 * every loss, since a loss opposes the rotation. In both senses a torque less the losses below it is the torque below.
 * Powers are positive in both senses, as their names say: put in, or taken.
 * 
 * The tool turns where the mean speed of its top is above a tenth of the speed asked for, of the root mean square of its
 * own speed, and of a turn per minute. Standing, at a stall or swinging to and fro it does not turn, and what is a power
 * over a speed does not exist: it is NaN.
 */
export interface Transfer {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Time that the means cover (s): transfer.window, less at the beginning; 0 before the first tenth of a second. */
  duration: number;
  /** Torque of the top drive (N m). */
  surface_torque: number;
  /** Root mean square of it (N m). */
  surface_torque_rms: number;
  /** Torque on the top of the tool (N m). */
  kickoff_torque: number;
  /** Root mean square of it (N m). */
  kickoff_torque_rms: number;
  /** Torque of the rock against the bit (N m), 0 off bottom. */
  bit_torque: number;
  /** Root mean square of it (N m). */
  bit_torque_rms: number;
  /**
   * Torque at the bit over that at the surface, without a string over that at the kick-off; 0 off bottom. NaN below 1 N m
   * there and while the tool does not turn.
   */
  torque_efficiency: number;
  /**
   * Torque of the rotation that friction between pipe and guide takes (N m): its power over the speed of the tool's top.
   * NaN while the tool does not turn, as for the next two.
   */
  pipe_guide_friction_torque: number;
  /** Torque of the rotation that friction between guide and wall takes (N m), without what the advance takes. */
  guide_wall_friction_torque: number;
  /** Torque of the rotation that the pins of the joints take (N m). */
  joint_friction_torque: number;
  /** Torque that the friction of the wall takes from the string above (N m); it also holds a string that stands. */
  string_friction_torque: number;
  /** Weight that is slacked off at the surface (N): what the hook carries less than off bottom. */
  surface_weight: number;
  /** Root mean square of it (N). */
  surface_weight_rms: number;
  /** Axial force on the guide at the kick-off (N), positive where it pushes down the hole. */
  kickoff_weight: number;
  /** Root mean square of it (N). */
  kickoff_weight_rms: number;
  /** Weight on the bit (N), 0 off bottom. */
  bit_weight: number;
  /** Root mean square of it (N). */
  bit_weight_rms: number;
  /**
   * Load on the hook (N): the weight in mud of the string and of all that hangs on its end, guide and pipe, less what stands
   * on the bottom and on the wall.
   */
  hook_load: number;
  /** Axial friction of the guide on the pipe (N), positive where it pushes up the hole. */
  pipe_guide_axial_drag: number;
  /** Axial friction of the wall on the guide (N), positive where it pushes up the hole. */
  guide_wall_axial_drag: number;
  /** Axial friction of the wall on the string above (N), positive where it pushes up the hole. */
  string_axial_drag: number;
  /** Depth of cut (m per turn), 0 off bottom. */
  depth_of_cut: number;
  /**
   * Rate at which the hole deepens (m/s), never negative: how much deeper than before the bit has come. 0 off bottom, whatever
   * the block does, and while a bit that was lifted is lowered to the bottom again.
   */
  rate_of_penetration: number;
  /** Power put in: of the top drive (W). */
  drive_power: number;
  /** Of the hoist (W). */
  hoist_power: number;
  /** Of the weight on bit (W); below a hoist minus the power that the rock takes along the hole. */
  weight_on_bit_power: number;
  /** Of gravity (W). */
  gravity_power: number;
  /** Of the point loads (W). */
  load_power: number;
  /**
   * Of the advance (W): the friction of the wall times the advance; below a hoist with the weight on bit and less the string's
   * force times the advance, which the displacements of the tool in its frame do not contain.
   */
  feed_power: number;
  /** Of the pressure in the pipe (W). */
  pressure_power: number;
  /** Power taken: by the rock (W). */
  bit_power: number;
  /** By friction in both layers and in the joints (W): the sum of the next three, to the accuracy of a step. */
  friction_power: number;
  /** By friction between pipe and guide (W). */
  pipe_guide_friction_power: number;
  /** By friction between guide and wall (W). */
  guide_wall_friction_power: number;
  /** By friction in the joints (W). */
  joint_friction_power: number;
  /** By the damping of contacts, stops and joints with play (W). */
  contact_damping_power: number;
  /** By Rayleigh damping (W). */
  rayleigh_damping_power: number;
  /** By the time integration (W). */
  numerical_damping_power: number;
  /** By the string above, to friction on the wall and to the mud (W). */
  string_power: number;
  /** Of updating the axial force in the geometric stiffness (W), positive when put in. */
  axial_update_power: number;
  /** Stored as motion and deformation (W), negative when it is released. */
  stored_power: number;
  /** Put in, less taken, less stored (W): the error of the energy audit. */
  error_power: number;
  /** By the mud that moves with pipe and guide (W): power taken, part of the same balance. */
  mud_power: number;
  /** Share of the time (0 to 1) in which the torque of the top drive was at its limit: the speed asked for is then not kept. */
  drive_at_limit: number;
  /**
   * Share of a weight at the kick-off (0 to 1) that reaches the bit when only the sliding friction of a clean hole in the arc
   * takes from it.
   */
  weight_arrives: number;
}
/** Reads a `flexdrill/msg/Transfer`. */
export function decodeTransfer(reader: CdrReader): Transfer {
  return {
    header: decodeHeader(reader),
    duration: reader.float64(),
    surface_torque: reader.float64(),
    surface_torque_rms: reader.float64(),
    kickoff_torque: reader.float64(),
    kickoff_torque_rms: reader.float64(),
    bit_torque: reader.float64(),
    bit_torque_rms: reader.float64(),
    torque_efficiency: reader.float64(),
    pipe_guide_friction_torque: reader.float64(),
    guide_wall_friction_torque: reader.float64(),
    joint_friction_torque: reader.float64(),
    string_friction_torque: reader.float64(),
    surface_weight: reader.float64(),
    surface_weight_rms: reader.float64(),
    kickoff_weight: reader.float64(),
    kickoff_weight_rms: reader.float64(),
    bit_weight: reader.float64(),
    bit_weight_rms: reader.float64(),
    hook_load: reader.float64(),
    pipe_guide_axial_drag: reader.float64(),
    guide_wall_axial_drag: reader.float64(),
    string_axial_drag: reader.float64(),
    depth_of_cut: reader.float64(),
    rate_of_penetration: reader.float64(),
    drive_power: reader.float64(),
    hoist_power: reader.float64(),
    weight_on_bit_power: reader.float64(),
    gravity_power: reader.float64(),
    load_power: reader.float64(),
    feed_power: reader.float64(),
    pressure_power: reader.float64(),
    bit_power: reader.float64(),
    friction_power: reader.float64(),
    pipe_guide_friction_power: reader.float64(),
    guide_wall_friction_power: reader.float64(),
    joint_friction_power: reader.float64(),
    contact_damping_power: reader.float64(),
    rayleigh_damping_power: reader.float64(),
    numerical_damping_power: reader.float64(),
    string_power: reader.float64(),
    axial_update_power: reader.float64(),
    stored_power: reader.float64(),
    error_power: reader.float64(),
    mud_power: reader.float64(),
    drive_at_limit: reader.float64(),
    weight_arrives: reader.float64(),
  };
}

/** Health of the twin. The sequence is its heartbeat: when it stops, the twin has stopped. */
export interface TwinStatus {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Heartbeat: one more in every message. */
  sequence: number;
  /** STARTING, RUNNING, PAUSED or FAILED. */
  state: number;
  /** Model time since the start or the last reset (s). */
  model_time: number;
  /** Model steps since the start or the last reset. */
  step_count: number;
  /** Model step (s). */
  time_step: number;
  /**
   * Model time gained per second of wall time, over the last second; 1 keeps up. NaN until the model has run for a second
   * since the start, a pause or a failed step.
   */
  real_time_factor: number;
  /** How far the model is behind its deadlines now (s, >= 0). */
  lateness: number;
  /** Steps that ended after their deadline. */
  deadline_misses: number;
  /** Steps skipped because the model was late; those of a pause or after a failed step are in steps_stood_still. */
  steps_skipped: number;
  /** Median computing time of a step in the last interval (s). */
  step_time_p50: number;
  /** 99th percentile of the computing time of a step in the last interval (s). */
  step_time_p99: number;
  /** Longest computing time of a step in the last interval (s). */
  step_time_max: number;
  /** Mean Newton iterations per step in the last interval. */
  newton_iterations_mean: number;
  /** Sub-steps rejected since the start. */
  rejected_steps: number;
  /** Steps that were halved since the start. */
  halved_steps: number;
  /** Steps that failed at the smallest sub-step since the start. */
  failed_steps: number;
  /** Cause of the last rejection, empty if there was none. */
  last_rejection_cause: string;
  /** Station of the last rejection, 0 is the uppermost. */
  last_rejection_station: number;
  /** Measured depth of that station from the kick-off (m). */
  last_rejection_measured_depth: number;
  /** Work put in, minus energy taken out, minus energy stored since the start (J); zero is exact. */
  energy_error: number;
  /** Magnitude of energy_error divided by the drive's work. */
  energy_error_ratio: number;
  /** RECORDING_OFF, RECORDING_ON or RECORDING_FAILED. */
  recording_state: number;
  /** File of the recording, empty if none. */
  recording_path: string;
  /** Messages in the recording's files, without the newest ones that are not written yet. */
  recording_messages: number;
  /** Messages that the recording lost, including those in a file whose sync the disk refused. */
  recording_drops: number;
  /** SHA-256 of the configuration that the run began with; changed_parameter has what differs from it. */
  config_hash: string;
  /** Version of flexdrill. */
  version: string;
  /**
   * Per input: rotary_speed, weight_on_bit; then rate_of_penetration and standpipe_pressure where the tool uses them, a
   * value other than zero is assumed, or a sample arrived.
   */
  input_name: string[];
  /** INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE, INPUT_REJECTED or INPUT_ASSUMED. */
  input_state: Uint8Array;
  /** Time since the newest good sample (s), NaN if there was none. */
  input_age: Float64Array;
  /** Newest sample as received, in SI (rad/s, N), NaN if there was none. */
  input_received: Float64Array;
  /** Value that acts on the model, in SI (rad/s, N). */
  input_applied: Float64Array;
  /** Samples refused since the start. */
  input_rejected: number[];
  /** Per output: topic with namespace. */
  output_topic: string[];
  /** Messages sent since the start. */
  output_sent: number[];
  /** Messages lost since the start. */
  output_dropped: number[];
  /**
   * Per phase of a step: its name. assembly, contact, solve, energy, analysis, snapshot and other make up the solver's
   * time; publish is the time of encoding and sending, on another thread.
   */
  phase_name: string[];
  /** Mean time per step in the last interval (s). */
  phase_time: Float64Array;
  /** How far the motion can be trusted: QUALITY_GOOD, QUALITY_DEGRADED or QUALITY_POOR. */
  model_quality: number;
  /**
   * Why it is not GOOD, with value and bound, or that it is not judged yet; and what it does not see: a soft guide that rings
   * on the wall. Empty if there is nothing to say.
   */
  model_quality_cause: string;
  /**
   * Energy error of the steps over the last 10 s, magnitudes added, divided by the energy that contact, Rayleigh and
   * numerical damping dissipated in that time; zero is exact.
   */
  energy_error_share: number;
  /** DDS: whether it is up, and how often it was restarted since the start. */
  dds_up: boolean;
  dds_restarts: number;
  /** Cause of the last restart; empty if there was none. */
  dds_restart_cause: string;
  /**
   * Topic, node, address and id of reliable readers that did not read their samples within the last minute; empty if there
   * are none.
   */
  dds_stalled_reader: string;
  /** Other nodes on the network with the name of this one, with address and id. */
  namesake: string[];
  /** Time by which the system clock was set since the start (s). Stamps follow the clock as it was at the start. */
  clock_set_by: number;
  /** Per input: the publisher that drives it, as node @ host (id of its DDS writer); empty while there is none. */
  input_driver: string[];
  /** Per input: all publishers with a sample within its max_age, the one that drives first, separated by commas. */
  input_publishers: string[];
  /** Per input: two or more publishers send it at once. */
  input_several_drivers: boolean[];
  /** Per input: samples refused because their publisher does not drive. */
  input_not_driving: number[];
  /** Per input: samples whose bytes do not match the topic's type. */
  input_unreadable: number[];
  /** Per input: without a good sample for so long that the model is on the ramp to the safe value, or has reached it. */
  input_safe: boolean[];
  /** Per input: source that the newest good sample names, empty if it names none. */
  input_source: string[];
  /** Per input: the source has doubts about the newest good sample. */
  input_suspect: boolean[];
  /**
   * Snapshots that were dropped since the start because the publisher's thread was too late: their outputs were neither
   * sent nor recorded.
   */
  frames_dropped: number;
  /** Changes of the inputs that were lost for the same reason: a recording of this run cannot be replayed exactly. */
  events_lost: number;
  /**
   * Per input: samples that arrived faster than the node read them since the start: the oldest of 256 waiting samples were
   * dropped.
   */
  input_overrun: number[];
  /** Step in which the motion is computed: the model step, or a half or a quarter of it (s). */
  step_in_force: number;
  /** Step that the motion requires (s); shorter than the one in force where the machine is too slow for it. */
  step_wanted: number;
  /**
   * Pace of the model relative to the clock, judged over ten seconds and with hysteresis: PACE_NOT_JUDGED, PACE_KEPT,
   * PACE_LATE or PACE_FAR_BEHIND. Lateness concerns the computer, not drilling.
   */
  pace: number;
  /**
   * Model time gained per second of wall time over the last ten seconds, from which pace is judged. NaN until the model
   * has run for ten seconds.
   */
  pace_factor: number;
  /** Why messages are missing in the recording, with the count of each cause; empty if none is missing. */
  recording_drops_cause: string;
  /** Steps during which the model stood still: paused, or after a failed step. */
  steps_stood_still: number;
  /** Values on which motion or alarms depend and that a client has changed since the start, each with the configured value. */
  changed_parameter: string[];
  /** Surveys of the hole (rig/survey) that are taken into account, also those of an earlier run. */
  surveys_known: number;
  /** Surveys below the bit of the configuration: they wait for a run with that hole as drilled. */
  surveys_waiting: number;
  /** Surveys refused since the start. */
  surveys_refused: number;
}
export const TwinStatus = {
  /** The tool is being brought to rest under gravity and weight on bit. */
  STARTING: 0,
  /** Model time advances. */
  RUNNING: 1,
  /** Paused by service. */
  PAUSED: 2,
  /** The model stands still because a step failed; reset it. */
  FAILED: 3,
  /** No sample has arrived yet: the twin runs on its configured start values. */
  INPUT_NOT_RECEIVED: 0,
  /** The newest sample is fresh. */
  INPUT_OK: 1,
  /** The newest sample is later than expected, but not yet stale. */
  INPUT_SLOW: 2,
  /** The newest sample is too old: the value is held, then brought to the safe value. */
  INPUT_STALE: 3,
  /** The newest sample was refused; the last good value is held. */
  INPUT_REJECTED: 4,
  /** An optional input of which no sample has arrived: the twin runs on its configured constant. */
  INPUT_ASSUMED: 5,
  /** Not recording. */
  RECORDING_OFF: 0,
  /** Recording to recording_path. */
  RECORDING_ON: 1,
  /**
   * The recording stopped on an error; earlier messages are kept. It continues in another file as soon as the disk allows
   * it, and is then RECORDING_ON again.
   */
  RECORDING_FAILED: 2,
  /** With such errors of the steps, runs agree with a finer step within about a tenth in ripple and forces. */
  QUALITY_GOOD: 0,
  /** With such errors, runs differ by more; model_quality_cause gives the reason. */
  QUALITY_DEGRADED: 1,
  /** With such errors, runs differ by a sixth up to several times: an alarm. The whirl analysis lowers its confidences. */
  QUALITY_POOR: 2,
  /** Not judged: the model has run for less than ten seconds since the start, a pause or a failed step. */
  PACE_NOT_JUDGED: 0,
  /** The model keeps up with the clock. */
  PACE_KEPT: 1,
  /** The model gains less than 0.98 s per second and skips the rest. */
  PACE_LATE: 2,
  /** It gains less than 0.9 s per second. */
  PACE_FAR_BEHIND: 3,
} as const;
/** Reads a `flexdrill/msg/TwinStatus`. */
export function decodeTwinStatus(reader: CdrReader): TwinStatus {
  return {
    header: decodeHeader(reader),
    sequence: reader.uint64(),
    state: reader.uint8(),
    model_time: reader.float64(),
    step_count: reader.uint64(),
    time_step: reader.float64(),
    real_time_factor: reader.float64(),
    lateness: reader.float64(),
    deadline_misses: reader.uint64(),
    steps_skipped: reader.uint64(),
    step_time_p50: reader.float64(),
    step_time_p99: reader.float64(),
    step_time_max: reader.float64(),
    newton_iterations_mean: reader.float64(),
    rejected_steps: reader.uint64(),
    halved_steps: reader.uint64(),
    failed_steps: reader.uint64(),
    last_rejection_cause: reader.string(),
    last_rejection_station: reader.uint32(),
    last_rejection_measured_depth: reader.float64(),
    energy_error: reader.float64(),
    energy_error_ratio: reader.float64(),
    recording_state: reader.uint8(),
    recording_path: reader.string(),
    recording_messages: reader.uint64(),
    recording_drops: reader.uint64(),
    config_hash: reader.string(),
    version: reader.string(),
    input_name: reader.many(reader.length(), () => reader.string()),
    input_state: reader.uint8Array(reader.length()),
    input_age: reader.float64Array(reader.length()),
    input_received: reader.float64Array(reader.length()),
    input_applied: reader.float64Array(reader.length()),
    input_rejected: reader.many(reader.length(), () => reader.uint64()),
    output_topic: reader.many(reader.length(), () => reader.string()),
    output_sent: reader.many(reader.length(), () => reader.uint64()),
    output_dropped: reader.many(reader.length(), () => reader.uint64()),
    phase_name: reader.many(reader.length(), () => reader.string()),
    phase_time: reader.float64Array(reader.length()),
    model_quality: reader.uint8(),
    model_quality_cause: reader.string(),
    energy_error_share: reader.float64(),
    dds_up: reader.bool(),
    dds_restarts: reader.uint64(),
    dds_restart_cause: reader.string(),
    dds_stalled_reader: reader.string(),
    namesake: reader.many(reader.length(), () => reader.string()),
    clock_set_by: reader.float64(),
    input_driver: reader.many(reader.length(), () => reader.string()),
    input_publishers: reader.many(reader.length(), () => reader.string()),
    input_several_drivers: reader.many(reader.length(), () => reader.bool()),
    input_not_driving: reader.many(reader.length(), () => reader.uint64()),
    input_unreadable: reader.many(reader.length(), () => reader.uint64()),
    input_safe: reader.many(reader.length(), () => reader.bool()),
    input_source: reader.many(reader.length(), () => reader.string()),
    input_suspect: reader.many(reader.length(), () => reader.bool()),
    frames_dropped: reader.uint64(),
    events_lost: reader.uint64(),
    input_overrun: reader.many(reader.length(), () => reader.uint64()),
    step_in_force: reader.float64(),
    step_wanted: reader.float64(),
    pace: reader.uint8(),
    pace_factor: reader.float64(),
    recording_drops_cause: reader.string(),
    steps_stood_still: reader.uint64(),
    changed_parameter: reader.many(reader.length(), () => reader.string()),
    surveys_known: reader.uint64(),
    surveys_waiting: reader.uint64(),
    surveys_refused: reader.uint64(),
  };
}

/** A rotary speed and a weight on bit to be tried in a look-ahead. */
export interface WhatIfCandidate {
  /** Rotary speed (r/min), within inputs.rotary_speed of the configuration. */
  rotary_speed: number;
  /** Weight on bit (kN), within inputs.weight_on_bit of the configuration. */
  weight_on_bit: number;
  /** How fast the speed changes on the way there (r/min per s); 0: as fast as the configuration's slew limit. */
  speed_ramp: number;
  /** How fast the weight changes on the way there (kN/s); 0: as fast as the configuration's slew limit. */
  weight_ramp: number;
}
/** Reads a `flexdrill/msg/WhatIfCandidate`. */
export function decodeWhatIfCandidate(reader: CdrReader): WhatIfCandidate {
  return {
    rotary_speed: reader.float64(),
    weight_on_bit: reader.float64(),
    speed_ramp: reader.float64(),
    weight_ramp: reader.float64(),
  };
}

/** What a look-ahead says of one candidate. */
export interface WhatIfAnswer {
  /** Which. */
  candidate: WhatIfCandidate;
  /** Time of the way to the candidate's speed and weight, before the horizon (s); NaN where they were not reached. */
  run_up: number;
  /** Members that count: those up to the first number at which every alarm is decided. */
  members: number;
  /**
   * Members among them whose motion could not be computed to the end. They are in no probability: what would have come is
   * unknown, not safe.
   */
  failed: number;
  /** Why the first of these failed, or why there is no member at all; empty where none did. */
  failure: string;
  /**
   * Whether the members decide every alarm: a sequential test between a chance of a tenth or less and one of a half or more,
   * with a risk of 5 % for either error.
   */
  decided: boolean;
  /** Chance that a member saw any alarm, with its 95 % interval (Wilson); NaN where no member ended. */
  any_alarm: number;
  any_alarm_lower: number;
  any_alarm_upper: number;
  /** The alarms that a member saw, with each priority. */
  alarms: AlarmChance[];
  /** The continuous figures. */
  figures: FigureBand[];
  /** Members by the worst quality of their computed motion. */
  quality_good: number;
  quality_degraded: number;
  quality_poor: number;
  /** Whether it is known. Where it is false, all below is NaN. */
  hole_known: boolean;
  /** Why it is not known, in one sentence; empty where it is. */
  hole_because: string;
  /** Radius of the hole over the next metre, with 5 and 95 % of the plausible tools (m); infinite where it is straight. */
  hole_radius: number;
  hole_radius_low: number;
  hole_radius_high: number;
  /** Distance of the bit from the plan (well.plan.stations) at hole_plan_ahead (m); NaN without a plan that is compared. */
  hole_plan_distance: number;
  /** How far ahead of the bit that is: 5 m, or less where the plan ends before (m). */
  hole_plan_ahead: number;
  /**
   * Plausible tools that the members are runs of, each from its own state, drawn by their weights; 0 where they are runs of
   * the twin. A tool that is drawn again has another disturbance.
   */
  tools: number;
  /** Factors on the friction: a fifth lower and higher. */
  friction_factors: Float64Array;
  /** Members with that friction, those among them that failed, and those that saw any alarm. */
  friction_members: Uint32Array;
  friction_failed: Uint32Array;
  friction_any_alarm: Uint32Array;
}
/** Reads a `flexdrill/msg/WhatIfAnswer`. */
export function decodeWhatIfAnswer(reader: CdrReader): WhatIfAnswer {
  return {
    candidate: decodeWhatIfCandidate(reader),
    run_up: reader.float64(),
    members: reader.uint32(),
    failed: reader.uint32(),
    failure: reader.string(),
    decided: reader.bool(),
    any_alarm: reader.float64(),
    any_alarm_lower: reader.float64(),
    any_alarm_upper: reader.float64(),
    alarms: reader.many(reader.length(), () => decodeAlarmChance(reader)),
    figures: reader.many(reader.length(), () => decodeFigureBand(reader)),
    quality_good: reader.uint32(),
    quality_degraded: reader.uint32(),
    quality_poor: reader.uint32(),
    hole_known: reader.bool(),
    hole_because: reader.string(),
    hole_radius: reader.float64(),
    hole_radius_low: reader.float64(),
    hole_radius_high: reader.float64(),
    hole_plan_distance: reader.float64(),
    hole_plan_ahead: reader.float64(),
    tools: reader.uint32(),
    friction_factors: reader.float64Array(reader.length()),
    friction_members: reader.uint32Array(reader.length()),
    friction_failed: reader.uint32Array(reader.length()),
    friction_any_alarm: reader.uint32Array(reader.length()),
  };
}

/** Whirl at every watched station. All arrays have one entry per watched station and pipe. */
export interface WhirlState {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** Measured depth from the kick-off (m). */
  measured_depth: Float64Array;
  /** Inclination of the bore there, 0 is straight down (rad). */
  inclination: Float64Array;
  /** PIPE or GUIDE. */
  body: Uint8Array;
  /** NONE, FORWARD, BACKWARD, CHAOTIC or JOINT_VIBRATION. */
  kind: Uint8Array;
  /** Rate of the orbit (rad/s, positive in the sense of the rotation). */
  whirl_rate: Float64Array;
  /**
   * Rate of the orbit divided by the rotary speed; NaN where the motion has no single whirl rate and while the tool does
   * not turn.
   */
  whirl_ratio: Float64Array;
  /** Root mean square radius about the running mean (m). */
  orbit_radius: Float64Array;
  /** Largest distance from the centre of the gap in the window, divided by the clearance. */
  clearance_ratio: Float64Array;
  /** Share of the window in contact (0 to 1). */
  contact_duty: Float64Array;
  /** Confidence in the kind (0 to 1); it is lower while an input is not OK. */
  confidence: Float64Array;
  /** Level at this station: OK, WATCH, WARNING or CRITICAL of WhirlWarning. */
  severity: Uint8Array;
  /**
   * Backward whirl of the driven pipe: rate divided by that of rolling without slip, - spin d / (D - d). 1 rolls, a
   * smaller value slides, 0 is no such whirl.
   */
  rolling_share: Float64Array;
  /**
   * Counted turns about the centre of the gap per turn of the tool, positive in the sense of the rotation; NaN while the
   * tool stands.
   */
  gap_turns: Float64Array;
  /** Bending cycles per turn of the tool due to whirl of one rate; 0 elsewhere. */
  bending_cycles: Float64Array;
  /** Largest impulse above the resting one in the window (N s). */
  impulse: Float64Array;
  /** Impacts of at least 1 N s per second (1/s). */
  impact_rate: Float64Array;
  /** Work of the friction per second and metre of the tool (W/m). */
  friction_power: Float64Array;
}
export const WhirlState = {
  /**
   * No whirl: at rest, along a line, a small orbit off the centre of the gap, or a motion that repeats itself turn by turn
   * without circling the centre.
   */
  NONE: 0,
  /** The orbit turns in the sense of the rotation. */
  FORWARD: 1,
  /** The orbit turns against the rotation. */
  BACKWARD: 2,
  /** Large motion without a steady direction that does not repeat itself. */
  CHAOTIC: 3,
  /**
   * A small orbit at twice the tool's speed that does not circle the centre of the gap: the cross of the joint drives it.
   * D-WIS defines the other kinds and has no term for this one.
   */
  JOINT_VIBRATION: 4,
  /** The flexible pipe. */
  PIPE: 0,
  /** The guide pipe. */
  GUIDE: 1,
} as const;
/** Reads a `flexdrill/msg/WhirlState`. */
export function decodeWhirlState(reader: CdrReader): WhirlState {
  return {
    header: decodeHeader(reader),
    measured_depth: reader.float64Array(reader.length()),
    inclination: reader.float64Array(reader.length()),
    body: reader.uint8Array(reader.length()),
    kind: reader.uint8Array(reader.length()),
    whirl_rate: reader.float64Array(reader.length()),
    whirl_ratio: reader.float64Array(reader.length()),
    orbit_radius: reader.float64Array(reader.length()),
    clearance_ratio: reader.float64Array(reader.length()),
    contact_duty: reader.float64Array(reader.length()),
    confidence: reader.float64Array(reader.length()),
    severity: reader.uint8Array(reader.length()),
    rolling_share: reader.float64Array(reader.length()),
    gap_turns: reader.float64Array(reader.length()),
    bending_cycles: reader.float64Array(reader.length()),
    impulse: reader.float64Array(reader.length()),
    impact_rate: reader.float64Array(reader.length()),
    friction_power: reader.float64Array(reader.length()),
  };
}

/**
 * The level of the whirl warning, sent when it changes. Latched: of several received messages, the one with the highest
 * sequence is valid.
 */
export interface WhirlWarning {
  /** Stamp: model time on the rig's clock. Frame: the tool. */
  header: Header;
  /** OK, WATCH, WARNING or CRITICAL. */
  severity: number;
  /** NONE, FORWARD, BACKWARD, CHAOTIC or JOINT_VIBRATION. */
  kind: number;
  /** PIPE or GUIDE. */
  body: number;
  /** Measured depth from the kick-off (m). */
  measured_depth: number;
  /** Inclination of the bore there, 0 is straight down (rad). */
  inclination: number;
  /** Evidence: rate of the orbit divided by the rotary speed; NaN where there is none. */
  whirl_ratio: number;
  /** Evidence: largest distance from the centre of the gap, divided by the clearance. */
  clearance_ratio: number;
  /** Evidence: share of the window in contact (0 to 1). */
  contact_duty: number;
  /** Length of the window of the evidence (s). */
  window: number;
  /** When this level was reached, on the rig's clock. */
  since: Time;
  /**
   * The worst state of the inputs that the tool uses: INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE or
   * INPUT_REJECTED.
   */
  input_quality: number;
  /** Number of changes so far, of the level, its station and kind, or of the trust in the inputs. */
  sequence: number;
  /** The warning as one sentence for an operator. */
  message: string;
  /** Evidence: largest normal force in the window (N). */
  peak_force: number;
  /**
   * Evidence: backward whirl of the driven pipe, rate divided by that of rolling without slip, - spin d / (D - d). 1
   * rolls, a smaller value slides, 0 is no such whirl.
   */
  rolling_share: number;
  /** Confidence in the kind (0 to 1); it is lower while an input is not OK. */
  confidence: number;
}
export const WhirlWarning = {
  /** No action is needed. */
  OK: 0,
  /** The driller should watch it. */
  WATCH: 1,
  /** Action is needed soon. */
  WARNING: 2,
  /** Action is needed now. */
  CRITICAL: 3,
  /**
   * No whirl: at rest, along a line, a small orbit off the centre of the gap, or a motion that repeats itself turn by turn
   * without circling the centre.
   */
  NONE: 0,
  /** The orbit turns in the sense of the rotation. */
  FORWARD: 1,
  /** The orbit turns against the rotation. */
  BACKWARD: 2,
  /** Large motion without a steady direction that does not repeat itself. */
  CHAOTIC: 3,
  /**
   * A small orbit at twice the tool's speed that does not circle the centre of the gap: the cross of the joint drives it.
   * D-WIS defines the other kinds and has no term for this one.
   */
  JOINT_VIBRATION: 4,
  /** The flexible pipe. */
  PIPE: 0,
  /** The guide pipe. */
  GUIDE: 1,
  /** No sample has arrived yet: the twin runs on its configured start values. */
  INPUT_NOT_RECEIVED: 0,
  /** The newest sample is fresh. */
  INPUT_OK: 1,
  /** The newest sample is later than expected, but not yet stale. */
  INPUT_SLOW: 2,
  /** The newest sample is too old: the value is held, then brought to the safe value. */
  INPUT_STALE: 3,
  /** The newest sample was refused; the last good value is held. */
  INPUT_REJECTED: 4,
  /** An optional input of which no sample has arrived: the twin runs on its configured constant. */
  INPUT_ASSUMED: 5,
} as const;
/** Reads a `flexdrill/msg/WhirlWarning`. */
export function decodeWhirlWarning(reader: CdrReader): WhirlWarning {
  return {
    header: decodeHeader(reader),
    severity: reader.uint8(),
    kind: reader.uint8(),
    body: reader.uint8(),
    measured_depth: reader.float64(),
    inclination: reader.float64(),
    whirl_ratio: reader.float64(),
    clearance_ratio: reader.float64(),
    contact_duty: reader.float64(),
    window: reader.float64(),
    since: decodeTime(reader),
    input_quality: reader.uint8(),
    sequence: reader.uint64(),
    message: reader.string(),
    peak_force: reader.float64(),
    rolling_share: reader.float64(),
    confidence: reader.float64(),
  };
}

export interface MeshFile {
  filename: string;
  data: Uint8Array;
}
/** Reads a `visualization_msgs/msg/MeshFile`. */
export function decodeMeshFile(reader: CdrReader): MeshFile {
  return {
    filename: reader.string(),
    data: reader.uint8Array(reader.length()),
  };
}

export interface UVCoordinate {
  u: number;
  v: number;
}
/** Reads a `visualization_msgs/msg/UVCoordinate`. */
export function decodeUVCoordinate(reader: CdrReader): UVCoordinate {
  return {
    u: reader.float32(),
    v: reader.float32(),
  };
}

export interface CompressedImage {
  header: Header;
  format: string;
  data: Uint8Array;
}
/** Reads a `sensor_msgs/msg/CompressedImage`. */
export function decodeCompressedImage(reader: CdrReader): CompressedImage {
  return {
    header: decodeHeader(reader),
    format: reader.string(),
    data: reader.uint8Array(reader.length()),
  };
}

export interface Duration {
  sec: number;
  nanosec: number;
}
/** Reads a `builtin_interfaces/msg/Duration`. */
export function decodeDuration(reader: CdrReader): Duration {
  return {
    sec: reader.int32(),
    nanosec: reader.uint32(),
  };
}

export interface ColorRGBA {
  r: number;
  g: number;
  b: number;
  a: number;
}
/** Reads a `std_msgs/msg/ColorRGBA`. */
export function decodeColorRGBA(reader: CdrReader): ColorRGBA {
  return {
    r: reader.float32(),
    g: reader.float32(),
    b: reader.float32(),
    a: reader.float32(),
  };
}

export interface Vector3 {
  x: number;
  y: number;
  z: number;
}
/** Reads a `geometry_msgs/msg/Vector3`. */
export function decodeVector3(reader: CdrReader): Vector3 {
  return {
    x: reader.float64(),
    y: reader.float64(),
    z: reader.float64(),
  };
}

export interface Quaternion {
  x: number;
  y: number;
  z: number;
  w: number;
}
/** Reads a `geometry_msgs/msg/Quaternion`. */
export function decodeQuaternion(reader: CdrReader): Quaternion {
  return {
    x: reader.float64(),
    y: reader.float64(),
    z: reader.float64(),
    w: reader.float64(),
  };
}

export interface Point {
  x: number;
  y: number;
  z: number;
}
/** Reads a `geometry_msgs/msg/Point`. */
export function decodePoint(reader: CdrReader): Point {
  return {
    x: reader.float64(),
    y: reader.float64(),
    z: reader.float64(),
  };
}

export interface Pose {
  position: Point;
  orientation: Quaternion;
}
/** Reads a `geometry_msgs/msg/Pose`. */
export function decodePose(reader: CdrReader): Pose {
  return {
    position: decodePoint(reader),
    orientation: decodeQuaternion(reader),
  };
}

export interface Marker {
  header: Header;
  ns: string;
  id: number;
  type: number;
  action: number;
  pose: Pose;
  scale: Vector3;
  color: ColorRGBA;
  lifetime: Duration;
  frame_locked: boolean;
  points: Point[];
  colors: ColorRGBA[];
  texture_resource: string;
  texture: CompressedImage;
  uv_coordinates: UVCoordinate[];
  text: string;
  mesh_resource: string;
  mesh_file: MeshFile;
  mesh_use_embedded_materials: boolean;
}
export const Marker = {
  ARROW: 0,
  CUBE: 1,
  SPHERE: 2,
  CYLINDER: 3,
  LINE_STRIP: 4,
  LINE_LIST: 5,
  CUBE_LIST: 6,
  SPHERE_LIST: 7,
  POINTS: 8,
  TEXT_VIEW_FACING: 9,
  MESH_RESOURCE: 10,
  TRIANGLE_LIST: 11,
  ARROW_STRIP: 12,
  ADD: 0,
  MODIFY: 0,
  DELETE: 2,
  DELETEALL: 3,
} as const;
/** Reads a `visualization_msgs/msg/Marker`. */
export function decodeMarker(reader: CdrReader): Marker {
  return {
    header: decodeHeader(reader),
    ns: reader.string(),
    id: reader.int32(),
    type: reader.int32(),
    action: reader.int32(),
    pose: decodePose(reader),
    scale: decodeVector3(reader),
    color: decodeColorRGBA(reader),
    lifetime: decodeDuration(reader),
    frame_locked: reader.bool(),
    points: reader.many(reader.length(), () => decodePoint(reader)),
    colors: reader.many(reader.length(), () => decodeColorRGBA(reader)),
    texture_resource: reader.string(),
    texture: decodeCompressedImage(reader),
    uv_coordinates: reader.many(reader.length(), () => decodeUVCoordinate(reader)),
    text: reader.string(),
    mesh_resource: reader.string(),
    mesh_file: decodeMeshFile(reader),
    mesh_use_embedded_materials: reader.bool(),
  };
}

export interface MarkerArray {
  markers: Marker[];
}
/** Reads a `visualization_msgs/msg/MarkerArray`. */
export function decodeMarkerArray(reader: CdrReader): MarkerArray {
  return {
    markers: reader.many(reader.length(), () => decodeMarker(reader)),
  };
}

/** Decoders by the name of the schema. */
export const DECODERS = {
  "flexdrill/msg/Ageing": decodeAgeing,
  "flexdrill/msg/Alarm": decodeAlarm,
  "flexdrill/msg/AlarmChance": decodeAlarmChance,
  "flexdrill/msg/AlarmEvent": decodeAlarmEvent,
  "flexdrill/msg/AlarmList": decodeAlarmList,
  "flexdrill/msg/AppliedInputs": decodeAppliedInputs,
  "flexdrill/msg/Bands": decodeBands,
  "flexdrill/msg/BitState": decodeBitState,
  "flexdrill/msg/ContactForces": decodeContactForces,
  "flexdrill/msg/FigureBand": decodeFigureBand,
  "flexdrill/msg/Forecast": decodeForecast,
  "flexdrill/msg/ForecastBand": decodeForecastBand,
  "flexdrill/msg/HoleAhead": decodeHoleAhead,
  "flexdrill/msg/HoleDrilled": decodeHoleDrilled,
  "flexdrill/msg/JointDeflections": decodeJointDeflections,
  "flexdrill/msg/Reactions": decodeReactions,
  "flexdrill/msg/Residual": decodeResidual,
  "flexdrill/msg/Residuals": decodeResiduals,
  "flexdrill/msg/RigInputs": decodeRigInputs,
  "flexdrill/msg/RigMeasured": decodeRigMeasured,
  "flexdrill/msg/RigSurvey": decodeRigSurvey,
  "flexdrill/msg/SafeWindow": decodeSafeWindow,
  "flexdrill/msg/SessionInfo": decodeSessionInfo,
  "flexdrill/msg/Transfer": decodeTransfer,
  "flexdrill/msg/TwinStatus": decodeTwinStatus,
  "flexdrill/msg/WhatIfAnswer": decodeWhatIfAnswer,
  "flexdrill/msg/WhatIfCandidate": decodeWhatIfCandidate,
  "flexdrill/msg/WhirlState": decodeWhirlState,
  "flexdrill/msg/WhirlWarning": decodeWhirlWarning,
  "visualization_msgs/msg/MarkerArray": decodeMarkerArray,
} as const;
