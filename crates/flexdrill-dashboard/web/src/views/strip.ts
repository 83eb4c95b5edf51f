// A strip chart: one value over the shown window, with its limits and the time that is looked at.

import uPlot from "uplot";
import { timeTicks, valueTicks } from "../ticks";
import { number } from "../units";
import type { Context } from "../view";

export interface StripOptions {
  /** Names of the lines; the band between the second and the third is filled. */
  lines: 1 | 3;
  /** Whether the two columns after the time are the ends of a band of plausible tools, filled behind the lines. */
  plausible?: boolean;
  /** Range of the values, from what is in the data. */
  range: (min: number, max: number) => [number, number];
  /** Horizontal lines: limits and levels. */
  limits: () => number[];
  /** The present (s), marked where the strip goes beyond it. */
  now?: () => number;
  /** Larger type, for a strip that has the width of a panel. */
  wide?: boolean;
  /** The lowest of a column: it has the column's marks of time where the others are too low for their own. */
  last?: boolean;
}

/** Room for the marks of time and value (pixels): of a tile, of a panel. */
const ROOM = { tile: { below: 14, left: 30, font: 10, edge: 12 }, wide: { below: 18, left: 46, font: 11, edge: 24 } };
/** Height that a mark of the values needs (pixels). */
const APART = 22;
/** Least height with marks of time (pixels). */
const TALL = 46;

/** Rows of a chart: times and columns, with a row without values wherever nothing came for longer than `most` (s). */
export function withGaps(times: number[], columns: (number | null)[][], most: number): (number | null)[][] {
  const out: (number | null)[][] = [[], ...columns.map(() => [])];
  times.forEach((time, index) => {
    const last = index > 0 ? times[index - 1] : time;
    if (time - last > most) {
      out[0].push((time + last) / 2);
      columns.forEach((_, column) => out[column + 1].push(null));
    }
    out[0].push(time);
    columns.forEach((column, at) => out[at + 1].push(column[index]));
  });
  return out;
}

/** Values that are missing at a time: null where the line ends, undefined where only another line has that time. */
export type Columns = (number | null | undefined)[][];

/** Columns of a chart with a band of other times before its lines, as a strip with plausible tools takes them. */
export function withBand(lines: (number | null)[][], band: (number | null)[][]): Columns {
  if (band[0].length === 0) return [lines[0], ...band.slice(1).map(() => lines[0].map(() => null)), ...lines.slice(1)];
  const order = (of: (number | null)[][]) => of as uPlot.AlignedData;
  const [times, ...columns] = uPlot.join([order(band), order(lines)]);
  return [[...times], ...columns.map((column) => [...column])];
}

export class Strip {
  readonly element = document.createElement("div");
  private plot: uPlot | null = null;
  private revision = -1;
  private data: uPlot.AlignedData = [[], []];
  private hasTimes = true;

  constructor(
    private readonly context: Context,
    private readonly options: StripOptions,
  ) {
    this.element.className = "strip";
    new ResizeObserver(() => {
      const { clientWidth: width, clientHeight: height } = this.element;
      if (!this.plot || width === 0 || height === 0) return;
      this.plot.setSize({ width, height });
      if (this.hasTimes !== this.timesFit()) this.revision = -1;
    }).observe(this.element);
  }

  /** Shows columns (time first, s; gaps are null) between two times. */
  set(data: Columns, from: number, to: number): void {
    if (this.element.clientWidth === 0 || !(to > from)) return;
    this.data = data as unknown as uPlot.AlignedData;
    if (!this.plot || this.revision !== this.context.revision) this.make();
    this.plot?.batch(() => {
      this.plot?.setData(this.data, false);
      this.plot?.setScale("x", { min: from, max: to });
    });
  }

  private timesFit(): boolean {
    return this.options.wide === true || this.options.last === true || this.element.clientHeight >= TALL;
  }

