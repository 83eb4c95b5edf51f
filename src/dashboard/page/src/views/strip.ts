// A strip chart: one value over the shown window, with its limits and the time that is looked at.

import uPlot from "uplot";
import type { Context } from "../view";

export interface StripOptions {
  /** Names of the lines; the band between the second and the third is filled. */
  lines: 1 | 3;
  /** Range of the values, from what is in the data. */
  range: (min: number, max: number) => [number, number];
  /** Horizontal lines: limits and levels. */
  limits: () => number[];
  /** Draws scales too. */
  axes?: boolean;
}

export class Strip {
  readonly element = document.createElement("div");
  private plot: uPlot | null = null;
  private revision = -1;
  private data: uPlot.AlignedData = [[], []];

  constructor(
    private readonly context: Context,
    private readonly options: StripOptions,
  ) {
    this.element.className = "strip";
    new ResizeObserver(() => {
      const { clientWidth: width, clientHeight: height } = this.element;
      if (this.plot && width > 0 && height > 0) this.plot.setSize({ width, height });
    }).observe(this.element);
  }

  /** Shows columns (time first, s; gaps are null) between two times. */
  set(data: (number | null)[][], from: number, to: number): void {
    if (this.element.clientWidth === 0 || !(to > from)) return;
    this.data = data as unknown as uPlot.AlignedData;
    if (!this.plot || this.revision !== this.context.revision) this.make();
    this.plot?.batch(() => {
      this.plot?.setData(this.data, false);
      this.plot?.setScale("x", { min: from, max: to });
    });
  }

  private make(): void {
    this.plot?.destroy();
    this.revision = this.context.revision;
    const { palette, store } = this.context;
    const axis = {
      stroke: palette.muted,
      font: "11px system-ui, sans-serif",
      grid: { stroke: palette.line, width: 1 },
      ticks: { show: false },
    };
    const line: uPlot.Series = { stroke: palette.trace, width: 1.5, points: { show: false } };
    const edge: uPlot.Series = { stroke: "transparent", width: 0, points: { show: false } };
    const { options } = this;
    this.plot = new uPlot(
      {
        width: this.element.clientWidth,
        height: this.element.clientHeight,
        legend: { show: false },
        cursor: { show: false },
        padding: options.axes ? [6, 8, 0, 0] : [2, 0, 2, 0],
        scales: {
          x: { time: false },
          y: { range: (_plot, min, max) => options.range(min ?? 0, max ?? 1) },
        },
        axes: options.axes
          ? [
              {
                ...axis,
                size: 20,
                values: (_plot, ticks) => ticks.map((tick) => `${Math.round(tick - store.shown)} s`),
              },
              { ...axis, size: 46 },
            ]
          : [{ show: false }, { show: false }],
        series: options.lines === 3 ? [{}, line, edge, edge] : [{}, line],
        bands: options.lines === 3 ? [{ series: [3, 2], fill: `${palette.trace}40` }] : [],
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
    const shown = store.cursor ?? (store.isBag ? store.now : null);
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
