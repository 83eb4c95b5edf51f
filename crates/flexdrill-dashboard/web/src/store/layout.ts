// How one second of the tool is laid out: a row of numbers, the same as in the server's history.

/** How many of each the tool has. */
export interface Counts {
  stations: number;
  joints: number;
  watched: number;
}

/** Columns of one number. The server's history has all but the impulses of shock. */
export const SCALARS = [
  "time",
  "state",
  "real_time_factor",
  "model_quality",
  "rotary_speed_state",
  "weight_on_bit_state",
  "rotary_speed_received",
  "rotary_speed_applied",
  "weight_on_bit_received",
  "weight_on_bit_applied",
  "bit_speed_min",
  "bit_speed_mean",
  "bit_speed_max",
  "bit_torque_mean",
  "bit_torque_max",
  "stick_slip_index",
  "stick_slip_severity",
  "max_pipe_guide_force",
  "max_guide_wall_force",
  "shock_severity",
  "pipe_guide_shock",
  "guide_wall_shock",
  "max_bend_angle",
  "joints_at_limit",
  "unacknowledged_alarms",
  "worst_alarm_priority",
] as const;
export type Scalar = (typeof SCALARS)[number];

const PER_JOINT = ["joint_bend_angle", "joint_stop_moment", "joint_lateral_y", "joint_lateral_z"] as const;
const PER_STATION = [
  "pipe_guide_normal_peak",
  "guide_wall_normal_peak",
  "contact_state",
  "pipe_y",
  "pipe_z",
  "guide_y",
  "guide_z",
] as const;
const PER_WATCHED = ["whirl_kind", "whirl_severity", "whirl_ratio", "clearance_ratio", "contact_duty"] as const;
export type Vector = (typeof PER_JOINT)[number] | (typeof PER_STATION)[number] | (typeof PER_WATCHED)[number];

/** Where each column is in a row. */
export class Layout {
  readonly stride: number;
  private readonly columns = new Map<string, { offset: number; length: number }>();

  constructor(readonly counts: Counts) {
    let offset = 0;
    const add = (names: readonly string[], length: number) => {
      for (const name of names) {
        this.columns.set(name, { offset, length });
        offset += length;
      }
    };
    add(SCALARS, 1);
    add(PER_JOINT, counts.joints);
    add(PER_STATION, counts.stations);
    add(PER_WATCHED, counts.watched);
    this.stride = offset;
  }

  offset(name: Scalar | Vector): number {
    return this.columns.get(name)?.offset ?? 0;
  }

  /** A column by a name that may not be one of ours. */
  find(name: string): { offset: number; length: number } | undefined {
    return this.columns.get(name);
  }

  scalar(row: Float32Array, name: Scalar): number {
    return row[this.offset(name)];
  }

  /** The part of a row that a column takes, in place. */
  vector(row: Float32Array, name: Vector): Float32Array {
    const { offset, length } = this.columns.get(name) ?? { offset: 0, length: 0 };
    return row.subarray(offset, offset + length);
  }
}
