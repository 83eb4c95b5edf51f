// One location of the tool: orbit, full spectrum, forces, stop moment and its alarms.

import { title } from "../alarms";
import * as api from "../api";
import { configured } from "../configuration";
import { h, setText, show } from "../dom";
import { fullSpectrum } from "../spectrum";
import { type BandRows, GAP, type LayerOfForce } from "../store/bands";
import type { Vector } from "../store/layout";
import { heard, type Motion, PastMotion } from "../store/motion";
import type { Ring } from "../store/ring";
import { clock, convert, digits, number, quantity, withUnit } from "../units";
import { type Context, Pace, type ToolLocation, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, SEVERITY, WHIRL_KIND, word } from "../words";
import { drawOrbit, drawSpectrum } from "./orbit";
import { Strip, withBand, withGaps } from "./strip";

/** Length of the strips and of the motion in the spectrum (s). */
const SPAN = 30;
/** Largest distance of an alarm that belongs to a location (m): half a link. */
const NEAR = 0.1;

/** Forces that plausible tools have too, by their column. */
const LAYERS: Partial<Record<Vector, LayerOfForce>> = {
  pipe_guide_normal_peak: "pipe_guide",
  guide_wall_normal_peak: "guide_wall",
};

export class LocationView implements View {
  readonly element: HTMLElement;
  private readonly title = h("h2", { id: "location-title" });
  private readonly none = h(
    "p",
    { class: "none" },
    "Select a joint or station in the picture of the tool, or step through the joints.",
  );
  private readonly body: HTMLElement;
  private readonly orbit = h("canvas", {
    id: "orbit",
    role: "img",
    "aria-label": "Orbit of the pipe in its clearance",
  });
  private readonly spectrum = h("canvas", { id: "spectrum", role: "img", "aria-label": "Full spectrum of the orbit" });
  private readonly source = h("p", { class: "hint" });
  private readonly facts = h("dl", { class: "facts-list" });
  private readonly alarms = h("ul", { class: "location-alarms" });
  private readonly forces: Strip;
  private readonly outer: Strip;
  private readonly moments: Strip;
  private readonly momentTitle = h("h3");
  private readonly innerTitle = h("h3");
  private readonly outerTitle = h("h3");
  private readonly fast = new Pace(50);
  private readonly slow = new Pace(500);
  private readonly past = new PastMotion(api.orbit);
  private factsKey = "";

  constructor(private readonly context: Context) {
    const strip = (limits: () => number[], least: () => number, plausible = false) =>
      new Strip(context, {
        lines: 1,
        plausible,
        wide: true,
        limits,
        range: (_min, max) => [0, Math.max(least(), max * 1.1)],
      });
    const units = () => context.settings.units;
    this.forces = strip(
      () => [],
      () => convert(100, "force", units()),
      true,
    );
    this.outer = strip(
      () => [],
      () => convert(100, "force", units()),
      true,
    );
    const rated = () =>
      convert(
        configured(context.store.sessionInfo?.configuration ?? "", "joint_load.rated_moment_nm"),
        "torque",
        units(),
      );
    this.moments = strip(
      () => [rated()].filter(Number.isFinite),
      () => convert(10, "torque", units()),
    );
    const go = (by: number) =>
      h(
        "button",
        { type: "button", "aria-label": by < 0 ? "joint above" : "joint below", onclick: () => this.step(by) },
        by < 0 ? "◂" : "▸",
      );
    this.body = h(
      "div",
      { class: "location-body" },
      h("div", { class: "orbit-row" }, this.orbit, this.facts),
      this.source,
      h("h3", {}, "Full spectrum, in multiples of the rotary speed"),
      this.spectrum,
      this.innerTitle,
      this.forces.element,
      this.outerTitle,
      this.outer.element,
      this.momentTitle,
      this.moments.element,
      h("h3", {}, "Alarms at this location"),
      this.alarms,
    );
    this.element = h(
      "section",
      { class: "location", "aria-label": "Location" },
      h("div", { class: "row" }, go(-1), this.title, go(1)),
      this.none,
      this.body,
    );
  }

  private step(by: number): void {
    const { geometry } = this.context.store;
    if (!geometry) return;
    const count = geometry.jointDepth.length;
    const joint = ((this.context.location?.joint ?? (by > 0 ? -1 : count)) + by + count) % count;
    this.context.choose({ joint, station: geometry.jointStation[joint] });
  }

