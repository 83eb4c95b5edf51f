// Four by four matrices in columns, as WebGL takes them, and the camera that moves around the tool.

export type Vec3 = [number, number, number];

function multiply(a: Float32Array, b: Float32Array): Float32Array {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      out[4 * column + row] = sum;
    }
  }
  return out;
}

function subtract(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function normalise(a: Vec3): Vec3 {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const FIELD_OF_VIEW = 0.6;

/** A camera on a sphere around a point. World: X in the build's direction, Y to the right of it, Z down. */
export class Camera {
  target: Vec3 = [0, 0, 0];
  distance = 8;
  /** Turn about the vertical; 0 looks against Y, so that X is to the right (rad). */
  yaw = 0.3;
  /** Height over the horizontal (rad). */
  pitch = 0.25;

  get eye(): Vec3 {
    const flat = Math.cos(this.pitch) * this.distance;
    return [
      this.target[0] + Math.sin(this.yaw) * flat,
      this.target[1] + Math.cos(this.yaw) * flat,
      this.target[2] - Math.sin(this.pitch) * this.distance,
    ];
  }

  turn(yaw: number, pitch: number): void {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -1.5), 1.5);
  }

  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance * factor, 0.4), 60);
  }

  /** Moves the target in the picture's plane, by parts of its height. */
  pan(right: number, down: number): void {
    const forward = normalise(subtract(this.target, this.eye));
    const side = normalise(cross(forward, [0, 0, -1]));
    const up = cross(side, forward);
    const scale = 2 * this.distance * Math.tan(FIELD_OF_VIEW / 2);
    for (const axis of [0, 1, 2] as const) this.target[axis] += (-right * side[axis] + down * up[axis]) * scale;
  }

  /** Puts points in the picture as large as they fit. */
  frame(points: Float32Array, aspect: number): void {
    const low: Vec3 = [Infinity, Infinity, Infinity];
    const high: Vec3 = [-Infinity, -Infinity, -Infinity];
    for (let index = 0; index < points.length; index++) {
      const axis = index % 3;
      low[axis] = Math.min(low[axis], points[index]);
      high[axis] = Math.max(high[axis], points[index]);
    }
    this.target = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
    const width = Math.hypot(high[0] - low[0], high[1] - low[1]);
    const height = high[2] - low[2];
    // Room for arrows and labels around the line itself.
    this.distance = (Math.max(height, width / aspect) / 2 + 0.4) / Math.tan(FIELD_OF_VIEW / 2);
  }

  /** From the world to the picture. */
  matrix(aspect: number): Float32Array {
    const eye = this.eye;
    const back = normalise(subtract(eye, this.target));
    const side = normalise(cross([0, 0, -1], back));
    const up = cross(back, side);
    // prettier-ignore
    const view = new Float32Array([
      side[0], up[0], back[0], 0,
      side[1], up[1], back[1], 0,
      side[2], up[2], back[2], 0,
      -dot(side, eye), -dot(up, eye), -dot(back, eye), 1,
    ]);
    const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
    const near = this.distance / 50;
    const far = this.distance * 6 + 20;
    // prettier-ignore
    const projection = new Float32Array([
      f / aspect, 0, 0, 0,
      0, f, 0, 0,
      0, 0, (far + near) / (near - far), -1,
      0, 0, (2 * far * near) / (near - far), 0,
    ]);
    return multiply(projection, view);
  }
}

/** Where a point of the world is in a picture of that size (pixels); null behind the camera. */
export function project(matrix: Float32Array, point: Vec3, width: number, height: number): [number, number] | null {
  const [x, y, z] = point;
  const w = matrix[3] * x + matrix[7] * y + matrix[11] * z + matrix[15];
  if (w <= 0) return null;
  const px = (matrix[0] * x + matrix[4] * y + matrix[8] * z + matrix[12]) / w;
  const py = (matrix[1] * x + matrix[5] * y + matrix[9] * z + matrix[13]) / w;
  return [((px + 1) / 2) * width, ((1 - py) / 2) * height];
}