  private make(): void {
    this.plot?.destroy();
    this.hasTimes = this.timesFit();
    this.revision = this.context.revision;
    const { palette } = this.context;
    const { options } = this;
    const room = options.wide ? ROOM.wide : ROOM.tile;
    const axis = {
      stroke: palette.muted,
      font: `${room.font}px system-ui, sans-serif`,
      grid: { stroke: palette.line, width: 1 },
      ticks: { show: false },
      gap: 2,
    };
    const line: uPlot.Series = { stroke: palette.trace, width: 1.5, points: { show: false }, spanGaps: false };
    const edge: uPlot.Series = { stroke: "transparent", width: 0, points: { show: false }, spanGaps: false };
    const inner = (plot: uPlot) => ({
      width: plot.bbox.width / devicePixelRatio,
      height: plot.bbox.height / devicePixelRatio,
    });
    const lines = options.lines === 3 ? [line, edge, edge] : [line];
    const first = options.plausible ? 3 : 1;
    const bands = options.lines === 3 ? [{ series: [first + 2, first + 1], fill: `${palette.trace}40` }] : [];
    this.plot = new uPlot(
      {
        width: this.element.clientWidth,
        height: this.element.clientHeight,
        legend: { show: false },
        cursor: { show: false },
        padding: [5, 4, 0, 0],
        scales: {
          x: { time: false },
          y: { range: (_plot, min, max) => options.range(min ?? 0, max ?? 1) },
        },
        axes: [
          {
            ...axis,
            size: this.hasTimes ? room.below : 2,
            splits: (plot, _axis, from, to) => timeTicks(from, to, inner(plot).width).map(({ time }) => time),
            values: (plot, splits) => {
              if (!this.hasTimes) return splits.map(() => "");
              const { min, max } = plot.scales.x;
              const ticks = timeTicks(min ?? 0, max ?? 0, inner(plot).width);
              // A label that does not fit in before the edge is left out; its line stands.
              const edge = (plot.posToVal(inner(plot).width - room.edge, "x") as number) || Infinity;
              return splits.map((time) => (time < edge ? (ticks.find((tick) => tick.time === time)?.label ?? "") : ""));
            },
          },
          {
            ...axis,
            size: room.left,
            splits: (plot, _axis, from, to) =>
              valueTicks(from, to, Math.max(2, Math.floor(inner(plot).height / APART))),
            values: (_plot, splits) => {
              const step = splits.length > 1 ? splits[1] - splits[0] : 1;
              const places = Math.min(3, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
              return splits.map((value) => number(value, places).replace("-", "−"));
            },
          },
        ],
        // What is drawn first is behind the rest.
        series: [{}, ...(options.plausible ? [edge, edge] : []), ...lines],
        bands: [
          ...(options.plausible ? [{ series: [2, 1], fill: `${palette.muted}38` }] : []),
          ...bands,
        ] as uPlot.Band[],
        hooks: { draw: [(plot) => this.drawMarks(plot)] },
      },
      this.data,
      this.element,
    );
  }

  private drawMarks(plot: uPlot): void {
    const { palette, store } = this.context;
    const { ctx } = plot;
    const { left, top, width, height } = plot.bbox;
    ctx.save();
    ctx.lineWidth = Math.max(1, devicePixelRatio);
    ctx.strokeStyle = palette.limit;
    ctx.setLineDash([4, 3]);
    for (const limit of this.options.limits()) {
      const y = plot.valToPos(limit, "y", true);
      if (!(y >= top && y <= top + height)) continue;
      ctx.beginPath();
      ctx.moveTo(left, y);
      ctx.lineTo(left + width, y);
      ctx.stroke();
    }
    const shown = this.options.now?.() ?? store.cursor ?? (store.isBag ? store.now : null);
    if (shown !== null) {
      const x = plot.valToPos(shown, "x", true);
      ctx.setLineDash([]);
      ctx.strokeStyle = palette.mark;
      ctx.beginPath();
      ctx.moveTo(x, top);
      ctx.lineTo(x, top + height);
      ctx.stroke();
    }
    ctx.restore();
  }
}
