// The tool as meshes: both pipes and the bore with clearances drawn larger than they are, joints, forces, whirl.
//
// Displacements and clearances are enlarged alike, radii of the pipe are not: what touches in the model touches in the
// picture.

import type { Tool } from "../api";
import type { Geometry } from "../store/geometry";
import type { Moment } from "../store/store";
import type { Vec3 } from "./matrix";
import { roundUp } from "../ticks";
import { Mesh } from "./mesh";

/** Longest arrow (m). */
const ARROW = 0.5;
/** What is taken for a tool whose sizes are not known yet (m). */
const TYPICAL = { pipe_radius_outer: 0.0315, pipe_clearance: 0.0085, guide_clearance: 0.008 };

/** Something to be named in the picture. */
export interface Label {
  at: Vec3;
  text: string;
  level: number;
}

export class ToolMeshes {
  readonly bore = new Mesh();
  readonly guide = new Mesh();
  readonly pipe = new Mesh();
  readonly joints = new Mesh();
  readonly stopped = new Mesh();
  readonly pipeGuide = new Mesh();
  readonly guideWall = new Mesh();
  /** Rings at whirling places, by severity. */
  readonly whirl = [new Mesh(), new Mesh(), new Mesh(), new Mesh()];
  readonly chosen = new Mesh();
  labels: Label[] = [];
  /** Axis of the pipe at the stations. */
  pipeLine = new Float32Array(0);
  /** Force of the longest arrow (N). */
  fullForce = 1000;
  private guideLine = new Float32Array(0);
  private across = new Float32Array(0);
  private low = new Float32Array(0);

  all(): Mesh[] {
    return [
      this.bore,
      this.guide,
      this.pipe,
      this.joints,
      this.stopped,
      this.pipeGuide,
      this.guideWall,
      ...this.whirl,
      this.chosen,
    ];
  }

  /** Rebuilds all meshes for one instant. */
  build(moment: Moment, geometry: Geometry, tool: Tool | null, factor: number, chosen: number | null): void {
    const { layout, row } = moment;
    const sizes = tool ?? TYPICAL;
    const stations = layout.counts.stations;
    if (this.pipeLine.length !== 3 * stations) this.allocate(geometry, stations);
    this.place(this.pipeLine, geometry, layout.vector(row, "pipe_y"), layout.vector(row, "pipe_z"), factor);
    this.place(this.guideLine, geometry, layout.vector(row, "guide_y"), layout.vector(row, "guide_z"), factor);
    const pipeRadius = sizes.pipe_radius_outer;
    const guideRadius = pipeRadius + sizes.pipe_clearance * factor;
    const boreRadius = guideRadius + sizes.guide_clearance * factor;
    for (const mesh of this.all()) mesh.clear();
    this.bore.tube(geometry.stationPosition, this.across, this.low, boreRadius);
    this.guide.tube(this.guideLine, this.across, this.low, guideRadius);
    this.pipe.tube(this.pipeLine, this.across, this.low, pipeRadius);
    const bend = layout.vector(row, "joint_bend_angle");
    for (let joint = 0; joint < layout.counts.joints; joint++) {
      const station = geometry.jointStation[joint];
      const stopped = bend[joint] >= geometry.jointLimit;
      const mesh = stopped ? this.stopped : this.joints;
      const radius = pipeRadius * (stopped ? 1.8 : 1.25);
      mesh.collar(point(this.pipeLine, station), this.axis(geometry, station), radius, stopped ? 0.05 : 0.03);
    }
    this.forces(moment, geometry, pipeRadius, guideRadius, boreRadius);
    this.whirling(moment, geometry, guideRadius);
    if (chosen !== null && chosen < stations) {
      this.chosen.collar(
        point(geometry.stationPosition, chosen),
        this.axis(geometry, chosen),
        boreRadius * 1.04,
        0.025,
      );
    }
  }

  private allocate(geometry: Geometry, stations: number): void {
    this.pipeLine = new Float32Array(3 * stations);
    this.guideLine = new Float32Array(3 * stations);
    this.across = new Float32Array(3 * stations);
    this.low = new Float32Array(3 * stations);
    for (let station = 0; station < stations; station++) {
      const angle = geometry.stationInclination[station];
      this.across.set([0, 1, 0], 3 * station);
      this.low.set([-Math.cos(angle), 0, Math.sin(angle)], 3 * station);
    }
  }

