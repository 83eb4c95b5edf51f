// Rows of numbers with their times, the newest so many of them. Allocated once.

export class Ring {
  readonly times: Float64Array;
  private readonly data: Float32Array;
  private head = 0;
  private count = 0;

  constructor(
    readonly capacity: number,
    readonly stride: number,
  ) {
    this.times = new Float64Array(capacity);
    this.data = new Float32Array(capacity * stride);
  }

  get length(): number {
    return this.count;
  }

  clear(): void {
    this.head = 0;
    this.count = 0;
  }

  /** A new row at `time` (s), not before the newest one; filled by the caller. */
  push(time: number): Float32Array {
    const slot = this.head;
    this.times[slot] = time;
    this.head = (this.head + 1) % this.capacity;
    this.count = Math.min(this.count + 1, this.capacity);
    return this.data.subarray(slot * this.stride, (slot + 1) * this.stride);
  }

  /** Removes the rows that are not before `time` (s). */
  cut(time: number): void {
    while (this.count > 0 && this.time(this.count - 1) >= time) {
      this.head = (this.head - 1 + this.capacity) % this.capacity;
      this.count--;
    }
  }

  private slot(index: number): number {
    return (this.head - this.count + index + this.capacity) % this.capacity;
  }

  /** Time of a row (s); 0 is the oldest. */
  time(index: number): number {
    return this.times[this.slot(index)];
  }

  /** A row in place; 0 is the oldest. */
  row(index: number): Float32Array {
    const slot = this.slot(index);
    return this.data.subarray(slot * this.stride, (slot + 1) * this.stride);
  }

  /** One number of a row. */
  value(index: number, column: number): number {
    return this.data[this.slot(index) * this.stride + column];
  }

  /** Index of the newest row that is not after `time`; -1 when all are. */
  before(time: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time(middle) <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
}