  draw(now: number): void {
    const { context } = this;
    const { store, location, settings } = context;
    if (this.element.clientWidth === 0) return;
    const geometry = store.geometry;
    show(this.none, location === null);
    show(this.body, location !== null);
    if (!location || !geometry || location.station >= geometry.stationDepth.length) {
      setText(this.title, "No location selected");
      return;
    }
    if (!this.fast.due(now, context.revision)) return;
    const name = location.joint === null ? `Station ${location.station}` : `Joint ${location.joint + 1}`;
    const inclination = number((geometry.stationInclination[location.station] * 180) / Math.PI, 0);
    const depth = withUnit(geometry.stationDepth[location.station], "depth", settings.units);
    setText(this.title, `${name} · ${depth} · ${inclination}°`);
    const recent = this.pipe(location);
    const kept =
      recent.times.length === 0 && location.joint !== null ? this.past.at(location.joint, store.shown) : null;
    const pipe = kept ?? recent;
    const guide = this.guideNow(location.station);
    const tool = store.session?.tool;
    drawOrbit(this.orbit, context, pipe.times.length > 0 ? pipe : this.pipeThen(location.station), guide, {
      pipe: tool?.pipe_clearance ?? 0.0085,
      guide: tool?.guide_clearance ?? 0.008,
    });
    if (!this.slow.due(now, context.revision)) return;
    this.drawSlow(location, pipe, kept);
  }

  /** The pipe's axis about the bore's: of joints at their own rate, of other stations as often as the shape comes. */
  private pipe(location: ToolLocation): Motion {
    const { store } = this.context;
    const { layout } = store;
    if (!layout) return { times: [], y: [], z: [] };
    const { joints, stations } = layout.counts;
    if (location.joint !== null) return heard(store.joints, location.joint, joints + location.joint, store.shown, SPAN);
    return heard(store.shapes, location.station, stations + location.station, store.shown, SPAN);
  }

  /** The one position that the hour has of a second. */
  private pipeThen(station: number): Motion {
    const moment = this.context.store.moment();
    if (!moment) return { times: [], y: [], z: [] };
    const { layout, row, time } = moment;
    const at = (name: Vector) => layout.vector(row, name)[station] || 0;
    return { times: [time], y: [at("pipe_y")], z: [at("pipe_z")] };
  }

  private guideNow(station: number): [number, number] {
    const { store } = this.context;
    const moment = store.moment();
    if (!moment) return [0, 0];
    const { layout, row } = moment;
    return [layout.vector(row, "guide_y")[station] || 0, layout.vector(row, "guide_z")[station] || 0];
  }

  private drawSlow(location: ToolLocation, pipe: Motion, kept: Motion | null | undefined): void {
    const { context } = this;
    const { store, settings } = context;
    const moment = store.moment();
    const geometry = store.geometry;
    if (!moment || !geometry) return;
    const { layout, row } = moment;
    const rate =
      pipe.times.length > 1 ? (pipe.times.length - 1) / (pipe.times[pipe.times.length - 1] - pipe.times[0]) : 0;
    const turns = layout.scalar(row, "rotary_speed_applied") / (2 * Math.PI);
    const clearance = store.session?.tool?.pipe_clearance ?? 0.0085;
    drawSpectrum(this.spectrum, context, fullSpectrum(pipe.y, pipe.z, rate), turns, clearance);
    setText(this.source, this.words(location, pipe, kept, rate));
    const { stations, joints } = layout.counts;
    const unit = quantity("force", settings.units).unit;
    this.strip(this.forces, store.contacts, location.station, ["pipe_guide_normal_peak", location.station], "force");
    this.strip(
      this.outer,
      store.contacts,
      stations + location.station,
      ["guide_wall_normal_peak", location.station],
      "force",
    );
    const shaded = store.bands.fresh(store.shown)?.measured_depth.length ? "; shaded: plausible tools" : "";
    setText(this.innerTitle, `Pipe on guide (${unit}), peak per interval${shaded}`);
    setText(this.outerTitle, `Guide on wall (${unit}), peak per interval${shaded}`);
    show(this.momentTitle, location.joint !== null);
    show(this.moments.element, location.joint !== null);
    if (location.joint !== null) {
      this.strip(
        this.moments,
        store.joints,
        2 * joints + location.joint,
        ["joint_stop_moment", location.joint],
        "torque",
      );
      const rated = configured(store.sessionInfo?.configuration ?? "", "joint_load.rated_moment_nm");
      const of = Number.isFinite(rated) ? `, dashed: rated ${withUnit(rated, "torque", settings.units)}` : "";
      setText(this.momentTitle, `Stop moment (${quantity("torque", settings.units).unit})${of}`);
    }
    this.list(location);
  }

  /** What the motion is of, or why there is none. */
  private words(location: ToolLocation, pipe: Motion, kept: Motion | null | undefined, rate: number): string {
    if (pipe.times.length === 0) {
      const hour = "Dot and strips come from the hour's history, one row per second; a recording has the full motion.";
      if (location.joint === null) {
        return `No motion: between joints it is kept for one minute only; joints are kept for longer. ${hour}`;
      }
      return kept === undefined
        ? "Loading the motion of this time."
        : `No motion: the server has none of this joint within 10 s of this time. ${hour}`;
    }
    const what = kept
      ? `Motion of the ${number(pipe.times[pipe.times.length - 1] - pipe.times[0], 1)} s until ` +
        `${clock(pipe.times[pipe.times.length - 1])}: before the last minute three seconds of every ten are kept. `
      : "";
    return (
      `${what}View down the hole; forward whirl is clockwise. Solid circle: limit of the pipe's axis in the bore; ` +
      `dashed circle: its limit in the guide at the guide's present position. Clearance used: largest deflection over ` +
      `the clearance. Contact time: share of the time in contact. ` +
      `${number(rate, 0)} positions per second${location.joint === null ? "; joints have more." : "."}`
    );
  }

