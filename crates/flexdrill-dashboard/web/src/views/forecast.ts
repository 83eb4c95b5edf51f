// The standing forecast: the band of the next minute and what came, in one strip; the chance of each alarm.

import { h, setText, show } from "../dom";
import { type AlarmChance, type AppliedInputs, type Forecast, type ForecastBand, TwinStatus } from "../messages";
import type { Ring } from "../store/ring";
import type { Layout, Scalar } from "../store/layout";
import type { Store } from "../store/store";
import { convert, counted, type Kind, lapse, number, quantity, type System, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, word } from "../words";
import { Strip, withGaps } from "./strip";
import { percent } from "./transfer";

/** Length of a forecast without bands (s): that of one whose runs all failed. */
const LENGTH = 60;
/**
 * Parts of an input's range and of its value by which it may change while a forecast at it holds: those within which
 * the twin compares its forecasts with what comes (SAME_OF_RANGE and SAME in src/ahead/held.rs).
 */
const SAME_OF_RANGE = 0.025;
const SAME = 0.05;
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
  return `${of.seen} of ${counted(of.members, "run")} (${percent(of.lower)} to ${percent(of.upper)})`;
}

/** An alarm at the highest priority that a run saw, with the chance of that priority. */
export interface Expected extends AlarmChance {
  /** The chance of any priority of the alarm, where more runs saw it than that of the highest; null where they are one. */
  any: AlarmChance | null;
}

/**
 * Each alarm once, at the highest priority that a run saw: a driller acts by the priority, so that a lower one must not
 * stand in its place. A chance is that of its priority or a higher one, and the lowest has the most runs. The highest
 * come first, then the likeliest.
 */
export function alarms(all: readonly AlarmChance[]): Expected[] {
  const highest = new Map<string, AlarmChance>();
  const lowest = new Map<string, AlarmChance>();
  for (const of of all) {
    if (of.seen === 0) continue;
    if (!(of.priority <= (highest.get(of.id)?.priority ?? -Infinity))) highest.set(of.id, of);
    if (!(of.priority >= (lowest.get(of.id)?.priority ?? Infinity))) lowest.set(of.id, of);
  }
  return [...highest.values()]
    .map((of) => {
      const any = lowest.get(of.id);
      return { ...of, any: any && any.seen > of.seen ? any : null };
    })
    .sort((a, b) => b.priority - a.priority || b.seen - a.seen);
}

/** What is known of the twin now, which a forecast must be of. */
export interface Present {
  /** Newest time on the rig's clock (s). */
  now: number;
  /** The twin cannot be heard. */
  silent: boolean;
  /** State of the run, one of the codes of TwinStatus; null before the first status. */
  state: number | null;
  /** What is asked for; null before it was heard. */
  applied: AppliedInputs | null;
  /** When the run began (s on the rig's clock); NaN while that is not known. */
  start: number;
  /** Largest speed (rad/s) and weight (N) of the rig; 0 while they are not known. */
  most: [number, number];
}

/** The present of the store's twin. */
export function presentOf(store: Store): Present {
  const { session, sessionInfo } = store;
  const { limits } = session ?? {};
  return {
    now: store.now,
    silent: store.silent,
    state: store.status?.state ?? null,
    applied: store.applied,
    start: sessionInfo ? seconds(sessionInfo.start) : NaN,
    most: limits ? [(limits.rotary_speed_rpm.max * Math.PI) / 30, 1e3 * limits.weight_on_bit_kn.max] : [0, 0],
  };
}

/** Speed (rad/s) and weight (N) in words. */
function point(of: { rotary_speed: number; weight_on_bit: number }, units: System): string {
  return `${withUnit(of.rotary_speed, "speed", units)} and ${withUnit(of.weight_on_bit, "weight", units)}`;
}

/**
 * Why a forecast is not one of the next minute at the present speed and weight, with what it was made for; null where
 * it is.
 */
