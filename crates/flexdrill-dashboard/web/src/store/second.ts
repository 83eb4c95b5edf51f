// One second as it runs: newest values, means, and the largest that were in it.

import type { Layout, Scalar, Vector } from "./layout";

/** Columns that keep the largest value of their second. */
const LARGEST: readonly (Scalar | Vector)[] = [
  "bit_speed_max",
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
  "joint_bend_angle",
  "joint_stop_moment",
  "pipe_guide_normal_peak",
  "guide_wall_normal_peak",
];

export class Second {
  /** The second that runs; what has not been heard in it is NaN. */
  readonly row: Float32Array;
  private readonly ended: Float32Array;
  /** Newest value of every column, of whatever second. */
  private readonly last: Float32Array;
  private readonly shown: Float32Array;
  private count = 0;
  private readonly sums = new Map<Scalar, number>();

  constructor(private readonly layout: Layout) {
    this.row = new Float32Array(layout.stride).fill(NaN);
    this.ended = this.row.slice();
    this.last = this.row.slice();
    this.shown = this.row.slice();
  }

  /** The newest value of a column. */
  set(name: Scalar, value: number): void {
    this.row[this.layout.offset(name)] = value;
  }

  setAll(name: Vector, values: ArrayLike<number>): void {
    this.row.set(values, this.layout.offset(name));
  }

  /** Entry `index` of a column of several. */
  setAt(name: Vector, index: number, value: number): void {
    this.row[this.layout.offset(name) + index] = value;
  }

  /** A value of a column that keeps the largest. */
  largest(name: Scalar | Vector, value: number, index = 0): void {
    const at = this.layout.offset(name) + index;
    if (!(this.row[at] >= value)) this.row[at] = value;
  }

  smallest(name: Scalar, value: number): void {
    const at = this.layout.offset(name);
    if (!(this.row[at] <= value)) this.row[at] = value;
  }

  /** Values of one message whose columns keep the mean. */
  means(values: Partial<Record<Scalar, number>>): void {
    this.count++;
    for (const [name, value] of Object.entries(values) as [Scalar, number][]) {
      const sum = (this.sums.get(name) ?? 0) + value;
      this.sums.set(name, sum);
      this.set(name, sum / this.count);
    }
  }

  /** Ends the second: nothing has been heard in the next one, so that a topic that stops leaves a gap in the hour. */
  end(): void {
    this.ended.set(this.row);
    this.keep();
    this.row.fill(NaN);
    this.count = 0;
    this.sums.clear();
  }

  /** Forgets all of it. */
  clear(): void {
    this.row.fill(NaN);
    this.ended.fill(NaN);
    this.last.fill(NaN);
    this.count = 0;
    this.sums.clear();
  }

  private keep(): void {
    const { row, last } = this;
    for (let index = 0; index < row.length; index++) if (!Number.isNaN(row[index])) last[index] = row[index];
  }

  /** What is shown as the newest: largest values are those of the running second and the one before. */
  live(): Float32Array {
    const { row, shown, ended, layout } = this;
    this.keep();
    shown.set(this.last);
    for (const name of LARGEST) {
      const column = layout.find(name);
      if (!column) continue;
      for (let index = column.offset; index < column.offset + column.length; index++) {
        shown[index] = Number.isNaN(row[index]) || ended[index] > row[index] ? ended[index] : row[index];
      }
    }
    const low = layout.offset("bit_speed_min");
    shown[low] = Number.isNaN(row[low]) || ended[low] < row[low] ? ended[low] : row[low];
    return shown;
  }
}
