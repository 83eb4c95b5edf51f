// Tubes and arrows as triangles: position and normal, six numbers a vertex.

import { cross, normalise, type Vec3 } from "./matrix";

/** Sides of a tube. */
const SIDES = 16;
const SIDES_OF_ARROW = 6;

/** Triangles that grow as they are needed and are filled anew for each picture. */
export class Mesh {
  data = new Float32Array(6 * 1024);
  count = 0;

  clear(): void {
    this.count = 0;
  }

  private vertex(x: number, y: number, z: number, nx: number, ny: number, nz: number): void {
    const at = 6 * this.count++;
    if (at + 6 > this.data.length) {
      const larger = new Float32Array(2 * this.data.length);
      larger.set(this.data);
      this.data = larger;
    }
    this.data[at] = x;
    this.data[at + 1] = y;
    this.data[at + 2] = z;
    this.data[at + 3] = nx;
    this.data[at + 4] = ny;
    this.data[at + 5] = nz;
  }

  /** A tube along `points` (x, y, z each) with a radius; `across` and `low` span the plane across it at each point. */
  tube(points: Float32Array, across: Float32Array, low: Float32Array, radius: number, from = 0, to = -1): void {
    const end = to < 0 ? points.length / 3 - 1 : to;
    for (let index = from; index < end; index++) {
      for (let side = 0; side < SIDES; side++) {
        const corners = [
          [index, side],
          [index + 1, side],
          [index, side + 1],
          [index, side + 1],
          [index + 1, side],
          [index + 1, side + 1],
        ];
        for (const [at, turn] of corners) this.onTube(points, across, low, radius, at, turn);
      }
    }
  }

  private onTube(
    points: Float32Array,
    across: Float32Array,
    low: Float32Array,
    radius: number,
    index: number,
    side: number,
  ): void {
    const angle = (2 * Math.PI * side) / SIDES;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const at = 3 * index;
    const nx = cos * across[at] + sin * low[at];
    const ny = cos * across[at + 1] + sin * low[at + 1];
    const nz = cos * across[at + 2] + sin * low[at + 2];
    this.vertex(points[at] + radius * nx, points[at + 1] + radius * ny, points[at + 2] + radius * nz, nx, ny, nz);
  }

  /** A short thick piece of tube about a point, along `axis`. */
  collar(centre: Vec3, axis: Vec3, radius: number, length: number): void {
    const side = normalise(cross(axis, Math.abs(axis[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0]));
    const other = cross(axis, side);
    const half = length / 2;
    const rim = (turn: number, end: number): [Vec3, Vec3] => {
      const angle = (2 * Math.PI * turn) / SIDES;
      const normal = [0, 1, 2].map((k) => Math.cos(angle) * side[k] + Math.sin(angle) * other[k]) as Vec3;
      return [[0, 1, 2].map((k) => centre[k] + radius * normal[k] + end * axis[k]) as Vec3, normal];
    };
    for (let turn = 0; turn < SIDES; turn++) {
      const wall: [number, number][] = [
        [turn, -half],
        [turn + 1, -half],
        [turn, half],
        [turn, half],
        [turn + 1, -half],
        [turn + 1, half],
      ];
      for (const [at, end] of wall) {
        const [p, n] = rim(at, end);
        this.vertex(...p, ...n);
      }
      for (const end of [-half, half]) {
        const facing = (end > 0 ? axis : axis.map((value) => -value)) as Vec3;
        this.vertex(...(centre.map((value, k) => value + end * axis[k]) as Vec3), ...facing);
        const order = end > 0 ? [turn, turn + 1] : [turn + 1, turn];
        for (const at of order) this.vertex(...rim(at, end)[0], ...facing);
      }
    }
  }

  /** An arrow from `tail` to `tip`. */
  arrow(tail: Vec3, tip: Vec3, width: number): void {
    const axis = normalise([tip[0] - tail[0], tip[1] - tail[1], tip[2] - tail[2]]);
    const length = Math.hypot(tip[0] - tail[0], tip[1] - tail[1], tip[2] - tail[2]);
    const head = Math.min(length, 5 * width);
    const side = normalise(cross(axis, Math.abs(axis[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0]));
    const other = cross(axis, side);
    const ring = (turn: number, along: number, radius: number): [Vec3, Vec3] => {
      const angle = (2 * Math.PI * turn) / SIDES_OF_ARROW;
      const normal = [0, 1, 2].map((k) => Math.cos(angle) * side[k] + Math.sin(angle) * other[k]) as Vec3;
      return [[0, 1, 2].map((k) => tail[k] + along * axis[k] + radius * normal[k]) as Vec3, normal];
    };
    const neck = length - head;
    for (let turn = 0; turn < SIDES_OF_ARROW; turn++) {
      const quad: [number, number][] = [
        [turn, 0],
        [turn + 1, 0],
        [turn, neck],
        [turn, neck],
        [turn + 1, 0],
        [turn + 1, neck],
      ];
      for (const [at, along] of quad) {
        const [p, n] = ring(at, along, width / 2);
        this.vertex(...p, ...n);
      }
      for (const [at, along, radius] of [
        [turn, neck, 1.6 * width],
        [turn + 1, neck, 1.6 * width],
        [turn, length, 0],
      ] as const) {
        const [p, n] = ring(at, along, radius);
        this.vertex(...p, ...n);
      }
    }
  }
}