export function withdrawn(forecast: Forecast, present: Present, units: System): string | null {
  const { applied } = present;
  const made = seconds(forecast.header.stamp);
  const of = Number.isFinite(forecast.rotary_speed) ? ` It was made for ${point(forecast, units)}.` : "";
  if (present.silent) return `Withdrawn: the twin is silent.${of}`;
  if (made < present.start) return `Withdrawn: it is of an earlier run of the twin.${of}`;
  if (present.state !== null && present.state !== TwinStatus.RUNNING) {
    return `Withdrawn: the model stands still.${of}`;
  }
  if (!applied) return `Withdrawn: the speed and weight that are asked for now are not known.${of}`;
  if (seconds(applied.header.stamp) >= made && applied.step < forecast.from_step) {
    return `Withdrawn: the model was reset since.${of}`;
  }
  const pairs: [number, number, number][] = [
    [forecast.rotary_speed, applied.rotary_speed, present.most[0]],
    [forecast.weight_on_bit, applied.weight_on_bit, present.most[1]],
  ];
  const differs = pairs.some(
    ([then, now, most]) => Math.abs(now - then) > Math.max(SAME_OF_RANGE * most, SAME * Math.abs(then)),
  );
  if (differs) {
    return (
      `Withdrawn: it was made for ${point(forecast, units)}, and ${point(applied, units)} are asked for now. ` +
      "The next one follows."
    );
  }
  const bands = forecast.bands[0]?.p5.length ?? 0;
  const end = bands > 0 ? seconds(forecast.bands_from) + forecast.interval * bands : made + LENGTH;
  if (present.now >= end) return `Withdrawn: its minute is over, and no newer one has come.${of}`;
  // A player that was brought back shows what was known then.
  if (present.now < made - 1) return `Withdrawn: it is of a later time.${of}`;
  return null;
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
  const what = seen === 0 ? "No alarm" : `An alarm`;
  return `${what} in ${seen === 0 ? "" : `${seen} of `}${counted(forecast.members, "run")} (chance ${interval}).${failed}`;
}

/** An alarm of a look-ahead in words. */
export function alarmWords(of: Expected): string {
  const first = Number.isFinite(of.time_to_first) ? `, first after ${number(of.time_to_first, 0)} s` : "";
  const lower = of.any ? `; ${word(PRIORITY, of.any.priority)} or higher: ${of.any.seen} of ${of.any.members}` : "";
  return `${of.name}, ${word(PRIORITY, of.priority)}: ${chance(of)}${first}${lower}`;
}

/** A row per alarm of a look-ahead. */
export function alarmRows(all: readonly AlarmChance[]): HTMLElement[] {
  return alarms(all).map((of) =>
    h(
      "li",
      { "data-level": String(of.priority) },
      h("span", { class: "shape", "aria-hidden": "true" }, PRIORITY_SHAPE[of.priority] ?? ""),
      ` ${alarmWords(of)}`,
    ),
  );
}

/** The heading while the newest forecast is of the present, and otherwise. */
const OF_NOW = "The next minute at the present speed and weight";
const HEADING = "Forecast";

/** How far ahead a band is not calibrated yet, as words after a sentence; empty where all of it is. */
export function uncalibrated(band: Pick<ForecastBand, "lead_until" | "lead_calibrated">): string {
  const spans = [...band.lead_until]
    .map((until, index) => `${index === 0 ? 0 : band.lead_until[index - 1]} to ${until} s`)
    .filter((_, index) => !band.lead_calibrated[index]);
  return spans.length === 0 ? "" : ` Not calibrated yet ${spans.join(", ")} ahead.`;
}

export class ForecastView implements View {
  readonly element: HTMLElement;
  private readonly heading = h("h2", { id: "forecast-heading" }, HEADING);
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
    this.element = h("section", { class: "forecast", "aria-label": "Forecast" }, this.heading, this.state, this.body);
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store } = context;
    const { forecasts, layout } = store;
    const newest = forecasts[forecasts.length - 1];
    const past = !store.isBag && store.cursor !== null;
    const why = newest ? withdrawn(newest, presentOf(store), context.settings.units) : null;
    const isOfNow = newest !== undefined && !past && layout !== null && why === null;
    show(this.body, isOfNow);
    setText(this.heading, isOfNow ? OF_NOW : HEADING);
    if (past) return setText(this.state, "The forecast is of the present.");
    if (!newest || !layout) {
      return setText(
        this.state,
        "No forecast: the twin makes none, or its first one is not there yet (look_ahead.forecast in its configuration).",
      );
    }
    if (why !== null) return setText(this.state, why);
    const age = store.now - seconds(newest.header.stamp);
    setText(this.state, `Made from the state of ${lapse(Math.max(0, age))} ago.`);
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
        ? `${signal.label} in ${unit}. In the band so far: ${percent(share)} of ${band.compared} s that were compared.${uncalibrated(band)}`
        : `${signal.label} in ${unit}. No forecast has been compared with what came yet.`,
    );
    const key = `${newest.from_step} ${newest.header.stamp.sec}`;
    if (key === this.drawn) return;
    this.drawn = key;
    setText(this.said, summary(newest));
    this.list.replaceChildren(...alarmRows(newest.alarms));
  }
}
