// The numbers that matter, each with its limits, its age and a trail.

import { configured } from "../configuration";
import { h, setAttribute, setText } from "../dom";
import type { Layout, Scalar } from "../store/layout";
import type { Moment } from "../store/store";
import type { Topic } from "../store/topics";
import { convert, digits, type Kind, lapse, number, quantity, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { INPUT_STATE, PRIORITY_SHAPE, SEVERITY, word } from "../words";
import { Strip } from "./strip";

/** What one tile shows. */
interface Reading {
  value: string;
  /** Below the number: what it is held against, what the rig says. */
  note: string;
  /** 0 nothing to say, 1 to 3 as priorities. */
  level: number;
}

interface Tile {
  id: string;
  label: string;
  unit: () => string;
  topic: Topic;
  /** Value, then lower and upper edge of the band around it. */
  columns: [Scalar] | [Scalar, Scalar, Scalar];
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

export class Numbers implements View {
  readonly element = h("section", { class: "numbers", "aria-label": "Numbers" });
  private readonly parts: { tile: Tile; strip: Strip; root: HTMLElement; fields: Record<string, HTMLElement> }[] = [];
  private readonly pace = new Pace(100);
  private drawn = "";

  constructor(private readonly context: Context) {
    for (const tile of this.tiles()) {
      const strip = new Strip(context, { lines: tile.columns.length, range: tile.range, limits: tile.limits });
      const field = (name: string) => h("span", { class: name });
      const fields = {
        mark: field("mark"),
        value: h("output", { class: "value", id: `value-${tile.id}` }),
        unit: field("unit"),
        note: field("note"),
        age: field("age"),
      };
      const root = h(
        "article",
        { class: "tile", id: `tile-${tile.id}`, "aria-label": tile.label },
        h("h2", {}, tile.label, fields.mark),
        h("div", { class: "big" }, fields.value, fields.unit),
        fields.note,
        fields.age,
        strip.element,
      );
      this.element.append(root);
      this.parts.push({ tile, strip, root, fields });
    }
  }

  private tiles(): Tile[] {
    const { context } = this;
    const { store } = context;
    const system = () => context.settings.units;
    const unit = (kind: Kind) => () => quantity(kind, system()).unit;
    const scale = (kind: Kind) => (value: number) => convert(value, kind, system());
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
      read: (moment) => {
        const state = at(moment, `${name}_state`);
        const received = digits(at(moment, `${name}_received`), kind, system());
        const late = moment.live && store.status ? store.status.input_age[index] + store.age("twin/status") / 1e3 : NaN;
        const limited = Number.isFinite(limit()) ? ` · limit ${number(limit(), kind === "speed" ? 0 : 1)}` : "";
        const age = Number.isFinite(late) ? ` ${lapse(late)}` : "";
        const safe = moment.live && store.status?.input_safe[index] ? " · TO SAFE VALUE" : "";
        return {
          value: digits(at(moment, `${name}_applied`), kind, system()),
          note: `rig ${received} · ${word(INPUT_STATE, state)}${age}${safe}${limited}`,
          level: state === 3 || state === 4 ? 2 : state === 0 ? 1 : 0,
        };
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
      column: Scalar,
      vector: "pipe_guide_normal_peak" | "guide_wall_normal_peak",
    ) => ({
      id,
      label,
      unit: unit("force"),
      topic: "twin/contact_forces" as Topic,
      columns: [column] as [Scalar],
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
        return {
          value: digits(at(moment, column), "force", system()),
          note: `${where} · shock ${word(SEVERITY, shock)}`,
          level: shock > 0 ? shock : 0,
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
        scale: scale("speed"),
        range: fromZero(10),
        limits: () => [],
        read: (moment) => {
          const index = at(moment, "stick_slip_index");
          const severity = at(moment, "stick_slip_severity");
          const bound = setting("stick_slip.levels.warning");
          const of = Number.isFinite(bound) ? ` of ${number(bound, 1)}` : "";
          return {
            value: digits(at(moment, "bit_speed_mean"), "speed", system()),
            note: `stick-slip ${word(SEVERITY, severity)}, index ${number(index, 2)}${of}`,
            level: severity,
          };
        },
      },
      {
        id: "torque",
        label: "Bit torque",
        unit: unit("torque"),
        topic: "twin/bit_state",
        columns: ["bit_torque_mean"],
        scale: scale("torque"),
        range: fromZero(20),
        limits: () => [],
        read: (moment) => ({
          value: digits(at(moment, "bit_torque_mean"), "torque", system()),
          note: `largest ${withUnit(at(moment, "bit_torque_max"), "torque", system())} within a second`,
          level: 0,
        }),
      },
      force("pipe-guide", "Pipe on guide", "max_pipe_guide_force", "pipe_guide_normal_peak"),
      force("guide-wall", "Guide on wall", "max_guide_wall_force", "guide_wall_normal_peak"),
      {
        id: "joints",
        label: "Joints at their stop",
        unit: () => (store.layout ? `of ${store.layout.counts.joints}` : ""),
        topic: "twin/joint_deflections",
        columns: ["joints_at_limit"],
        scale: (value) => value,
        range: fromZero(4),
        limits: () => [],
        read: (moment) => {
          const moments = moment.layout.vector(moment.row, "joint_stop_moment");
          const most = moments.reduce((a, b) => Math.max(a, b), 0);
          const limit = store.geometry?.jointLimit ?? NaN;
          return {
            value: number(at(moment, "joints_at_limit"), 0),
            note:
              `bend ${withUnit(at(moment, "max_bend_angle"), "angle", system())}` +
              ` / ${withUnit(limit, "angle", system())}` +
              ` · stop's peak ${withUnit(most, "torque", system())}`,
            level: 0,
          };
        },
      },
      {
        id: "pace",
        label: "Pace of the model",
        unit: () => "×",
        topic: "twin/status",
        columns: ["real_time_factor"],
        scale: (value) => value,
        range: (min, max) => [Math.min(0.85, min), Math.max(1.1, max)],
        limits: () => [0.9, 0.98],
        read: (moment) => {
          const factor = at(moment, "real_time_factor");
          const lateness = moment.live ? (store.status?.lateness ?? NaN) : NaN;
          const late = Number.isFinite(lateness) ? `behind ${number(lateness * 1e3, 1)} ms · ` : "";
          return {
            value: number(factor, 2),
            note: `${late}limits 0.98, 0.90`,
            level: factor < 0.9 ? 2 : factor < 0.98 ? 1 : 0,
          };
        },
      },
    ];
  }

  draw(now: number): void {
    const { context } = this;
    if (!this.pace.due(now, context.revision)) return;
    const { store } = context;
    const moment = store.moment();
    for (const { tile, root, fields } of this.parts) {
      const reading = moment ? tile.read(moment) : { value: "–", note: "not heard yet", level: 0 };
      setText(fields.value, reading.value);
      setText(fields.unit, tile.unit());
      setText(fields.note, reading.note);
      setAttribute(root, "data-level", String(reading.level || 0));
      setText(fields.mark, reading.level > 0 ? (PRIORITY_SHAPE[reading.level] ?? "") : "");
      const age = store.age(tile.topic) / 1e3;
      const old = !store.isBag && moment?.live === true && age > 2;
      root.classList.toggle("old", old);
      setText(fields.age, store.isBag || !moment?.live ? "" : old ? `OLD ${lapse(age)}` : age < 1 ? "" : lapse(age));
    }
    const [from, to] = context.range;
    const shown = store.isBag ? Math.floor(2 * store.now) : store.cursor;
    const key = `${store.hourRevision} ${Math.floor(from)} ${Math.floor(to)} ${shown} ${context.revision}`;
    if (key === this.drawn || !moment) return;
    this.drawn = key;
    this.drawStrips(moment.layout, from, to);
  }

  private drawStrips(layout: Layout, from: number, to: number): void {
    const { hour } = this.context.store;
    const first = Math.max(0, hour.before(from));
    const last = hour.before(to);
    const times: number[] = [];
    for (let index = first; index <= last; index++) times.push(hour.time(index));
    for (const { tile, strip } of this.parts) {
      const data: (number | null)[][] = [times];
      for (const name of tile.columns) {
        const offset = layout.offset(name);
        const column: (number | null)[] = [];
        for (let index = first; index <= last; index++) {
          const value = hour.value(index, offset);
          column.push(Number.isNaN(value) ? null : tile.scale(value));
        }
        data.push(column);
      }
      strip.set(data, from, to);
    }
  }
}
