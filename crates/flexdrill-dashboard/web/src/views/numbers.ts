// The numbers that matter, each with its limits, its age and a trail.

import { levelOf } from "../alarms";
import { configured } from "../configuration";
import { h, setAttribute, setText } from "../dom";
import { TwinStatus } from "../messages";
import type { Layout, Scalar } from "../store/layout";
import { GAP } from "../store/bands";
import type { Moment, Store } from "../store/store";
import type { Topic } from "../store/topics";
import { RANGE_HINT, rangeOf } from "../ranges";
import { convert, digits, type Kind, lapse, number, quantity, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { doubt, INPUT_STATE, PRIORITY_SHAPE, SEVERITY, word } from "../words";
import { Strip, withBand, withGaps } from "./strip";

/** What one tile shows. */
export interface Reading {
  value: string;
  /** Below the number: what it is held against, what the rig says. */
  note: string;
  /** 0 nothing to say, 1 to 3 as priorities. */
  level: number;
  /** The value is not the rig's now, but the last good one. */
  held?: boolean;
}

export interface Tile {
  id: string;
  label: string;
  unit: () => string;
  topic: Topic;
  /** Value, then lower and upper edge of the band around it. */
  columns: [Scalar] | [Scalar, Scalar, Scalar];
  /** The figure whose band of plausible tools is that of the value, and its digits from SI. */
  figure?: { name: string; digits: (value: number) => string };
  /** Whether the strip shows what a second has; all of them without. */
  good?: (row: Float32Array, layout: Layout) => boolean;
  /** Of the strip, in the columns' unit. */
  scale: (value: number) => number;
  range: (min: number, max: number) => [number, number];
  limits: () => number[];
  read: (moment: Moment) => Reading;
}

/** Range from zero with some room above. */
const fromZero =
  (least: number) =>
  (_min: number, max: number): [number, number] => [0, Math.max(least, max * 1.1)];

/** States of an input in which the model runs on another value than the rig's. */
const NOT_THE_RIGS: readonly number[] = [TwinStatus.INPUT_NOT_RECEIVED, TwinStatus.INPUT_STALE];

export class Numbers implements View {
  readonly element = h("section", { class: "numbers", "aria-label": "Numbers" });
  /** What the tiles show, for the wall too. */
  readonly tiles: readonly Tile[];
  private readonly parts: { tile: Tile; strip: Strip; root: HTMLElement; fields: Record<string, HTMLElement> }[] = [];
  private readonly pace = new Pace(100);
  private drawn = "";

  constructor(private readonly context: Context) {
    this.tiles = this.make();
    for (const tile of this.tiles) {
      const { range, limits } = tile;
      const last = tile === this.tiles[this.tiles.length - 1];
      const strip = new Strip(context, {
        lines: tile.columns.length,
        plausible: tile.figure !== undefined,
        ...{ range, limits, last },
      });
      const field = (name: string) => h("span", { class: name });
      const fields = {
        mark: field("mark"),
        value: h("output", { class: "value", id: `value-${tile.id}` }),
        unit: field("unit"),
        range: h("span", { class: "range", title: RANGE_HINT }),
        note: field("note"),
        age: field("age"),
      };
      const root = h(
        "article",
        { class: "tile", id: `tile-${tile.id}`, "aria-label": tile.label },
        h("h2", {}, tile.label, fields.unit, fields.mark),
        h("div", { class: "big" }, fields.value, fields.range),
        fields.note,
        fields.age,
        strip.element,
      );
      this.element.append(root);
      this.parts.push({ tile, strip, root, fields });
    }
  }

  private make(): Tile[] {
    const { context } = this;
    const { store } = context;
    const system = () => context.settings.units;
    const unit = (kind: Kind) => () => quantity(kind, system()).unit;
    const scale = (kind: Kind) => (value: number) => convert(value, kind, system());
    const figure = (name: string, kind: Kind) => ({ name, digits: (value: number) => digits(value, kind, system()) });
    const at = (moment: Moment, name: Scalar) => moment.layout.scalar(moment.row, name);
    const setting = (path: string) => configured(store.sessionInfo?.configuration ?? "", path);
    const input = (
      id: string,
      label: string,
      name: "rotary_speed" | "weight_on_bit",
      kind: Kind,
      limit: () => number,
      index: number,
    ): Tile => ({
      id,
      label,
      unit: unit(kind),
      topic: "twin/status",
      columns: [`${name}_applied`],
      scale: scale(kind),
      range: (_min, max) => [0, Math.max(max * 1.05, Number.isFinite(limit()) ? limit() * 1.05 : 1)],
      limits: () => [limit()].filter(Number.isFinite),
      good: (row, layout) => !NOT_THE_RIGS.includes(layout.scalar(row, `${name}_state`)),
      read: (moment) => {
        const state = at(moment, `${name}_state`);
        const show = (column: Scalar) => digits(at(moment, column), kind, system());
        const status = moment.live ? store.status : null;
        // In a recording the status is of the shown time, however long ago it was played.
        const since = store.isBag ? 0 : store.age("twin/status") / 1e3;
        const known = status ? status.input_age[index] + since : NaN;
        const old = Number.isFinite(known) ? ` ${lapse(known)}` : "";
        const age = old === "" ? "" : `, age${old}`;
        const limited = Number.isFinite(limit()) ? ` · limit ${number(limit(), kind === "speed" ? 0 : 1)}` : "";
        const level = levelOf(store, [`${name}_input`], state === 3 || state === 4 ? 2 : state === 0 ? 1 : 0);
        const applied = digits(at(moment, `${name}_applied`), kind, system());
        // A replay has no status, and so no inputs as the rig sent them.
        if (!Number.isFinite(state))
          return { value: applied, note: `no state of this input in the data${limited}`, level };
        if (NOT_THE_RIGS.includes(state)) {
          // What the model runs on meanwhile is not the rig's: it must not stand where the rig's value stands.
          const safe = status?.input_safe[index] ? "safe value" : state === 0 ? "start value" : "held";
          const last = state === 0 ? "no sample received" : `STALE${old}, last ${show(`${name}_received`)}`;
          return { value: "–", note: `${last} · model uses ${applied} (${safe})`, level };
        }
        if (state === TwinStatus.INPUT_REJECTED) {
          const note = `newest sample REJECTED, last good value held${age}${limited}`;
          return { value: applied, note, level, held: true };
        }
        const received = digits(at(moment, `${name}_received`), kind, system());
        const doubted = doubt(status, index);
        const note = `rig ${received} · ${word(INPUT_STATE, state)}${doubted.text}${age}${limited}`;
        return { value: applied, note, level: Math.max(level, doubted.level) };
      },
    });
    const speedLimit = () => store.session?.limits?.rotary_speed_rpm.max ?? setting("inputs.rotary_speed.max_rpm");
    const weightLimit = () => {
      const newton = 1e3 * (store.session?.limits?.weight_on_bit_kn.max ?? setting("inputs.weight_on_bit.max_kn"));
      return convert(newton, "weight", system());
    };
    const force = (
      id: string,
      label: string,
      column: "max_pipe_guide_force" | "max_guide_wall_force",
      vector: "pipe_guide_normal_peak" | "guide_wall_normal_peak",
      layer: "pipe_guide_shock" | "guide_wall_shock",
    ): Tile => ({
      id,
      label,
      unit: unit("force"),
      topic: "twin/contact_forces" as Topic,
      columns: [column] as [Scalar],
      figure: figure(`contact_forces/${column}`, "force"),
      scale: scale("force"),
      range: (_min: number, max: number): [number, number] => [0, Math.max(convert(500, "force", system()), max * 1.1)],
      limits: () => [],
      read: (moment: Moment) => {
        const shock = at(moment, "shock_severity");
        const peaks = moment.layout.vector(moment.row, vector);
        let worst = 0;
        for (let index = 1; index < peaks.length; index++) if (peaks[index] > peaks[worst]) worst = index;
        const depth = store.geometry?.stationDepth[worst] ?? NaN;
        const where = peaks[worst] > 0 ? `at ${withUnit(depth, "depth", system())}` : "no contact";
        const impulse = at(moment, layer);
        const bound = setting("shock.levels.watch");
        const of = Number.isFinite(bound) ? ` / limit ${number(bound, 0)}` : "";
        const strike = Number.isFinite(impulse) ? `, ${number(impulse, 1)}${of} N s` : "";
        return {
          value: digits(at(moment, column), "force", system()),
          note: `${where} · shock ${word(SEVERITY, shock)}${strike}`,
          level: levelOf(store, ["shock"], shock > 0 ? shock : 0),
        };
      },
    });
    return [
      input("rpm", "Rotary speed", "rotary_speed", "speed", speedLimit, 0),
      input("wob", "Weight on bit", "weight_on_bit", "weight", weightLimit, 1),
      {
        id: "bit-speed",
        label: "Bit speed",
        unit: unit("speed"),
        topic: "twin/bit_state",
        columns: ["bit_speed_mean", "bit_speed_min", "bit_speed_max"],
        figure: figure("bit_state/rotary_speed", "speed"),
        scale: scale("speed"),
        range: fromZero(10),
        limits: () => [],
        read: (moment) => {
          const index = at(moment, "stick_slip_index");
          const severity = at(moment, "stick_slip_severity");
          const bound = setting("stick_slip.levels.warning");
          const of = Number.isFinite(bound) ? ` / limit ${number(bound, 1)}` : "";
          return {
            value: digits(at(moment, "bit_speed_mean"), "speed", system()),
            note: `stick-slip ${word(SEVERITY, severity)}, index ${number(index, 2)}${of}`,
            level: levelOf(store, ["stick_slip"], severity > 0 ? severity : 0),
          };
        },
      },
      {
        id: "torque",
        label: "Bit torque",
        unit: unit("torque"),
        topic: "twin/bit_state",
        columns: ["bit_torque_mean"],
        figure: figure("bit_state/torque", "torque"),
        scale: scale("torque"),
        range: fromZero(20),
        limits: () => [],
        read: (moment) => ({
          value: digits(at(moment, "bit_torque_mean"), "torque", system()),
          note: `peak of the last second ${withUnit(at(moment, "bit_torque_max"), "torque", system())}`,
          level: 0,
        }),
      },
      force("pipe-guide", "Pipe on guide", "max_pipe_guide_force", "pipe_guide_normal_peak", "pipe_guide_shock"),
      force("guide-wall", "Guide on wall", "max_guide_wall_force", "guide_wall_normal_peak", "guide_wall_shock"),
      {
        id: "joints",
        label: "Joints at stop",
        unit: () => (store.layout ? `of ${store.layout.counts.joints}` : ""),
        topic: "twin/joint_deflections",
        columns: ["joints_at_limit"],
        figure: { name: "joint_deflections/joints_at_limit", digits: (value) => number(value, 0) },
        scale: (value) => value,
        range: fromZero(4),
        limits: () => [],
        read: (moment) => {
          const moments = moment.layout.vector(moment.row, "joint_stop_moment");
          const most = moments.reduce((a, b) => Math.max(a, b), 0);
          const limit = store.geometry?.jointLimit ?? NaN;
          const rated = setting("joint_load.rated_moment_nm");
          const of = Number.isFinite(rated) ? ` / rated ${withUnit(rated, "torque", system())}` : "";
          return {
            value: number(at(moment, "joints_at_limit"), 0),
            note:
              `bend ${digits(at(moment, "max_bend_angle"), "angle", system())}` +
              ` / ${withUnit(limit, "angle", system())} · stop ${digits(most, "torque", system())}${of}`,
            level: levelOf(store, ["joint_load"], 0),
          };
        },
      },
      {
        id: "pace",
        label: "Real-time factor",
        unit: () => "×",
        topic: "twin/status",
        columns: ["real_time_factor"],
        scale: (value) => value,
        range: (min, max) => [Math.min(0.8, Math.floor(5 * min) / 5), Math.max(1.1, max)],
        limits: () => [0.9, 0.98],
        read: (moment) => {
          const factor = at(moment, "real_time_factor");
          const lateness = moment.live ? (store.status?.lateness ?? NaN) : NaN;
          const late = Number.isFinite(lateness) ? `model late by ${number(lateness * 1e3, 1)} ms · ` : "";
          return {
            value: number(factor, 2),
            note: `${late}limits 0.98, 0.90`,
            level: levelOf(store, ["real_time"], factor < 0.9 ? 2 : factor < 0.98 ? 1 : 0),
          };
        },
      },
    ];
  }

  draw(now: number): void {
    const { context } = this;
    if (!this.pace.due(now, context.revision)) return;
    const { store } = context;
    if (this.element.clientWidth === 0) return;
    const moment = store.moment();
    const { isLive } = store;
    for (const { tile, root, fields } of this.parts) {
      const reading = readTile(tile, moment, store);
      setText(fields.value, reading.value);
      setText(fields.unit, tile.unit());
      setText(fields.range, moment ? rangeOfTile(tile, store) : "");
      setText(fields.note, reading.note);
      setAttribute(fields.note, "title", reading.note);
      setAttribute(root, "data-level", String(reading.level));
      setText(fields.mark, reading.level > 0 ? (PRIORITY_SHAPE[reading.level] ?? "") : "");
      root.classList.toggle("held", reading.held === true || reading.value === "–");
      const age = store.age(tile.topic) / 1e3;
      const old = !store.isBag && store.cursor === null && moment !== null && age > 2;
      root.classList.toggle("old", old);
      const words = old ? `OLD ${lapse(age)}` : age < 1 ? "" : lapse(age);
      setText(fields.age, old || isLive ? words.replace(" –", "") : "");
      root.classList.toggle("aged", fields.age.textContent !== "");
    }
    const [from, to] = context.range;
    const shown = store.isBag ? Math.floor(2 * store.now) : store.cursor;
    const key = `${store.hourRevision} ${store.bands.revision} ${Math.floor(from)} ${Math.floor(to)} ${shown} ${context.revision}`;
    if (key === this.drawn || !moment) return;
    this.drawn = key;
    this.drawStrips(moment.layout, from, to);
  }

  /** The band of plausible tools of a tile's figure, as its strip has it. */
  private band({ figure, scale }: Tile, from: number, to: number): (number | null)[][] {
    const [times, ...ends] = this.context.store.bands.rows(figure?.name ?? "", from, to);
    const scaled = ends.map((column) => column.map((value) => (value === null ? null : scale(value))));
    return withGaps(times, scaled, GAP);
  }

  private drawStrips(layout: Layout, from: number, to: number): void {
    const { hour } = this.context.store;
    const first = Math.max(0, hour.before(from));
    const last = hour.before(to);
    const times: number[] = [];
    for (let index = first; index <= last; index++) times.push(hour.time(index));
    for (const { tile, strip } of this.parts) {
      const columns = tile.columns.map((name) => {
        const offset = layout.offset(name);
        return times.map((_, at) => {
          const row = hour.row(first + at);
          const value = row[offset];
          return Number.isNaN(value) || tile.good?.(row, layout) === false ? null : tile.scale(value);
        });
      });
      const lines = withGaps(times, columns, 2.5 * this.context.store.period);
      strip.set(tile.figure ? withBand(lines, this.band(tile, from, to)) : lines, from, to);
    }
  }
}

/** The range of a tile's value; empty where it has none. */
export function rangeOfTile({ figure }: Tile, store: Store): string {
  return figure ? rangeOf(store, figure.name, figure.digits) : "";
}

/** The reading of a tile at a moment. Only the present values of the rig, a recording or the past have a level. */
export function readTile(tile: Tile, moment: Moment | null, store: Store): Reading {
  if (!moment) return { value: "–", note: "no data yet", level: 0 };
  const reading = tile.read(moment);
  const counts = store.isLive || store.isBag || store.cursor !== null;
  return { ...reading, level: counts ? reading.level || 0 : 0 };
}
