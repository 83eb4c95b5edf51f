// The safe window: the map of speed and weight with the present point, its last hour, and the candidates of a question.

import type { WhatIfAnswer } from "../api";
import { fit, h, setText, show } from "../dom";
import { SafeWindow } from "../messages";
import { channels } from "../theme";
import { valueTicks } from "../ticks";
import { convert, counted, number, quantity } from "../units";
import { type Context, Pace, type View } from "../view";
import { percent } from "./transfer";

/** Room for the marks of weight and of speed (pixels). */
const LEFT = 40;
const BELOW = 30;
/** Least time between two pictures (ms). */
const INTERVAL = 500;

/** Edges of the cells of an axis: half-way between its values, and as far beyond the first and the last. */
export function edges(values: ArrayLike<number>): number[] {
  const all = Array.from(values);
  const count = all.length;
  if (count < 2) return all;
  const between = all.slice(1).map((value, index) => (value + all[index]) / 2);
  const [first, last] = [2 * all[0] - between[0], 2 * all[count - 1] - between[count - 2]];
  return [first, ...between, last];
}

/** Number of the cell of an axis that a value is in; -1 outside. */
export function cellAt(edge: readonly number[], value: number): number {
  if (!(value >= edge[0] && value <= edge[edge.length - 1])) return -1;
  const after = edge.findIndex((of) => of > value);
  return (after < 0 ? edge.length - 1 : after) - 1;
}

/** What the map says of a speed (r/min) and a weight (kN), in words. */
export function sentence(map: SafeWindow, rpm: number, kilonewton: number): string {
  const speeds = edges(map.rotary_speed_rpm);
  const weights = edges(map.weight_on_bit_kn);
  const [column, row] = [cellAt(speeds, rpm), cellAt(weights, kilonewton)];
  if (column < 0 || row < 0) return "off the map: not known";
  const at = row * map.rotary_speed_rpm.length + column;
  const name = map.alarm[at]?.replace(/_/g, " ") ?? "";
  const chance = map.chance[at];
  const likely = name === "" || !Number.isFinite(chance) ? "" : `: ${name}, chance ${percent(chance)}`;
  const how = map.was_run[at] ? "" : " (inferred from cells nearby)";
  switch (map.verdict[at]) {
    case SafeWindow.CLEAR:
      return `no alarm expected${how}`;
    case SafeWindow.ALARM:
      return `alarm expected${likely}${how}`;
    case SafeWindow.DEPENDS_ON_START:
      return `an alarm comes or not, depending on the way there${likely}${how}`;
    case SafeWindow.NOT_KNOWN:
      return `not known: not run here, and the runs nearby do not say${likely}`;
    default:
      return "unknown: runs of the map failed here";
  }
}

/** How many runs a cell has per start: what ended, not what was allowed. */
export function members(map: SafeWindow): string {
  const { least_members: least, most_members: most } = map;
  if (most === 0) return "No run of this map ended, each";
  return `Each start of a cell that was run: ${least === most ? "" : `${least} to `}${counted(most, "run")}`;
}

export class WindowView implements View {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly present = h("p", { id: "window-present" });
  private readonly legend: HTMLElement;
  private readonly hint = h("p", { class: "hint" });
  private readonly pace = new Pace(INTERVAL);
  private drawn = "";

  constructor(
    private readonly context: Context,
    /** Takes a point that was clicked (r/min, kN). */
    private readonly choose: (rpm: number, kilonewton: number) => void,
    private readonly candidates: () => readonly WhatIfAnswer[],
  ) {
    this.canvas = h("canvas", { id: "window-map", role: "img", "aria-label": "Map of rotary speed and weight on bit" });
    this.canvas.addEventListener("click", (event) => this.click(event));
    const key = (name: string, words: string) => h("span", {}, h("i", { class: `key ${name}` }), ` ${words}`);
    this.legend = h(
      "p",
      { class: "hint keys" },
      key("clear", "no alarm expected"),
      key("alarm", "alarm expected"),
      key("depends", "depends on the way there"),
      key("unknown", "a run failed"),
      key("not-known", "not known"),
      h("span", {}, "● now"),
      h("span", {}, "— last hour"),
      h("span", {}, "◇ asked"),
    );
    this.element = h(
      "section",
      { class: "window", "aria-label": "Safe window" },
      h("h2", {}, "Known window of speed and weight"),
      this.present,
      this.canvas,
      this.legend,
      this.hint,
    );
  }

  private get scales(): { x: number[]; y: number[]; factor: number } | null {
    const map = this.context.store.safeWindow;
    if (!map || map.rotary_speed_rpm.length < 2 || map.weight_on_bit_kn.length < 2) return null;
    const factor = convert(1e3, "weight", this.context.settings.units);
    return { x: edges(map.rotary_speed_rpm), y: edges(map.weight_on_bit_kn), factor };
  }

