// The standing forecast: the band of the next minute and what came, in one strip; the chance of each alarm.

import { h, setText, show } from "../dom";
import type { AlarmChance, Forecast } from "../messages";
import type { Ring } from "../store/ring";
import type { Layout, Scalar } from "../store/layout";
import { convert, type Kind, lapse, number, quantity } from "../units";
import { type Context, Pace, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, word } from "../words";
import { Strip, withGaps } from "./strip";
import { percent } from "./transfer";

/** Older than this (ms) a forecast is of the past. */
const OLD = 120_000;
/** What is shown before the present (s). */
const BEFORE = 120;
/** What a forecast has, by its name in the message. */
const SIGNALS: { name: string; label: string; kind: Kind; column: Scalar }[] = [
  { name: "bit_speed", label: "Bit speed", kind: "speed", column: "bit_speed_mean" },
  { name: "bit_torque", label: "Bit torque", kind: "torque", column: "bit_torque_mean" },
  { name: "weight_on_bit", label: "Weight on bit", kind: "weight", column: "weight_on_bit_applied" },
  { name: "pipe_guide_force", label: "Pipe on guide", kind: "force", column: "max_pipe_guide_force" },
  { name: "guide_wall_force", label: "Guide on wall", kind: "force", column: "max_guide_wall_force" },
];

const seconds = (time: { sec: number; nanosec: number }) => time.sec + time.nanosec * 1e-9;

/** The band at the seconds of several forecasts, the oldest first: a second has the band of the newest that knows it. */
export function bandOf(forecasts: readonly Forecast[], name: string): { time: number; low: number; high: number }[] {
  const rows = new Map<number, { time: number; low: number; high: number }>();
  for (const forecast of forecasts) {
    const band = forecast.bands.find((band) => band.name === name);
    const from = seconds(forecast.bands_from);
    band?.p5.forEach((low, index) => {
      // The middle of the second that the values are of.
      const time = from + (index + 0.5) * forecast.interval;
      if (Number.isFinite(low)) rows.set(Math.round(time * 2), { time, low, high: band.p95[index] });
    });
  }
  return [...rows.values()].sort((a, b) => a.time - b.time);
}

/** Columns of the strip: time, what came, edges of the band; by time, with gaps. */
export function rows(
  forecasts: readonly Forecast[],
  name: string,
  hour: Ring,
  column: number,
  from: number,
): (number | null)[][] {
  const points: { time: number; values: (number | null)[] }[] = bandOf(forecasts, name)
    .filter(({ time }) => time >= from)
    .map(({ time, low, high }) => ({ time, values: [null, low, high] }));
  for (let index = Math.max(0, hour.before(from)); index < hour.length; index++) {
    const value = hour.value(index, column);
    const time = hour.time(index);
    if (Number.isFinite(value) && time >= from) points.push({ time, values: [value, null, null] });
  }
  points.sort((a, b) => a.time - b.time);
  // The lines have rows of their own in turn: each goes on over the rows of the other.
  const last: (number | null)[] = [null, null, null];
  const at = [-Infinity, -Infinity];
  const filled = points.map(({ time, values }) => {
    if (values[0] !== null) [last[0], at[0]] = [values[0], time];
    else [last[1], last[2], at[1]] = [values[1], values[2], time];
    return [time - at[0] <= 2 ? last[0] : null, time - at[1] <= 2 ? last[1] : null, time - at[1] <= 2 ? last[2] : null];
  });
  const columns = [0, 1, 2].map((index) => filled.map((values) => values[index]));
  return withGaps(
    points.map(({ time }) => time),
    columns,
    3,
  );
}

/** The chance of an alarm as the driller reads it: runs that saw it, and the interval. */
export function chance(of: AlarmChance): string {
  return `${of.seen} of ${of.members} runs (${percent(of.lower)} to ${percent(of.upper)})`;
}

/** Alarms at their lowest priority each: those of a higher one are among them. The likeliest first. */
export function alarms(all: readonly AlarmChance[]): AlarmChance[] {
  const lowest = new Map<string, AlarmChance>();
  for (const of of all) {
    const known = lowest.get(of.id);
    if (!known || of.priority < known.priority) lowest.set(of.id, of);
  }
  return [...lowest.values()].sort((a, b) => b.seen - a.seen);
}

/** What the members say, in a sentence. */
export function summary(forecast: Forecast): string {
  const failed =
    forecast.failed > 0
      ? ` ${forecast.failed} more could not be computed to the end: what would come in them is unknown.`
      : "";
  if (forecast.members === 0) {
    return `The next minute is unknown: ${forecast.failure === "" ? "no run ended" : forecast.failure}.`;
  }
  const interval = `${percent(forecast.any_alarm_lower)} to ${percent(forecast.any_alarm_upper)}`;
  const seen = Math.round(forecast.any_alarm * forecast.members);
  const runs = forecast.members === 1 ? "run" : "runs";
  const what = seen === 0 ? "No alarm" : `An alarm`;
  return `${what} in ${seen === 0 ? "" : `${seen} of `}${forecast.members} ${runs} (chance ${interval}).${failed}`;
}