  /** A column of a ring over the last seconds; where those are no longer kept, that of the hour, a value a second. */
  private strip(
    strip: Strip,
    quick: Ring,
    column: number,
    [vector, index]: [Vector, number],
    kind: "force" | "torque",
  ): void {
    const { store, settings } = this.context;
    const to = store.shown;
    const factor = convert(1, kind, settings.units);
    const kept = quick.length > 0 && quick.before(to) >= 0 && quick.time(0) <= to - 1;
    const [ring, at] = kept || !store.layout ? [quick, column] : [store.hour, store.layout.offset(vector) + index];
    const from = kept ? to - SPAN : to - 10 * SPAN;
    const times: number[] = [];
    const values: (number | null)[] = [];
    for (let row = Math.max(0, ring.before(from)); row < ring.length; row++) {
      const time = ring.time(row);
      if (time > to) break;
      const value = ring.value(row, at);
      times.push(time);
      values.push(Number.isNaN(value) ? null : value * factor);
    }
    // A gap is three intervals of the topic long, and half a second at least.
    const interval = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0;
    const most = ring === store.hour ? 2.5 * store.period : Math.max(0.5, 3 * interval);
    const lines = withGaps(times, [values], most);
    const layer = LAYERS[vector];
    strip.set(layer ? withBand(lines, this.band(layer, index, from, to)) : lines, from, to);
  }

  /** The force of a layer at a station in plausible tools, as a strip has it. */
  private band(layer: LayerOfForce, station: number, from: number, to: number): (number | null)[][] {
    const { store, settings } = this.context;
    const depth = store.geometry?.stationDepth[station] ?? NaN;
    const [times, ...ends]: BandRows = store.bands.stationRows(layer, depth, from, to);
    const factor = convert(1, "force", settings.units);
    const scaled = ends.map((column) => column.map((value) => (value === null ? null : value * factor)));
    return withGaps(times, scaled, GAP);
  }

  private list(location: ToolLocation): void {
    const { store, settings } = this.context;
    const moment = store.moment();
    const geometry = store.geometry;
    if (!moment || !geometry) return;
    const { layout, row } = moment;
    const depth = geometry.stationDepth[location.station];
    const facts: [string, string][] = [];
    for (const [body, pipe] of [
      [0, "Pipe"],
      [1, "Guide"],
    ] as const) {
      const index = geometry.watchedDepth.findIndex(
        (at, watched) => geometry.watchedBody[watched] === body && Math.abs(at - depth) < 1e-3,
      );
      if (index < 0) continue;
      const kind = layout.vector(row, "whirl_kind")[index];
      const ratio = layout.vector(row, "whirl_ratio")[index];
      const severity = layout.vector(row, "whirl_severity")[index];
      const of = Number.isFinite(ratio) ? ` ${number(ratio, 2)}×` : "";
      facts.push([
        `${pipe} whirl`,
        `${word(WHIRL_KIND, kind)}${of}${severity > 0 ? `, ${word(SEVERITY, severity)}` : ""}`,
      ]);
      facts.push([`${pipe} clearance used`, `${number(100 * layout.vector(row, "clearance_ratio")[index], 0)} %`]);
      facts.push([`${pipe} contact time`, `${number(100 * layout.vector(row, "contact_duty")[index], 0)} %`]);
    }
    if (location.joint !== null) {
      const bend = layout.vector(row, "joint_bend_angle")[location.joint];
      const limit = geometry.jointLimit;
      facts.push([
        bend >= limit ? "Bend, at stop" : "Bend",
        `${digits(bend, "angle", settings.units)} / ${withUnit(limit, "angle", settings.units)}`,
      ]);
      const stop = layout.vector(row, "joint_stop_moment")[location.joint];
      const rated = configured(store.sessionInfo?.configuration ?? "", "joint_load.rated_moment_nm");
      const of = Number.isFinite(rated) ? ` / rated ${withUnit(rated, "torque", settings.units)}` : "";
      facts.push(["Stop moment", `${digits(stop, "torque", settings.units)}${of}`]);
    }
    const key = JSON.stringify(facts);
    if (key !== this.factsKey) {
      this.factsKey = key;
      this.facts.replaceChildren(...facts.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
    }
    const here = (store.alarmsShown()?.alarms ?? []).filter(
      (alarm) => alarm.state >= 1 && alarm.state <= 3 && Math.abs(alarm.measured_depth - depth) < NEAR,
    );
    this.alarms.replaceChildren(
      ...(here.length > 0
        ? here.map((alarm) =>
            h(
              "li",
              {},
              `${PRIORITY_SHAPE[alarm.priority]} ${title(alarm)} (${word(PRIORITY, alarm.priority)}): ` +
                alarm.what_to_do,
            ),
          )
        : [h("li", { class: "none" }, "none")]),
    );
  }
}
