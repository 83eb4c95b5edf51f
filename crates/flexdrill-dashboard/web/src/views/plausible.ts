// Plausible tools: how many there are and what they are worth, and in how many each alarm stands.

import { isActive, isMet } from "../alarms";
import { h, setText, show } from "../dom";
import type { Alarm, AlarmChance, Bands } from "../messages";
import { stamp } from "../store/topics";
import { counted, lapse, number } from "../units";
import { type Context, Pace, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, word } from "../words";
import { alarms, type Expected } from "./forecast";

/** Alarms of the tool's motion. Plausible tools have no others, whose absence therefore says nothing. */
const JUDGED: readonly string[] = [
  "backward_whirl",
  "forward_whirl",
  "shock",
  "stick_slip",
  "joint_load",
  "chaotic_whirl",
  "weight_transfer",
  "torque_transfer",
  "guide_preload",
  "pressure_folding",
  "bit_stuck",
  "model_quality",
];

/** A chance in whole per cent, which are never rounded to nothing or to all. */
function share(of: number): string {
  const value = 100 * of;
  if (value > 0 && value < 1) return "< 1 %";
  if (value > 99) return "> 99 %";
  return `${number(value, 0)} %`;
}

const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
const tools = (seen: number | string, of: number) => `in ${seen} of ${counted(of, "plausible tool")}`;

/** How many plausible tools there are, and what they are worth; empty where there are none. */
export function worth(bands: Bands): string {
  if (bands.members === 0) return "";
  const what = bands.failed === 1 ? "it does" : "they do";
  const failed = bands.failed > 0 ? `; ${bands.failed} could not be computed, so what ${what} is unknown` : "";
  return `${counted(bands.members, "plausible tool")}, worth ${number(bands.effective, 1)} alike${failed}.`;
}

/** An alarm in words, at the highest priority that a plausible tool has; a lower one where more tools have it. */
export function chanceWords(of: Expected): string {
  // Where all have it, a chance would say more than so few tools can.
  const chance = of.seen < of.members && Number.isFinite(of.probability) ? ` (${share(of.probability)})` : "";
  const lower = of.any ? `; ${word(PRIORITY, of.any.priority)} or higher: ${tools(of.any.seen, of.any.members)}` : "";
  return `${capital(of.name)}, ${word(PRIORITY, of.priority)}: ${tools(of.seen, of.members)}${chance}${lower}`;
}

/** The chance that any alarm stands, with its interval; empty where no plausible tool was computed. */
export function anyAlarm({ any_alarm, any_alarm_lower, any_alarm_upper }: Bands): string {
  if (!Number.isFinite(any_alarm)) return "";
  if (any_alarm <= 0) return `No alarm stands in a plausible tool (chance at most ${share(any_alarm_upper)}).`;
  if (any_alarm >= 1 - 1e-9) {
    return `An alarm stands in every plausible tool (chance at least ${share(any_alarm_lower)}).`;
  }
  const interval =
    any_alarm_upper >= 1
      ? `at least ${share(any_alarm_lower)}`
      : `${share(any_alarm_lower)} to ${share(any_alarm_upper)}`;
  return `Any alarm: chance ${share(any_alarm)} (${interval}).`;
}

/** Why there are no bands, as a sentence; empty where there are. */
export function whyNone({ no_bands }: Bands): string {
  return no_bands === "" ? "" : `No bands: ${no_bands.replace(/\.$/, "")}.`;
}

/** Which sensors of the rig the plausible tools are not weighed by, and why; empty where all are believed. */
export function notBelieved({ distrusted, distrusted_why }: Bands): string {
  if (distrusted.length === 0) return "";
  const each = distrusted.map((name, index) => {
    const why = distrusted_why[index] ?? "";
    return why === "" ? name.replaceAll("_", " ") : `${name.replaceAll("_", " ")} (${why})`;
  });
  return `Not believed: ${each.join("; ")}.`;
}

