// Tubes, collars and arrows as triangles: vertices of position and normal, six numbers each, and their indices. Corners
// are shared, since a machine without graphics hardware pays for each of them.

import { cross, normalise, type Vec3 } from "./matrix";

/** Sides of a tube and of an arrow. */
const SIDES = 16;
const SIDES_OF_ARROW = 5;

const circle = (sides: number): [number, number][] =>
  Array.from({ length: sides + 1 }, (_, side) => {
    const angle = (2 * Math.PI * side) / sides;
    return [Math.cos(angle), Math.sin(angle)];
  });
const ROUND = circle(SIDES);
const ROUND_ARROW = circle(SIDES_OF_ARROW);

/** A growing buffer of triangles that is refilled for each picture. */
export class Mesh {
  vertices = new Float32Array(6 * 512);
  indices = new Uint32Array(1024);
  vertexCount = 0;
  indexCount = 0;

  clear(): void {
    this.vertexCount = 0;
    this.indexCount = 0;
  }

  private vertex(x: number, y: number, z: number, nx: number, ny: number, nz: number): void {
    const at = 6 * this.vertexCount++;
    if (at + 6 > this.vertices.length) {
      const larger = new Float32Array(2 * this.vertices.length);
      larger.set(this.vertices);
      this.vertices = larger;
    }
    const out = this.vertices;
    out[at] = x;
    out[at + 1] = y;
    out[at + 2] = z;
    out[at + 3] = nx;
    out[at + 4] = ny;
    out[at + 5] = nz;
  }

  private triangle(a: number, b: number, c: number): void {
    const at = this.indexCount;
    if (at + 3 > this.indices.length) {
      const larger = new Uint32Array(2 * this.indices.length);
      larger.set(this.indices);
      this.indices = larger;
    }
    this.indices[at] = a;
    this.indices[at + 1] = b;
    this.indices[at + 2] = c;
    this.indexCount += 3;
  }

  /** Joins two rings of vertices that begin at `a` and `b`. */
  private join(a: number, b: number, sides: number): void {
    for (let side = 0; side < sides; side++) {
      this.triangle(a + side, b + side, a + side + 1);
      this.triangle(a + side + 1, b + side, b + side + 1);
    }
  }

  /** A tube along `points` (x, y, z each) with a radius; `across` and `low` span the plane across it at each point. */
  tube(points: Float32Array, across: Float32Array, low: Float32Array, radius: number): void {
    const first = this.vertexCount;
    const count = points.length / 3;
    for (let index = 0; index < count; index++) {
      const at = 3 * index;
      for (const [cos, sin] of ROUND) {
        const nx = cos * across[at] + sin * low[at];
        const ny = cos * across[at + 1] + sin * low[at + 1];
        const nz = cos * across[at + 2] + sin * low[at + 2];
        this.vertex(points[at] + radius * nx, points[at + 1] + radius * ny, points[at + 2] + radius * nz, nx, ny, nz);
      }
    }
    const ring = SIDES + 1;
    for (let index = 0; index + 1 < count; index++) this.join(first + index * ring, first + (index + 1) * ring, SIDES);
  }

  /** A ring of vertices about a point, across `axis`; normals point outward, or along `facing` where it is given. */
  private ring(
    centre: Vec3,
    side: Vec3,
    other: Vec3,
    radius: number,
    round: [number, number][],
    facing: Vec3 | null,
  ): number {
    const first = this.vertexCount;
    for (const [cos, sin] of round) {
      const nx = cos * side[0] + sin * other[0];
      const ny = cos * side[1] + sin * other[1];
      const nz = cos * side[2] + sin * other[2];
      const [fx, fy, fz] = facing ?? [nx, ny, nz];
      this.vertex(centre[0] + radius * nx, centre[1] + radius * ny, centre[2] + radius * nz, fx, fy, fz);
    }
    return first;
  }

  /** A short thick piece of tube about a point, along `axis`. */
  collar(centre: Vec3, axis: Vec3, radius: number, length: number): void {
    const [side, other] = plane(axis);
    const upper = along(centre, axis, -length / 2);
    const lower = along(centre, axis, length / 2);
    const a = this.ring(upper, side, other, radius, ROUND, null);
    const b = this.ring(lower, side, other, radius, ROUND, null);
    this.join(a, b, SIDES);
    const back: Vec3 = [-axis[0], -axis[1], -axis[2]];
    for (const [at, facing] of [
      [upper, back],
      [lower, axis],
    ] as const) {
      const middle = this.vertexCount;
      this.vertex(...at, ...facing);
      const rim = this.ring(at, side, other, radius, ROUND, facing);
      for (let turn = 0; turn < SIDES; turn++) {
        if (facing === axis) this.triangle(middle, rim + turn, rim + turn + 1);
        else this.triangle(middle, rim + turn + 1, rim + turn);
      }
    }
  }

  /** An arrow from `tail` to `tip`. */
  arrow(tail: Vec3, tip: Vec3, width: number): void {
    const span: Vec3 = [tip[0] - tail[0], tip[1] - tail[1], tip[2] - tail[2]];
    const axis = normalise(span);
    const length = Math.hypot(...span);
    const neck = along(tail, axis, length - Math.min(length, 5 * width));
    const [side, other] = plane(axis);
    const a = this.ring(tail, side, other, width / 2, ROUND_ARROW, null);
    const b = this.ring(neck, side, other, width / 2, ROUND_ARROW, null);
    this.join(a, b, SIDES_OF_ARROW);
    const rim = this.ring(neck, side, other, 1.6 * width, ROUND_ARROW, null);
    const point = this.ring(tip, side, other, 0, ROUND_ARROW, null);
    this.join(rim, point, SIDES_OF_ARROW);
  }
}

/** Two directions across an axis. */
function plane(axis: Vec3): [Vec3, Vec3] {
  const side = normalise(cross(axis, Math.abs(axis[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0]));
  return [side, cross(axis, side)];
}

function along(point: Vec3, axis: Vec3, by: number): Vec3 {
  return [point[0] + by * axis[0], point[1] + by * axis[1], point[2] + by * axis[2]];
}
