// The joints to inspect: the table of their lives, the most damaged first.

import * as api from "../api";
import { h, setText, show } from "../dom";
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

export class LifeView implements View {
  readonly element: HTMLElement;
  private readonly said = h("p", { id: "life-heading" });
  private readonly body = h("tbody", {});
  private readonly table: HTMLElement;
  private readonly unknown = h("p", { class: "hint" });
  private asked = -Infinity;
  private key = "";

  constructor(private readonly context: Context) {
    const heads = ["joint", "damage", "drilled", "what to do"].map((text) => h("th", { scope: "col" }, text));
    this.table = h("table", { class: "transfer-table life" }, h("thead", {}, h("tr", {}, ...heads)), this.body);
    this.element = h(
      "section",
      { "aria-label": "Joint life" },
      h("h2", {}, "Joints to inspect"),
      this.said,
      this.table,
      this.unknown,
    );
    show(this.table, false);
  }

  /** Whether the server has a table. */
  get offered(): boolean {
    return this.context.store.session?.life === true;
  }

  draw(now: number): void {
    if (!this.offered || this.element.clientWidth === 0 || now - this.asked < ASK) return;
    this.asked = now;
    void api.life().then((life) => {
      if (life !== null) this.fill(life);
      else setText(this.said, "The server does not answer.");
    });
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
