// Torque and weight from the surface to the bit, and where the rest is lost. A row without a value is not shown.

import { h, setText, show } from "../dom";
import { TRANSFER } from "../figures";
import type { Transfer, TwinStatus } from "../messages";
import { RANGE_HINT, rangeOf } from "../ranges";
import { digits, type Kind, lapse, number, quantity, type System, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { doubt, INPUT_STATE, word } from "../words";

/** Older than this (ms) the figures are of the past. */
const OLD = 2000;
/** Optional inputs: their names in the status, as the driller says them, and what they are. */
const OPTIONAL: Record<string, [string, Kind]> = {
  rate_of_penetration: ["Rate of penetration", "advance"],
  standpipe_pressure: ["Standpipe pressure", "pressure"],
};

/** A row: its label, and one text per column; an empty one where there is no value. */
export interface Row {
  label: string;
  values: string[];
  /** Ranges of plausible tools behind the values; left out where no value has one. */
  ranges?: string[];
}

/** The range of a figure of the transfer in plausible tools; empty where it has none. */
export type Ranges = (field: string, digits: (value: number) => string) => string;
const NO_RANGES: Ranges = () => "";

type Figure = (typeof TRANSFER)[number];
const of = (...groups: Figure["group"][]): readonly Figure[] => TRANSFER.filter(({ group }) => groups.includes(group));

/** Why a figure that has a value is not shown; the others are shown wherever they have one. */
const HIDDEN: Partial<Record<Figure["field"], (t: Transfer) => boolean>> = {
  // A tool whose joints have no friction has none to show.
  joint_friction_torque: (t) => t.joint_friction_power === 0,
  // A tool that neither cuts nor advances has no rate to show.
  rate_of_penetration: (t) => !t.rate_of_penetration && Number.isNaN(t.depth_of_cut),
  // A drive that is never at its limit has nothing to show.
  drive_at_limit: (t) => !(t.drive_at_limit > 0),
};

/** The value of a figure; NaN where there is none to show. */
const value = (t: Transfer, { field }: Figure) => (HIDDEN[field]?.(t) ? NaN : t[field]);

/** A share in per cent; a part is never shown as nothing or as all. Empty where there is none. */
export function percent(share: number): string {
  const value = 100 * share;
  if (!Number.isFinite(value)) return "";
  if (value > 0 && value < 0.1) return "< 0.1 %";
  if (value < 0 && value > -0.1) return "> -0.1 %";
  if (value > 99.9 && value < 100) return "> 99.9 %";
  // A share of next to nothing has no digits that mean anything.
  if (Math.abs(value) > 1000) return value > 0 ? "> 1000 %" : "< -1000 %";
  return `${number(value, 1)} %`;
}

/** A value and its range. */
type Cell = [value: string, range: string];

/** A row of cells, without ranges where no cell has one. */
function row(label: string, cells: Cell[]): Row {
  const values = cells.map(([value]) => value);
  // A range says nothing where there is no value.
  const ranges = cells.map(([value, range]) => (value === "" ? "" : range));
  return ranges.some((range) => range !== "") ? { label, values, ranges } : { label, values };
}

const held = (rows: Row[]) => rows.filter((row) => row.values.some((value) => value !== ""));

/** Two groups side by side, a row for each label of either. */
function sideBySide(t: Transfer, system: System, groups: [Figure["group"], Figure["group"]], ranges: Ranges): Row[] {
  const labels = new Set(of(...groups).map(({ label }) => label));
  const cell = (group: Figure["group"], wanted: string): Cell => {
    const found = of(group).find(({ label }) => label === wanted);
    if (!found || !Number.isFinite(value(t, found))) return ["", ""];
    const text = (of: number) => digits(of, found.kind as Kind, system);
    return [text(value(t, found)), ranges(found.field, text)];
  };
  return held(
    [...labels].map((label) =>
      row(
        label,
        groups.map((group) => cell(group, label)),
      ),
    ),
  );
}

/** Torque and weight at each place, and what arrives. */
export function places(t: Transfer, system: System, ranges = NO_RANGES): Row[] {
  const weight = t.surface_weight >= 100 ? percent(t.bit_weight / t.surface_weight) : "";
  const torque: Cell = [percent(t.torque_efficiency), ranges("torque_efficiency", percent)];
  const arrives = row("Arrives at the bit", [torque, [weight, ""]]);
  return [...sideBySide(t, system, ["torque", "weight"], ranges), ...held([arrives])];
}

/** Torque and axial drag that friction takes. */
export function losses(t: Transfer, system: System, ranges = NO_RANGES): Row[] {
  return sideBySide(t, system, ["friction", "drag"], ranges);
}

/** Powers (W) and their shares of all that is put in. */
export function powers(t: Transfer): { putIn: Row[]; taken: Row[] } {
  const known = (group: Figure["group"]) =>
    of(group)
      .map((figure) => ({ label: figure.label, power: value(t, figure) }))
      .filter(({ power }) => Number.isFinite(power) && power !== 0);
  const total = known("putin").reduce((sum, { power }) => sum + power, 0);
  const rows = (group: Figure["group"]): Row[] =>
    known(group).map(({ label, power }) => ({
      label,
      values: [`${number(power, Math.abs(power) < 10 ? 1 : 0)} W`, total > 0 ? percent(power / total) : ""],
    }));
  return { putIn: rows("putin"), taken: rows("taken") };
}

/** What the whole tool does: limit of the top drive, hook load, advance. */
export function facts(t: Transfer, system: System, ranges = NO_RANGES): Row[] {
  const cell = (figure: Figure): Cell => {
    const found = value(t, figure);
    if (!Number.isFinite(found)) return ["", ""];
    const kind: string = figure.kind;
    if (kind === "share") return [percent(found), ranges(figure.field, percent)];
    if (kind === "timeshare") return [`${percent(found)} of the time`, ranges(figure.field, percent)];
    const range = ranges(figure.field, (of) => digits(of, kind as Kind, system));
    return [withUnit(found, kind as Kind, system) + (kind === "cut" ? " per turn" : ""), range];
  };
  return held(of("whole").map((figure) => row(figure.label, [cell(figure)])));
}

/** Inputs beyond speed and weight that the tool uses: value, quality, age. The status leaves out those that it does not. */
export function optionalInputs(status: TwinStatus, since: number, system: System): Row[] {
  return status.input_name.flatMap((name, index) => {
    const known = OPTIONAL[name];
    if (!known) return [];
    const [label, kind] = known;
    const age = status.input_age[index] + since;
    const old = Number.isFinite(age) ? `, age ${lapse(age)}` : "";
    return [
      {
        label,
        values: [
          withUnit(status.input_applied[index], kind, system),
          word(INPUT_STATE, status.input_state[index]) + doubt(status, index).text + old,
        ],
      },
    ];
  });
}

/** A table whose rows come and go with what they hold. */
class Table {
  readonly element: HTMLElement;
  private readonly heads: HTMLElement[];
  private readonly body = h("tbody");
  private rows: { row: HTMLElement; label: HTMLElement; cells: { value: HTMLElement; range: HTMLElement }[] }[] = [];

  constructor(
    title: string,
    private readonly columns: number,
  ) {
    this.heads = Array.from({ length: columns }, () => h("th", { scope: "col" }));
    const head = h("thead", {}, h("tr", {}, h("th", { scope: "col", class: "what" }, title), ...this.heads));
    this.element = h("table", { class: "transfer-table" }, head, this.body);
  }

  set(heads: string[], rows: Row[]): void {
    this.heads.forEach((head, index) => setText(head, heads[index] ?? ""));
    while (this.rows.length < rows.length) {
      const cells = Array.from({ length: this.columns }, () => ({
        value: h("span"),
        range: h("span", { class: "range", title: RANGE_HINT }),
      }));
      const label = h("th", { scope: "row" });
      const row = h("tr", {}, label, ...cells.map(({ value, range }) => h("td", {}, value, range)));
      this.body.append(row);
      this.rows.push({ row, label, cells });
    }
    this.rows.forEach(({ row, label, cells }, index) => {
      const found = rows[index];
      show(row, found !== undefined);
      if (!found) return;
      setText(label, found.label);
      cells.forEach(({ value, range }, column) => {
        setText(value, found.values[column] ?? "");
        setText(range, found.ranges?.[column] ?? "");
      });
    });
    show(this.element, rows.length > 0);
  }
}

export class TransferView implements View {
  readonly element: HTMLElement;
  private readonly state = h("p", { class: "hint", id: "transfer-state" });
  private readonly body: HTMLElement;
  private readonly places = new Table("From the surface to the bit", 2);
  private readonly losses = new Table("Friction takes", 2);
  private readonly facts = new Table("Advance", 1);
  private readonly putIn = new Table("Power put in", 2);
  private readonly taken = new Table("Power taken", 2);
  private readonly inputs = new Table("Inputs", 2);
  private readonly pace = new Pace(250);

  constructor(private readonly context: Context) {
    const tables = [this.places, this.losses, this.facts, this.putIn, this.taken];
    this.body = h("div", { class: "transfer-body" }, ...tables.map((table) => table.element));
    this.element = h(
      "section",
      { class: "transfer", "aria-label": "Transfer" },
      this.state,
      this.body,
      this.inputs.element,
    );
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store, settings } = context;
    const system = settings.units;
    const past = !store.isBag && store.cursor !== null;
    const transfer = past ? null : store.transfer;
    const age = store.isBag ? 0 : store.age("twin/transfer");
    this.element.classList.toggle("old", transfer !== null && age > OLD);
    show(this.body, transfer !== null && transfer.duration > 0);
    if (past) setText(this.state, "Only the present figures are known here; a recording has all of them.");
    else if (!transfer || transfer.duration <= 0) setText(this.state, "No figures yet.");
    else {
      const old = age > OLD ? `OLD ${lapse(age / 1e3)} · ` : "";
      setText(this.state, `${old}Means of the last ${number(transfer.duration, 1)} s, computed by the model.`);
      const heads = [quantity("torque", system).unit, quantity("weight", system).unit];
      const ranges: Ranges = (field, text) => rangeOf(store, `transfer/${field}`, text);
      const { putIn, taken } = powers(transfer);
      this.places.set(heads, places(transfer, system, ranges));
      this.losses.set(heads, losses(transfer, system, ranges));
      this.facts.set([""], facts(transfer, system, ranges));
      this.putIn.set(["", "share"], putIn);
      this.taken.set(["", "share"], taken);
    }
    const since = store.isBag ? 0 : store.age("twin/status") / 1e3;
    const { status } = store;
    this.inputs.set(["model uses", "quality"], status && !past ? optionalInputs(status, since, system) : []);
  }
}
