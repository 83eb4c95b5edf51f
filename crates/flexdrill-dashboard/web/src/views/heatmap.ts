// Contact force by depth against time: where along the tool it rubs, and since when.

import { fit, h, setText } from "../dom";
import type { Vector } from "../store/layout";
import { nearest } from "../store/geometry";
import { shade } from "../theme";
import { roundUp, timeTicks, valueTicks } from "../ticks";
import { convert, number, quantity } from "../units";
import { type Context, Pace, type View } from "../view";

/** Rows of the picture: finer than the joints are apart. */
const ROWS = 96;
/** Least time between two pictures (ms): a column is a second. */
const INTERVAL = 500;
/** Room for the marks of depth and of time (pixels). */
const LEFT = 44;
const BELOW = 15;
/** Steps of the colour scale. */
const STEPS = 32;

export class HeatMap implements View {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly bar = h("canvas", { class: "colour-bar", width: String(STEPS), height: "1" });
  private readonly middle = h("span");
  private readonly top = h("span");
  private readonly scale: HTMLElement;
  private readonly picture = document.createElement("canvas");
  private readonly pace = new Pace(INTERVAL);
  private drawn = "";
  private most = 200;

  constructor(
    private readonly context: Context,
    title: string,
    private readonly vector: Vector,
  ) {
    this.canvas = h("canvas", { role: "img", "aria-label": `${title}: force by depth against time` });
    const bar = h(
      "span",
      { class: "bar" },
      this.bar,
      h("span", { class: "marks" }, h("span", {}, "0"), this.middle, this.top),
    );
    this.scale = h("span", { class: "scale" }, bar, h("span", { class: "no-data" }), "no data");
    this.element = h("section", { class: "heatmap", "aria-label": title }, h("h2", {}, title, this.scale), this.canvas);
    this.canvas.addEventListener("click", (event) => this.look(event));
  }

  /** A click looks at that time and chooses that depth. */
  private look(event: MouseEvent): void {
    const { context } = this;
    const { geometry } = context.store;
    const [from, to] = context.range;
    const across = (event.offsetX - LEFT) / (this.canvas.clientWidth - LEFT);
    const down = event.offsetY / (this.canvas.clientHeight - BELOW);
    if (across < 0 || down > 1) return;
    context.store.lookAt(from + across * (to - from));
    if (!geometry) return;
    const depth = geometry.stationDepth;
    const station = nearest(depth, depth[0] + down * (depth[depth.length - 1] - depth[0]));
    const joint = geometry.jointStation.indexOf(station);
    context.choose({ station, joint: joint < 0 ? null : joint });
  }

  draw(now: number): void {
    const { context } = this;
    if (!this.pace.due(now, context.revision)) return;
    const { store } = context;
    const { layout, geometry } = store;
    if (!layout || !geometry || this.canvas.clientWidth === 0) return;
    const [from, to] = context.range;
    const size = fit(this.canvas);
    const shown = store.isBag ? Math.floor(2 * store.now) : store.cursor;
    const range = `${from.toFixed(0)} ${to.toFixed(0)}`;
    const key = `${store.hourRevision} ${range} ${shown} ${context.revision} ${size.width}x${size.height}`;
    if (key === this.drawn || !(to > from)) return;
    this.drawn = key;
    this.fill(from, to);
    this.paint(from, to, size);
    this.legend();
  }

  /** The colours with their forces: shades go with the root of the force, so that half the bar is a quarter of its end. */
  private legend(): void {
    const { palette, settings } = this.context;
    const pencil = this.bar.getContext("2d");
    for (let step = 0; pencil && step < STEPS; step++) {
      pencil.fillStyle = `rgb(${shade(step / (STEPS - 1), palette).map((part) => Math.round(255 * part))})`;
      pencil.fillRect(step, 0, 1, 1);
    }
    const most = convert(this.most, "force", settings.units);
    const places = most / 4 >= 10 ? 0 : most / 4 >= 1 ? 1 : most / 4 >= 0.1 ? 2 : 3;
    setText(this.middle, number(most / 4, places));
    setText(this.top, `${Number(most.toPrecision(3))} ${quantity("force", settings.units).unit}`);
  }