  private place(out: Float32Array, geometry: Geometry, y: Float32Array, z: Float32Array, factor: number): void {
    for (let at = 0; at < out.length; at++) {
      const station = (at / 3) | 0;
      const aside = (y[station] || 0) * this.across[at] + (z[station] || 0) * this.low[at];
      out[at] = geometry.stationPosition[at] + factor * aside;
    }
  }

  private axis(geometry: Geometry, station: number): Vec3 {
    const angle = geometry.stationInclination[station];
    return [Math.sin(angle), 0, Math.cos(angle)];
  }

  private forces(
    moment: Moment,
    geometry: Geometry,
    pipeRadius: number,
    guideRadius: number,
    boreRadius: number,
  ): void {
    const { layout, row } = moment;
    const inner = layout.vector(row, "pipe_guide_normal_peak");
    const outer = layout.vector(row, "guide_wall_normal_peak");
    let most = 0;
    for (let station = 0; station < inner.length; station++)
      most = Math.max(most, inner[station] || 0, outer[station] || 0);
    // The scale changes rarely: up when it must, down when it is far too large.
    if (most > this.fullForce || most < this.fullForce / 5) this.fullForce = Math.max(200, roundUp(most));
    const [py, pz] = [layout.vector(row, "pipe_y"), layout.vector(row, "pipe_z")];
    const [gy, gz] = [layout.vector(row, "guide_y"), layout.vector(row, "guide_z")];
    for (let station = 0; station < inner.length; station++) {
      this.arrow(this.pipeGuide, station, inner[station], py[station] - gy[station], pz[station] - gz[station], {
        centre: this.pipeLine,
        from: pipeRadius,
        width: 0.014,
      });
      this.arrow(this.guideWall, station, outer[station], gy[station], gz[station], {
        centre: geometry.stationPosition,
        from: Math.max(boreRadius, guideRadius),
        width: 0.014,
      });
    }
  }

  /** The force on the inner body points from where it leans to its axis. */
  private arrow(
    mesh: Mesh,
    station: number,
    force: number,
    y: number,
    z: number,
    style: { centre: Float32Array; from: number; width: number },
  ): void {
    const lean = Math.hypot(y, z);
    const length = (ARROW * force) / this.fullForce;
    if (!(length > 0.01) || !(lean > 0)) return;
    const at = 3 * station;
    const direction = [0, 1, 2].map((k) => (y * this.across[at + k] + z * this.low[at + k]) / lean) as Vec3;
    const centre = point(style.centre, station);
    const tip = centre.map((value, k) => value + style.from * direction[k]) as Vec3;
    const tail = tip.map((value, k) => value + length * direction[k]) as Vec3;
    mesh.arrow(tail, tip, style.width);
  }

  private whirling(moment: Moment, geometry: Geometry, guideRadius: number): void {
    const { layout, row } = moment;
    const kind = layout.vector(row, "whirl_kind");
    const severity = layout.vector(row, "whirl_severity");
    const ratio = layout.vector(row, "whirl_ratio");
    this.labels = [];
    for (let index = 0; index < kind.length; index++) {
      const level = severity[index] || 0;
      // Backward and chaotic whirl, and whatever has a level; forward whirl of a calm tool is no news.
      if (kind[index] !== 2 && kind[index] !== 3 && !(level > 0)) continue;
      const station = geometry.watchedStation[index];
      const centre = point(this.guideLine, station);
      this.whirl[Math.min(level, 3)].collar(centre, this.axis(geometry, station), guideRadius * 1.03, 0.02);
      if (level > 0) {
        const word = kind[index] === 2 ? "backward" : kind[index] === 3 ? "chaotic" : "forward";
        const turns = ratio[index].toFixed(1).replace("-", "−");
        const text = Number.isFinite(ratio[index]) ? `${word} ${turns}×` : word;
        this.labels.push({ at: centre, text, level });
      }
    }
    // The worst say enough; more would hide the tool.
    this.labels.sort((a, b) => b.level - a.level);
    this.labels.length = Math.min(this.labels.length, 5);
  }
}

function point(line: Float32Array, index: number): Vec3 {
  return [line[3 * index], line[3 * index + 1], line[3 * index + 2]];
}
