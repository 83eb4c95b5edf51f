// What the rig measures against what the twin computes: the band that is expected and the measurement in one strip.

import { h, setText, show } from "../dom";
import type { Residual, Residuals } from "../messages";
import { stamp } from "../store/topics";
import { convert, digits, type Kind, lapse, number, quantity, type System } from "../units";
import { type Context, Pace, type View } from "../view";
import { MappingView } from "./mapping";
import { Strip, withGaps } from "./strip";

/** Older than this (ms) the comparison is of the past. */
const OLD = 5_000;
/** What is shown before the present (s). */
const BEFORE = 600;
/** What is compared, by its name in the message. */
const QUANTITIES: { name: string; label: string; kind: Kind }[] = [
  { name: "surface_torque", label: "Surface torque", kind: "torque" },
  { name: "hook_load", label: "Hook load", kind: "weight" },
  { name: "downhole_rotary_speed", label: "Speed in the hole", kind: "speed" },
  { name: "downhole_torque", label: "Torque in the hole", kind: "torque" },
  { name: "downhole_weight_on_bit", label: "Weight in the hole", kind: "weight" },
];

const find = (message: Residuals, name: string) => message.residuals.find((of) => of.name === name);

/** Columns of the strip: time, what was measured, edges of the band; by time, with gaps. */
export function rows(all: readonly Residuals[], name: string, from: number): (number | null)[][] {
  const known = all.filter((message) => stamp(message.header) >= from);
  const value = (of: number | undefined) => (of !== undefined && Number.isFinite(of) ? of : null);
  const column = (get: (of: Residual) => number) =>
    known.map((message) => {
      const of = find(message, name);
      return value(of && get(of));
    });
  return withGaps(
    known.map((message) => stamp(message.header)),
    [column((of) => of.measured), column((of) => of.low), column((of) => of.high)],
    3,
  );
}

/** A quantity in words: measured, expected, and how far that is apart. */
export function words(of: Residual, kind: Kind, system: System): string[] {
  if (!Number.isFinite(of.measured)) return ["–", "–", "–"];
  const expected = `${digits(of.low, kind, system)} to ${digits(of.high, kind, system)}`;
  return [digits(of.measured, kind, system), expected, number(of.ratio, 1)];
}

/** What the comparison says, in a sentence. */
export function summary(newest: Residuals): string {
  if (!newest.steady) return "Not judged: speed, weight or an input is not steady.";
  const judged = newest.residuals.filter((of) => Number.isFinite(of.ratio));
  if (judged.length === 0) return "Not judged yet: a mean needs some twenty seconds of steady motion.";
  const state = newest.drilling ? "Drilling" : "Off bottom";
  const depth = Number.isFinite(newest.bit_depth) ? `, bit at ${number(newest.bit_depth, 0)} m` : "";
  if (newest.likely_causes.length === 0) return `${state}${depth}: no residual is surely beyond its band.`;
  return `${state}${depth}. Likely ${newest.likely_causes.slice(0, 3).join(", or ")}.`;
}

/** What follows the rig: estimates with their bands, values in force and as configured, and why they do not move. */
export function following(of: Residuals): { title: string; rows: string[][]; state: string } {
  const band = (low: number, high: number, places: number) => `${number(low, places)} to ${number(high, places)}`;
  const rows = [
    [
      "Friction factor",
      number(of.friction_factor, 2),
      band(of.friction_factor_low, of.friction_factor_high, 2),
      number(of.applied_friction_factor, 3),
      number(of.configured_friction_factor, 3),
    ],
    [
      "Torque tare (N m)",
      number(of.torque_tare, 0),
      band(of.torque_tare_low, of.torque_tare_high, 0),
      number(of.applied_torque_tare, 1),
      number(of.configured_torque_tare, 1),
    ],
  ];
  if (!of.following) {
    return { title: "Friction and tare", rows, state: `Nothing follows the rig: ${of.following_held}.` };
  }
  const held = of.following_held;
  const state = held === "" ? "The twin follows the rig." : `The twin follows the rig, held now: ${held}.`;
  return { title: "Friction and tare follow the rig", rows, state };
}