/** A row per alarm of a look-ahead. */
export function alarmRows(all: readonly AlarmChance[]): HTMLElement[] {
  return alarms(all).map((of) =>
    h(
      "li",
      { "data-level": String(of.priority) },
      h("span", { class: "shape", "aria-hidden": "true" }, PRIORITY_SHAPE[of.priority] ?? ""),
      ` ${of.name}, ${word(PRIORITY, of.priority)}: ${chance(of)}` +
        (Number.isFinite(of.time_to_first) ? `, first after ${number(of.time_to_first, 0)} s` : ""),
    ),
  );
}

export class ForecastView implements View {
  readonly element: HTMLElement;
  private readonly state = h("p", { class: "hint", id: "forecast-state" });
  private readonly said = h("p", { id: "forecast-summary" });
  private readonly list = h("ul", { class: "chances", id: "forecast-alarms" });
  private readonly held = h("p", { class: "hint", id: "forecast-held" });
  private readonly signal: HTMLSelectElement;
  private readonly strip: Strip;
  private readonly body: HTMLElement;
  private readonly pace = new Pace(500);
  private drawn = "";

  constructor(private readonly context: Context) {
    this.signal = h(
      "select",
      { id: "forecast-signal", "aria-label": "Figure of the forecast" },
      ...SIGNALS.map(({ name, label }) => h("option", { value: name }, label)),
    );
    this.strip = new Strip(context, {
      lines: 3,
      range: (min, max) => {
        const room = Math.max((max - min) * 0.08, Math.abs(max) * 0.01, 0.5);
        return [min - room, max + room];
      },
      limits: () => [],
      now: () => context.store.now,
      wide: true,
    });
    this.body = h(
      "div",
      {},
      h("div", { class: "row" }, this.signal, h("span", { class: "hint" }, "band: 90 % · line: what came")),
      this.strip.element,
      this.said,
      this.list,
      this.held,
    );
    this.element = h(
      "section",
      { class: "forecast", "aria-label": "Forecast" },
      h("h2", {}, "The next minute at the present speed and weight"),
      this.state,
      this.body,
    );
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store } = context;
    const { forecasts, layout } = store;
    const newest = forecasts[forecasts.length - 1];
    const past = !store.isBag && store.cursor !== null;
    show(this.body, newest !== undefined && !past && layout !== null);
    if (past) return setText(this.state, "The forecast is of the present.");
    if (!newest || !layout) {
      return setText(
        this.state,
        "No forecast: the twin makes none, or its first one is not there yet (look_ahead.forecast in its configuration).",
      );
    }
    const age = store.isBag ? 0 : 1e3 * (store.now - seconds(newest.header.stamp));
    this.element.classList.toggle("old", age > OLD);
    setText(this.state, `${age > OLD ? "OLD " : ""}Made from the state of ${lapse(age / 1e3)} ago.`);
    this.fill(newest, layout);
  }

  private fill(newest: Forecast, layout: Layout): void {
    const { store, settings } = this.context;
    const signal = SIGNALS.find(({ name }) => name === this.signal.value) ?? SIGNALS[0];
    const from = store.now - BEFORE;
    const table = rows(store.forecasts, signal.name, store.hour, layout.offset(signal.column), from);
    const scaled = table.map((column, index) =>
      index === 0
        ? column
        : column.map((value) => (value === null ? null : convert(value, signal.kind, settings.units))),
    );
    const end = seconds(newest.bands_from) + newest.interval * (newest.bands[0]?.p5.length ?? 60);
    this.strip.set(scaled, from, Math.max(end, store.now + 1));
    const band = newest.bands.find(({ name }) => name === signal.name);
    const share = band && band.compared > 0 ? band.inside / band.compared : NaN;
    const { unit } = quantity(signal.kind, settings.units);
    setText(
      this.held,
      band && band.compared > 0
        ? `${signal.label} in ${unit}. In the band so far: ${percent(share)} of ${band.compared} s that were compared.`
        : `${signal.label} in ${unit}. No forecast has been compared with what came yet.`,
    );
    const key = `${newest.from_step} ${newest.header.stamp.sec}`;
    if (key === this.drawn) return;
    this.drawn = key;
    setText(this.said, summary(newest));
    this.list.replaceChildren(...alarmRows(newest.alarms));
  }
}
