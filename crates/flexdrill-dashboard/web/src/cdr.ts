// Common Data Representation, little endian, as ROS 2 sends it (XCDR1: eight-byte values on multiples of eight).

/** Bytes of the encapsulation header before the first field; alignment counts from behind it. */
const HEADER = 4;

/** Reads one message, field by field. */
export class CdrReader {
  private readonly buffer: ArrayBuffer;
  private readonly view: DataView;
  private position = 0;

  /**
   * Of `data`, which begins with the encapsulation header.
   *
   * Throws when the header is not that of little endian CDR.
   */
  constructor(data: DataView) {
    if (data.byteLength < HEADER || data.getUint8(0) !== 0 || data.getUint8(1) !== 1) {
      throw new Error(`not little endian CDR: ${data.byteLength} bytes`);
    }
    const start = data.byteOffset + HEADER;
    // A copy begins on a multiple of eight, so that arrays of numbers can be looked at in place.
    this.buffer = data.buffer.slice(start, data.byteOffset + data.byteLength) as ArrayBuffer;
    this.view = new DataView(this.buffer);
  }

  /**
   * Where the next value of `size` bytes is; negative at the message's end: a message of an older version ends before
   * its newer fields, which are then zero or empty.
   */
  private next(size: number, count = 1): number {
    const at = Math.ceil(this.position / size) * size;
    if (at >= this.buffer.byteLength) return -1;
    const end = at + size * count;
    if (end > this.buffer.byteLength) {
      throw new Error(`message ends at byte ${this.buffer.byteLength}, a field needs ${end}`);
    }
    this.position = end;
    return at;
  }

  bool(): boolean {
    return this.uint8() !== 0;
  }
  uint8(): number {
    const at = this.next(1);
    return at < 0 ? 0 : this.view.getUint8(at);
  }
  int8(): number {
    const at = this.next(1);
    return at < 0 ? 0 : this.view.getInt8(at);
  }
  uint16(): number {
    const at = this.next(2);
    return at < 0 ? 0 : this.view.getUint16(at, true);
  }
  int16(): number {
    const at = this.next(2);
    return at < 0 ? 0 : this.view.getInt16(at, true);
  }
  uint32(): number {
    const at = this.next(4);
    return at < 0 ? 0 : this.view.getUint32(at, true);
  }
  int32(): number {
    const at = this.next(4);
    return at < 0 ? 0 : this.view.getInt32(at, true);
  }
  /** As a number: exact up to 2^53. */
  uint64(): number {
    const at = this.next(8);
    return at < 0 ? 0 : this.view.getUint32(at + 4, true) * 2 ** 32 + this.view.getUint32(at, true);
  }
  /** As a number: exact up to 2^53. */
  int64(): number {
    const at = this.next(8);
    return at < 0 ? 0 : this.view.getInt32(at + 4, true) * 2 ** 32 + this.view.getUint32(at, true);
  }
  float32(): number {
    const at = this.next(4);
    return at < 0 ? 0 : this.view.getFloat32(at, true);
  }
  float64(): number {
    const at = this.next(8);
    return at < 0 ? 0 : this.view.getFloat64(at, true);
  }
  /** A string: its length with the zero at its end, then UTF-8. */
  string(): string {
    const length = this.uint32();
    if (length === 0) return "";
    const at = this.next(1, length);
    if (at < 0) throw new Error("message ends before a string's text");
    return new TextDecoder().decode(new Uint8Array(this.buffer, at, length - 1));
  }

  /** Length of a sequence. */
  length(): number {
    return this.uint32();
  }

  /** `count` values that are no plain numbers. */
  many<T>(count: number, read: () => T): T[] {
    if (count > this.buffer.byteLength) throw new Error(`a sequence of ${count} in ${this.buffer.byteLength} bytes`);
    return Array.from({ length: count }, read);
  }

  uint8Array(count: number): Uint8Array {
    return new Uint8Array(this.buffer, ...this.range(1, count));
  }
  int8Array(count: number): Int8Array {
    return new Int8Array(this.buffer, ...this.range(1, count));
  }
  uint16Array(count: number): Uint16Array {
    return new Uint16Array(this.buffer, ...this.range(2, count));
  }
  int16Array(count: number): Int16Array {
    return new Int16Array(this.buffer, ...this.range(2, count));
  }
  uint32Array(count: number): Uint32Array {
    return new Uint32Array(this.buffer, ...this.range(4, count));
  }
  int32Array(count: number): Int32Array {
    return new Int32Array(this.buffer, ...this.range(4, count));
  }
  float32Array(count: number): Float32Array {
    return new Float32Array(this.buffer, ...this.range(4, count));
  }
  float64Array(count: number): Float64Array {
    return new Float64Array(this.buffer, ...this.range(8, count));
  }

  /** Offset and length of an array in the buffer. An empty one has no alignment of its own. */
  private range(size: number, count: number): [number, number] {
    if (count === 0) return [0, 0];
    const at = this.next(size, count);
    if (at < 0) throw new Error("message ends before an array's values");
    return [at, count];
  }
}