  private click(event: MouseEvent): void {
    const { scales } = this;
    if (!scales) return;
    const { x, y } = scales;
    const across = (event.offsetX - LEFT) / (this.canvas.clientWidth - LEFT);
    const up = 1 - event.offsetY / (this.canvas.clientHeight - BELOW);
    if (across < 0 || across > 1 || up < 0 || up > 1) return;
    const round = (value: number, step: number) => Math.round(value / step) * step;
    this.choose(
      round(x[0] + across * (x[x.length - 1] - x[0]), 1),
      Math.max(0, round(y[0] + up * (y[y.length - 1] - y[0]), 0.5)),
    );
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store } = context;
    const map = store.safeWindow;
    const { scales } = this;
    show(this.canvas, scales !== null);
    show(this.legend, scales !== null);
    if (!map || !scales) {
      setText(this.present, "");
      setText(this.hint, "No map is loaded (map.file in the configuration of the twin; flexdrill map makes one).");
      return;
    }
    // What no map knows: a tool of another kind than all that were run.
    const kind = "The map speaks of tools with its kind of joints, law of the bit and string alone.";
    setText(
      this.hint,
      `${members(map)} of ${number(map.horizon, 0)} s. ${kind} A click puts a point into the question.`,
    );
    const moment = store.moment();
    const scalar = (name: "rotary_speed_applied" | "weight_on_bit_applied") =>
      moment ? moment.layout.scalar(moment.row, name) : NaN;
    const rpm = convert(scalar("rotary_speed_applied"), "speed", "si");
    const kilonewton = convert(scalar("weight_on_bit_applied"), "weight", "si");
    // The newest values of a twin that is not heard are not the present.
    const isKnown = store.isLive || store.isBag;
    const point = isKnown && Number.isFinite(rpm) && Number.isFinite(kilonewton) ? [rpm, kilonewton] : null;
    const { unit } = quantity("weight", context.settings.units);
    setText(
      this.present,
      point
        ? `${number(rpm, 0)} r/min, ${number(kilonewton * scales.factor, 1)} ${unit}: ${sentence(map, rpm, kilonewton)}`
        : "The present speed and weight are not known here.",
    );
    const size = fit(this.canvas);
    const key = [
      store.hourRevision,
      context.revision,
      size.width,
      size.height,
      point?.map((value) => value.toFixed(1)),
      JSON.stringify(this.candidates().map(({ candidate, any_alarm }) => [candidate, any_alarm])),
    ].join(" ");
    if (key === this.drawn) return;
    this.drawn = key;
    this.paint(map, scales, size, point);
  }

  private paint(
    map: SafeWindow,
    { x, y, factor }: { x: number[]; y: number[]; factor: number },
    { width, height, ratio }: { width: number; height: number; ratio: number },
    point: number[] | null,
  ): void {
    const pencil = this.canvas.getContext("2d");
    if (!pencil) return;
    const { palette, store } = this.context;
    pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
    pencil.clearRect(0, 0, width, height);
    const across = (value: number) => LEFT + ((value - x[0]) / (x[x.length - 1] - x[0])) * (width - LEFT);
    const down = (value: number) => (1 - (value - y[0]) / (y[y.length - 1] - y[0])) * (height - BELOW);
    map.verdict.forEach((verdict, at) => {
      const column = at % map.rotary_speed_rpm.length;
      const row = Math.floor(at / map.rotary_speed_rpm.length);
      const [left, right] = [across(x[column]), across(x[column + 1])];
      const [bottom, top] = [down(y[row]), down(y[row + 1])];
      this.cell(pencil, verdict, [left, top, right - left, bottom - top]);
    });
    // Axes.
    pencil.fillStyle = palette.muted;
    pencil.strokeStyle = palette.line;
    pencil.lineWidth = 1;
    pencil.strokeRect(LEFT + 0.5, 0.5, width - LEFT - 1, height - BELOW - 1);
    pencil.font = "11px system-ui, sans-serif";
    pencil.textAlign = "center";
    pencil.textBaseline = "top";
    for (const value of valueTicks(x[0], x[x.length - 1], Math.max(2, Math.floor((width - LEFT) / 60)))) {
      if (across(value) > width - 12) continue;
      pencil.fillText(number(value, 0), across(value), height - BELOW + 3);
    }
    pencil.fillText("r/min", LEFT + (width - LEFT) / 2, height - 13);
    pencil.textAlign = "right";
    pencil.textBaseline = "middle";
    const [low, high] = [y[0] * factor, y[y.length - 1] * factor];
    for (const value of valueTicks(low, high, Math.max(2, Math.floor((height - BELOW) / 30)))) {
      const at = down(value / factor);
      if (at > 8 && at < height - BELOW - 4) pencil.fillText(number(value, factor < 1 ? 1 : 0), LEFT - 4, at);
    }
    pencil.save();
    pencil.translate(9, (height - BELOW) / 2);
    pencil.rotate(-Math.PI / 2);
    pencil.textAlign = "center";
    pencil.fillText(quantity("weight", this.context.settings.units).unit, 0, 0);
    pencil.restore();
    // The last hour, the questions, the present.
    pencil.save();
    pencil.beginPath();
    pencil.rect(LEFT, 0, width - LEFT, height - BELOW);
    pencil.clip();
    this.trail(pencil, across, down);
    for (const { candidate, any_alarm } of this.candidates()) {
      const [at, by] = [across(candidate.rotary_speed), down(candidate.weight_on_bit)];
      pencil.beginPath();
      for (const [dx, dy] of [
        [0, -7],
        [7, 0],
        [0, 7],
        [-7, 0],
      ])
        pencil.lineTo(at + dx, by + dy);
      pencil.closePath();
      pencil.fillStyle = any_alarm === null || any_alarm > 0 ? palette.ink : palette.panel;
      pencil.fill();
      pencil.strokeStyle = palette.ink;
      pencil.lineWidth = 2;
      pencil.stroke();
    }
    if (point && store.hasLive) {
      pencil.beginPath();
      pencil.arc(across(point[0]), down(point[1]), 6, 0, 2 * Math.PI);
      pencil.fillStyle = palette.ink;
      pencil.fill();
      pencil.strokeStyle = palette.panel;
      pencil.lineWidth = 2;
      pencil.stroke();
    }
    pencil.restore();
  }

  /** A cell: grey where no alarm is expected; shape and colour together where one is. */
  private cell(pencil: CanvasRenderingContext2D, verdict: number, [left, top, width, height]: number[]): void {
    const { palette } = this.context;
    const tint = (colour: string, share: number) => {
      const [from, to] = [channels(palette.well), channels(colour)];
      return `rgb(${[0, 1, 2].map((index) => Math.round(255 * (from[index] + (to[index] - from[index]) * share)))})`;
    };
    pencil.fillStyle = palette.panel;
    if (verdict === SafeWindow.ALARM) pencil.fillStyle = tint(palette.medium, 0.75);
    if (verdict === SafeWindow.DEPENDS_ON_START) pencil.fillStyle = tint(palette.medium, 0.3);
    if (verdict === SafeWindow.UNKNOWN || verdict === SafeWindow.NOT_KNOWN) pencil.fillStyle = palette.well;
    pencil.fillRect(left, top, width + 0.5, height + 0.5);
    if (verdict === SafeWindow.CLEAR) return;
    // Close stripes for an alarm, wide ones for what depends, crosses where a run failed, one diagonal where nothing is
    // known: colour never stands alone.
    pencil.save();
    pencil.beginPath();
    pencil.rect(left, top, width, height);
    pencil.clip();
    pencil.strokeStyle = palette.limit;
    pencil.lineWidth = 1;
    const stripes = (step: number, slope: 1 | -1) => {
      pencil.beginPath();
      for (let at = -height; at < width + height; at += step) {
        pencil.moveTo(left + at, slope > 0 ? top + height : top);
        pencil.lineTo(left + at + height, slope > 0 ? top : top + height);
      }
      pencil.stroke();
    };
    if (verdict === SafeWindow.ALARM) stripes(7, 1);
    else if (verdict === SafeWindow.DEPENDS_ON_START) stripes(14, 1);
    else if (verdict === SafeWindow.NOT_KNOWN) {
      pencil.beginPath();
      pencil.moveTo(left, top);
      pencil.lineTo(left + width, top + height);
      pencil.stroke();
    } else {
      stripes(9, 1);
      stripes(9, -1);
    }
    pencil.restore();
  }

  /** Where speed and weight have been in the last hour, older parts thinner. */
  private trail(
    pencil: CanvasRenderingContext2D,
    across: (value: number) => number,
    down: (value: number) => number,
  ): void {
    const { store, palette } = this.context;
    const { hour, layout } = store;
    if (!layout) return;
    const [speed, weight] = [layout.offset("rotary_speed_applied"), layout.offset("weight_on_bit_applied")];
    pencil.strokeStyle = palette.trace;
    pencil.lineWidth = 1.5;
    pencil.beginPath();
    let last = -Infinity;
    for (let index = 0; index < hour.length; index++) {
      const rpm = convert(hour.value(index, speed), "speed", "si");
      const kilonewton = convert(hour.value(index, weight), "weight", "si");
      const time = hour.time(index);
      if (!Number.isFinite(rpm) || !Number.isFinite(kilonewton)) continue;
      // A gap in the hour is a gap in the trail.
      if (time - last > 3 * store.period) pencil.moveTo(across(rpm), down(kilonewton));
      else pencil.lineTo(across(rpm), down(kilonewton));
      last = time;
    }
    pencil.stroke();
  }
}