export class RigView implements View {
  readonly element: HTMLElement;
  private readonly state = h("p", { class: "hint", id: "rig-state" });
  private readonly said = h("p", { id: "rig-summary" });
  private readonly table = h("tbody", {});
  private readonly title = h("h3", {});
  private readonly follows = h("p", { id: "rig-follows" });
  private readonly estimate = h("tbody", { id: "rig-estimate" });
  private readonly unit = h("span", { class: "hint" });
  private readonly choice: HTMLSelectElement;
  private readonly strip: Strip;
  private readonly body: HTMLElement;
  private readonly mapping: MappingView;
  private readonly pace = new Pace(500);

  constructor(private readonly context: Context) {
    this.mapping = new MappingView(context);
    this.choice = h(
      "select",
      { id: "rig-quantity", "aria-label": "Quantity of the comparison" },
      ...QUANTITIES.map(({ name, label }) => h("option", { value: name }, label)),
    );
    this.strip = new Strip(context, {
      lines: 3,
      range: (min, max) => {
        const room = Math.max((max - min) * 0.08, Math.abs(max) * 0.01, 0.5);
        return [min - room, max + room];
      },
      limits: () => [],
      wide: true,
    });
    const heads = (...texts: string[]) =>
      h("thead", {}, h("tr", {}, ...texts.map((text) => h("th", { scope: "col" }, text))));
    this.body = h(
      "div",
      {},
      h("div", { class: "row" }, this.choice, this.unit),
      this.strip.element,
      this.said,
      h("table", { class: "transfer-table" }, heads("", "measured", "expected, 9 of 10", "ratio"), this.table),
      this.title,
      this.follows,
      h(
        "table",
        { class: "transfer-table" },
        heads("", "estimate", "9 of 10", "in force", "configured"),
        this.estimate,
      ),
    );
    this.element = h(
      "section",
      { class: "against", "aria-label": "Rig and twin" },
      h("h2", {}, "What the rig measures, and what the twin expects"),
      this.state,
      this.body,
      this.mapping.element,
    );
  }

  draw(now: number): void {
    const { context } = this;
    this.mapping.draw(now);
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store } = context;
    const { residuals } = store;
    const newest = residuals[residuals.length - 1];
    const past = !store.isBag && store.cursor !== null;
    show(this.body, newest !== undefined && !past);
    if (past) return setText(this.state, "The comparison is of the last minutes.");
    if (!newest) return setText(this.state, "The rig sends nothing to compare (rig/measured).");
    const age = store.isBag ? 0 : 1e3 * (store.now - stamp(newest.header));
    this.element.classList.toggle("old", age > OLD);
    setText(this.state, age > OLD ? `OLD: compared last ${lapse(age / 1e3)} ago.` : "Means over twenty seconds.");
    this.fill(newest);
  }

  private fill(newest: Residuals): void {
    const { store, settings } = this.context;
    const shown = QUANTITIES.find(({ name }) => name === this.choice.value) ?? QUANTITIES[0];
    const from = store.now - BEFORE;
    const columns = rows(store.residuals, shown.name, from).map((column, index) =>
      index === 0
        ? column
        : column.map((value) => (value === null ? null : convert(value, shown.kind, settings.units))),
    );
    this.strip.set(columns, from, store.now + 1);
    setText(this.unit, `${quantity(shown.kind, settings.units).unit} · band: expected · line: measured`);
    setText(this.said, summary(newest));
    this.table.replaceChildren(
      ...QUANTITIES.flatMap(({ name, label, kind }) => {
        const of = find(newest, name);
        if (!of) return [];
        const { unit } = quantity(kind, settings.units);
        const cells = words(of, kind, settings.units).map((text) => h("td", {}, text));
        const beyond = Math.abs(of.ratio) > 1;
        return [h("tr", { "data-beyond": String(beyond) }, h("th", { scope: "row" }, `${label} (${unit})`), ...cells)];
      }),
    );
    const { title, rows: estimates, state } = following(newest);
    setText(this.title, title);
    setText(this.follows, state);
    this.estimate.replaceChildren(
      ...estimates.map(([name, ...values]) =>
        h("tr", {}, h("th", { scope: "row" }, name), ...values.map((text) => h("td", {}, text))),
      ),
    );
  }
}
