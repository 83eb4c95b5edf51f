// The joints to inspect: the table of their lives, the most damaged first. Below it the joints that drill now, with their lives
// so far by the twin's own count.

import * as api from "../api";
import { h, setText, show } from "../dom";
import type { Ageing } from "../messages";
import { counted, number } from "../units";
import type { Context, View } from "../view";
import { printable } from "../words";

/** Time between two requests (ms); a running node adds to the table once a minute. */
const ASK = 10_000;

/** A row of the table: joint, damage, where it drilled. */
export function row(joint: api.JointLife): string[] {
  const place = joint.place === null ? "" : `, place ${joint.place} from the bit`;
  return [
    joint.serial,
    `${joint.damage}, ${joint.part}`,
    `${number(joint.hours, 1)} h in ${counted(joint.runs, "run")}${place}`,
  ].map(printable);
}

/** What to do with a joint, with the hours until a crack is possible. */
export function advice(joint: api.JointLife): string {
  const left =
    joint.hours_left !== null && joint.hours_left > 0
      ? ` At its mean rate a crack is possible after ${number(joint.hours_left, 1)} h more.`
      : "";
  return printable(`${joint.verdict}${left}`);
}

/** The sentence above the table. */
export function heading(life: api.Life): string {
  if (life.error !== null) return printable(`The table of lives cannot be read: ${life.error}`);
  const due = life.joints.filter((joint) => joint.level > 0).length;
  const inspect = due === 0 ? "None needs an inspection by fatigue" : `${due} to inspect`;
  const more = (life.count ?? 0) - life.joints.length;
  const rest = more > 0 ? `, ${more} more are less damaged` : "";
  return printable(
    `${counted(life.count ?? 0, "joint")} in ${counted(life.runs ?? 0, "run")}, class ${life.class} in ${life.environment}. ${inspect}${rest}. ` +
      "In brackets 90 % of the scatter; a damage of 1 is a life.",
  );
}

/** A damage with two digits, above a whole life with as many as it has, as `flexdrill life` writes it; a dash for none. */
export function damage(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  if (value < 1e-4) return "below 0.0001";
  return number(value, value < 1 ? 1 - Math.floor(Math.log10(value)) : value < 10 ? 1 : 0);
}

/** A joint that drills now. */
export interface LivingJoint {
  serial: string;
  /** Upper end of the band of its more damaged part; -1 where it has none. */
  worst: number;
  /** Place from the bit; damages of stop and of the link below with their bands; what of both was lived before this run. */
  cells: string[];
}

/** The joints that drill now, the most damaged first; none where the twin knows no lives. */
export function living(ageing: Ageing | null): LivingJoint[] {
  const serials = ageing?.joint_serial_number ?? [];
  if (!ageing) return [];
  const joints = serials.map((serial, at) => {
    const of = (list: Float64Array | undefined) => list?.[at] ?? NaN;
    const band = (median: number, low: number, high: number) =>
      Number.isFinite(median) ? `${damage(median)} (${damage(low)} to ${damage(high)})` : "–";
    const [stop, link] = [of(ageing.stop_life_damage_high), of(ageing.link_life_damage_high)];
    return {
      serial: printable(serial),
      worst: Math.max(-1, ...[stop, link].filter(Number.isFinite)),
      cells: [
        `${serials.length - at}`,
        band(of(ageing.stop_life_damage), of(ageing.stop_life_damage_low), stop),
        band(of(ageing.link_life_damage), of(ageing.link_life_damage_low), link),
        `${damage(of(ageing.stop_life_damage_before))} and ${damage(of(ageing.link_life_damage_before))}`,
      ],
    };
  });
  // Equal ones keep the order of the tool.
  return joints.sort((a, b) => b.worst - a.worst);
}

export class LifeView implements View {
  readonly element: HTMLElement;
  private readonly said = h("p", { id: "life-heading" });
  private readonly body = h("tbody", {});
  private readonly table: HTMLElement;
  private readonly unknown = h("p", { class: "hint" });
  private readonly file: HTMLElement;
  private readonly drilling = h("tbody", {});
  private readonly now = h("section", { "aria-label": "Joints that drill now" });
  private asked = -Infinity;
  private key = "";
  private drawn = "";

  constructor(private readonly context: Context) {
    const heads = ["joint", "damage", "drilled", "what to do"].map((text) => h("th", { scope: "col" }, text));
    this.table = h("table", { class: "transfer-table life" }, h("thead", {}, h("tr", {}, ...heads)), this.body);
    this.file = h("div", {}, h("h2", {}, "Joints to inspect"), this.said, this.table, this.unknown);
    const columns = ["joint", "place from the bit", "stop", "link below", "before this run"];
    this.now.append(
      h("h2", {}, "In the hole"),
      h("p", { class: "hint" }, "Damage over the whole life so far, in brackets 90 % of the scatter; 1 is a life."),
      h(
        "table",
        { class: "transfer-table life", id: "life-now" },
        h("thead", {}, h("tr", {}, ...columns.map((text) => h("th", { scope: "col" }, text)))),
        this.drilling,
      ),
    );
    this.element = h("section", { "aria-label": "Joint life" }, this.file, this.now);
    show(this.table, false);
  }

  /** Whether the server has a table. */
  private get hasTable(): boolean {
    return this.context.store.session?.life === true;
  }

  /** Whether the server has a table, or the twin knows the lives of its joints. */
  get offered(): boolean {
    return this.hasTable || (this.context.store.ageing?.joint_serial_number ?? []).length > 0;
  }

  draw(now: number): void {
    if (this.element.clientWidth === 0) return;
    show(this.file, this.hasTable);
    this.drawNow();
    if (!this.hasTable || now - this.asked < ASK) return;
    this.asked = now;
    void api.life().then((life) => {
      if (life !== null) this.fill(life);
      else setText(this.said, "The server does not answer.");
    });
  }

  /** Lists the joints that drill now; a row of dashes where the twin does not know their lives, or shows the past. */
  private drawNow(): void {
    const joints = living(this.context.store.ageingNow);
    const shown = joints.length > 0 ? joints : [{ serial: "–", cells: ["–", "–", "–", "–"] }];
    const key = JSON.stringify(shown);
    if (key === this.drawn) return;
    this.drawn = key;
    this.drilling.replaceChildren(
      ...shown.map(({ serial, cells }) =>
        h("tr", {}, h("th", { scope: "row" }, serial), ...cells.map((text) => h("td", {}, text))),
      ),
    );
  }

  private fill(life: api.Life): void {
    const key = JSON.stringify(life);
    if (key === this.key) return;
    this.key = key;
    setText(this.said, heading(life));
    show(this.table, life.joints.length > 0);
    setText(this.unknown, printable(life.unknown ?? ""));
    this.body.replaceChildren(
      ...life.joints.map((joint) => {
        const [serial, ...cells] = row(joint);
        const data = [...cells, advice(joint)].map((text) => h("td", {}, text));
        return h("tr", { "data-level": String(joint.level) }, h("th", { scope: "row" }, serial), ...data);
      }),
    );
  }
}