/** In how many plausible tools an alarm that stands in the twin stands too; empty where that is not known. */
export function standsIn(alarm: Alarm, bands: Bands | null): string {
  if (!bands || bands.no_bands !== "" || !isActive(alarm) || !isMet(alarm)) return "";
  const known = bands.alarms.filter((of) => of.id === alarm.id && of.seen > 0);
  const computed = bands.members - bands.failed;
  if (known.length === 0) {
    return computed > 0 && JUDGED.includes(alarm.id) ? `stands ${tools("none", computed)}` : "";
  }
  const most = known.reduce((a, b) => (b.seen > a.seen ? b : a));
  // Of this priority or higher; without an entry no tool has it so high.
  const asHigh = known.find((of) => of.priority === alarm.priority)?.seen ?? 0;
  const differs = alarm.priority > 0 && asHigh < most.seen;
  const priority = differs ? `, as ${word(PRIORITY, alarm.priority)} in ${asHigh === 0 ? "none" : asHigh}` : "";
  return `stands ${tools(most.seen, most.members)}${priority}`;
}

/** A row per alarm that stands in a plausible tool. */
function chanceRows(all: readonly AlarmChance[]): HTMLElement[] {
  return alarms(all).map((of) =>
    h(
      "li",
      { "data-level": String(of.priority) },
      h("span", { class: "shape", "aria-hidden": "true" }, PRIORITY_SHAPE[of.priority] ?? ""),
      ` ${chanceWords(of)}`,
    ),
  );
}

export class PlausibleView implements View {
  readonly element: HTMLElement;
  private readonly state = h("p", { class: "hint", id: "plausible-state" });
  private readonly worth = h("p", { id: "plausible-worth" });
  private readonly none = h("p", { id: "plausible-none" });
  private readonly distrusted = h("p", { id: "plausible-distrusted" });
  private readonly list = h("ul", { class: "chances", id: "plausible-alarms" });
  private readonly any = h("p", { id: "plausible-any" });
  private readonly body = h("div", {}, this.worth, this.none, this.distrusted, this.list, this.any);
  private readonly pace = new Pace(500);
  private drawn: Bands | null = null;

  constructor(private readonly context: Context) {
    const title = h("h2", {}, "Plausible tools");
    this.element = h(
      "section",
      { class: "plausible", "aria-label": "Plausible tools", hidden: true },
      title,
      this.state,
      this.body,
    );
  }

  draw(now: number): void {
    const { context } = this;
    if (!this.pace.due(now, context.revision)) return;
    const { store } = context;
    const { newest } = store.bands;
    // A twin without plausible tools has no such section.
    show(this.element, newest !== null);
    if (!newest || this.element.clientWidth === 0) return;
    const fresh = store.plausible;
    show(this.body, fresh !== null);
    show(this.state, fresh === null);
    if (!fresh) return setText(this.state, this.why(newest));
    if (fresh === this.drawn) return;
    this.drawn = fresh;
    this.fill(fresh);
  }

  /** Why the newest message is not shown. */
  private why(newest: Bands): string {
    const { store } = this.context;
    if (store.cursor !== null) return "Plausible tools are of the present.";
    if (store.silent) return "Withdrawn: the twin is silent.";
    const age = store.now - stamp(newest.header);
    return age < 0 ? "Withdrawn: they are of a later time." : `Withdrawn: the newest are ${lapse(age)} old.`;
  }

  private fill(bands: Bands): void {
    const why = whyNone(bands);
    const lines: [HTMLElement, string][] = [
      [this.worth, worth(bands)],
      [this.none, why],
      [this.distrusted, notBelieved(bands)],
      [this.any, why === "" ? anyAlarm(bands) : ""],
    ];
    for (const [element, text] of lines) {
      setText(element, text);
      show(element, text !== "");
    }
    this.list.replaceChildren(...(why === "" ? chanceRows(bands.alarms) : []));
  }
}