  /** One column per second or per frame of the hour, one row per part of the depth. */
  private fill(from: number, to: number): void {
    const { store, palette } = this.context;
    const { layout, geometry, hour } = store;
    if (!layout || !geometry) return;
    const columns = Math.max(1, Math.min(1200, Math.round((to - from) / store.period)));
    const stations = layout.counts.stations;
    const offset = layout.offset(this.vector);
    const rowOf = new Int32Array(ROWS);
    const [top, bottom] = [geometry.stationDepth[0], geometry.stationDepth[stations - 1]];
    for (let row = 0; row < ROWS; row++) {
      rowOf[row] = nearest(geometry.stationDepth, top + ((row + 0.5) / ROWS) * (bottom - top));
    }
    const values = new Float32Array(columns * stations).fill(NaN);
    const first = Math.max(0, hour.before(from));
    let most = 0;
    for (let index = first; index < hour.length && hour.time(index) <= to; index++) {
      const column = Math.min(columns - 1, Math.floor(((hour.time(index) - from) / (to - from)) * columns));
      if (column < 0) continue;
      const row = hour.row(index);
      for (let station = 0; station < stations; station++) {
        const value = row[offset + station];
        const at = column * stations + station;
        if (!(values[at] >= value)) values[at] = value;
        if (value > most) most = value;
      }
    }
    this.most = Math.max(200, roundUp(most));
    this.picture.width = columns;
    this.picture.height = ROWS;
    const pencil = this.picture.getContext("2d");
    if (!pencil) return;
    const image = pencil.createImageData(columns, ROWS);
    // A frame a second falls between two columns now and then; the one before stands for it.
    const before = new Float32Array(ROWS).fill(NaN);
    const missed = new Uint8Array(ROWS);
    for (let column = 0; column < columns; column++) {
      for (let row = 0; row < ROWS; row++) {
        let value = values[column * stations + rowOf[row]];
        if (Number.isNaN(value) && missed[row] === 0) {
          value = before[row];
          missed[row] = 1;
        } else missed[row] = 0;
        before[row] = value;
        if (Number.isNaN(value)) continue;
        const [r, g, b] = shade(Math.sqrt(value / this.most), palette);
        const at = 4 * (row * columns + column);
        image.data[at] = 255 * r;
        image.data[at + 1] = 255 * g;
        image.data[at + 2] = 255 * b;
        image.data[at + 3] = 255;
      }
    }
    pencil.putImageData(image, 0, 0);
  }

  private paint(
    from: number,
    to: number,
    { width, height, ratio }: { width: number; height: number; ratio: number },
  ): void {
    const { store, palette, location, settings } = this.context;
    const { geometry } = store;
    const pencil = this.canvas.getContext("2d");
    if (!pencil || !geometry) return;
    pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
    pencil.clearRect(0, 0, width, height);
    pencil.imageSmoothingEnabled = false;
    const [wide, tall] = [width - LEFT, height - BELOW];
    const x = (time: number) => LEFT + ((time - from) / (to - from)) * wide;
    pencil.fillStyle = palette.ground;
    pencil.fillRect(LEFT, 0, wide, tall);
    this.hatch(pencil, wide, tall);
    pencil.drawImage(this.picture, LEFT, 0, wide, tall);
    const depth = geometry.stationDepth;
    const [top, bottom] = [depth[0], depth[depth.length - 1]];
    pencil.strokeStyle = palette.mark;
    pencil.lineWidth = 1;
    if (location && location.station < depth.length) {
      const y = ((depth[location.station] - top) / (bottom - top)) * tall;
      pencil.setLineDash([6, 4]);
      pencil.beginPath();
      pencil.moveTo(LEFT, y);
      pencil.lineTo(width, y);
      pencil.stroke();
      pencil.setLineDash([]);
    }
    const shown = store.cursor ?? (store.isBag ? store.now : null);
    if (shown !== null) {
      pencil.beginPath();
      pencil.moveTo(x(shown), 0);
      pencil.lineTo(x(shown), tall);
      pencil.stroke();
    }
    pencil.font = "11px system-ui, sans-serif";
    pencil.fillStyle = palette.muted;
    pencil.textBaseline = "middle";
    pencil.textAlign = "right";
    const factor = convert(1, "depth", settings.units);
    const marks = valueTicks(top * factor, bottom * factor, Math.max(2, Math.floor(tall / 28)));
    marks.forEach((mark, index) => {
      const y = ((mark / factor - top) / (bottom - top)) * tall;
      const unit = index === 0 ? ` ${quantity("depth", settings.units).unit}` : "";
      pencil.fillText(`${mark}${unit}`, LEFT - 6, Math.min(Math.max(y, 6), tall - 5));
      pencil.fillRect(LEFT - 4, Math.min(y, tall - 1), 4, 1);
    });
    pencil.textAlign = "center";
    for (const { time, label } of timeTicks(from, to, wide)) {
      pencil.fillRect(x(time), tall, 1, 3);
      const half = pencil.measureText(label).width / 2;
      pencil.fillText(label, Math.min(Math.max(x(time), half), width - half), tall + 9);
    }
  }

  /** Ground that no value has the colour of: nothing is known there. */
  private hatch(pencil: CanvasRenderingContext2D, wide: number, tall: number): void {
    pencil.save();
    pencil.beginPath();
    pencil.rect(LEFT, 0, wide, tall);
    pencil.clip();
    pencil.strokeStyle = this.context.palette.line;
    pencil.lineWidth = 1;
    pencil.beginPath();
    for (let at = -tall; at < wide; at += 8) {
      pencil.moveTo(LEFT + at, tall);
      pencil.lineTo(LEFT + at + tall, 0);
    }
    pencil.stroke();
    pencil.restore();
  }
}
