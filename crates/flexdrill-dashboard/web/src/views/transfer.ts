// Torque and weight from the surface to the bit, and where the rest is lost. A row without a value is not shown.

import { h, setText, show } from "../dom";
import type { Transfer, TwinStatus } from "../messages";
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
}

interface Power {
  label: string;
  of: (t: Transfer) => number;
}

const PUT_IN: Power[] = [
  { label: "Top drive", of: (t) => t.drive_power },
  { label: "Hoist", of: (t) => t.hoist_power },
  { label: "Weight on bit", of: (t) => t.weight_on_bit_power },
  { label: "Gravity", of: (t) => t.gravity_power },
  { label: "Advance against the wall", of: (t) => t.feed_power },
  { label: "Pressure", of: (t) => t.pressure_power },
  { label: "Loads", of: (t) => t.load_power },
];

const TAKEN: Power[] = [
  { label: "Rock", of: (t) => t.bit_power },
  { label: "Pipe in guide", of: (t) => t.pipe_guide_friction_power },
  { label: "Guide on wall", of: (t) => t.guide_wall_friction_power },
  { label: "Joints", of: (t) => t.joint_friction_power },
  { label: "String", of: (t) => t.string_power },
  { label: "Collisions", of: (t) => t.contact_damping_power },
  { label: "Damping of the steel", of: (t) => t.rayleigh_damping_power },
  { label: "Mud around the pipes", of: (t) => t.mud_power },
];

/** A value with its digits; empty where there is none. */
const text = (value: number, kind: Kind, system: System) => (Number.isFinite(value) ? digits(value, kind, system) : "");

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

const held = (rows: Row[]) => rows.filter((row) => row.values.some((value) => value !== ""));

/** Torque and weight at each place, and what arrives. */
export function places(t: Transfer, system: System): Row[] {
  const row = (label: string, torque: number, weight: number): Row => ({
    label,
    values: [text(torque, "torque", system), text(weight, "weight", system)],
  });
  const arrives = t.bit_weight / t.surface_weight;
  return held([
    row("Surface", t.surface_torque, t.surface_weight),
    row("Kick-off", t.kickoff_torque, t.kickoff_weight),
    row("Bit", t.bit_torque, t.bit_weight),
    {
      label: "Arrives at the bit",
      values: [percent(t.torque_efficiency), t.surface_weight >= 100 ? percent(arrives) : ""],
    },
  ]);
}

/** Torque and axial drag that friction takes. */
export function losses(t: Transfer, system: System): Row[] {
  const row = (label: string, torque: number, drag: number): Row => ({
    label,
    values: [text(torque, "torque", system), text(drag, "weight", system)],
  });
  // A tool whose joints have no friction has none to show.
  const joints = t.joint_friction_power === 0 ? NaN : t.joint_friction_torque;
  return held([
    row("String", t.string_friction_torque, t.string_axial_drag),
    row("Pipe in guide", t.pipe_guide_friction_torque, t.pipe_guide_axial_drag),
    row("Joints", joints, NaN),
    row("Guide on wall", t.guide_wall_friction_torque, t.guide_wall_axial_drag),
  ]);
}

/** Powers (W) and their shares of all that is put in. */
export function powers(t: Transfer): { putIn: Row[]; taken: Row[] } {
  const total = PUT_IN.reduce((sum, { of }) => sum + (Number.isFinite(of(t)) ? of(t) : 0), 0);
  const rows = (list: Power[]) =>
    list
      .map(({ label, of }) => ({ label, power: of(t) }))
      .filter(({ power }) => Number.isFinite(power) && power !== 0)
      .map(({ label, power }) => ({
        label,
        values: [`${number(power, Math.abs(power) < 10 ? 1 : 0)} W`, total > 0 ? percent(power / total) : ""],
      }));
  return { putIn: rows(PUT_IN), taken: rows(TAKEN) };
}

/** Hook load, rate of penetration, depth of cut, and whether the top drive is at its limit. */
export function facts(t: Transfer, system: System): Row[] {
  const row = (label: string, value: number, kind: Kind, per = ""): Row => ({
    label,
    values: [Number.isFinite(value) ? withUnit(value, kind, system) + per : ""],
  });
  return held([
    row("Hook load", t.hook_load, "weight"),
    // A tool that neither cuts nor advances has no rate to show.
    row(
      "Rate of penetration",
      t.rate_of_penetration || !Number.isNaN(t.depth_of_cut) ? t.rate_of_penetration : NaN,
      "advance",
    ),
    row("Depth of cut", t.depth_of_cut, "cut", " per turn"),
    // A drive that is never at its limit has nothing to show.
    {
      label: "Top drive at its limit",
      values: [t.drive_at_limit > 0 ? `${percent(t.drive_at_limit)} of the time` : ""],
    },
  ]);
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
  private rows: { row: HTMLElement; cells: HTMLElement[] }[] = [];

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
      const cells = Array.from({ length: this.columns }, () => h("td"));
      const label = h("th", { scope: "row" });
      const row = h("tr", {}, label, ...cells);
      this.body.append(row);
      this.rows.push({ row, cells: [label, ...cells] });
    }
    this.rows.forEach(({ row, cells }, index) => {
      const found = rows[index];
      show(row, found !== undefined);
      if (!found) return;
      [found.label, ...found.values].forEach((value, column) => {
        if (cells[column]) setText(cells[column], value);
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
      const { putIn, taken } = powers(transfer);
      this.places.set(heads, places(transfer, system));
      this.losses.set(heads, losses(transfer, system));
      this.facts.set([""], facts(transfer, system));
      this.putIn.set(["", "share"], putIn);
      this.taken.set(["", "share"], taken);
    }
    const since = store.isBag ? 0 : store.age("twin/status") / 1e3;
    const { status } = store;
    this.inputs.set(["model uses", "quality"], status && !past ? optionalInputs(status, since, system) : []);
  }
}
