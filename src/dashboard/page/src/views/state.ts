// The state of the tool in one word and one line, on top of everything.

import { h, setAttribute, setText } from "../dom";
import { Alarm, TwinStatus } from "../messages";
import type { Store } from "../store/store";
import { clock, digits, lapse, number, type System, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { PRIORITY_SHAPE, QUALITY, word } from "../words";

interface State {
  /** 0 nothing to do, 1 to 3 as priorities, 4 not known. */
  level: number;
  word: string;
  sentence: string;
}

const CALLS: Record<number, string> = { 1: "WATCH", 2: "ACT SOON", 3: "ACT NOW" };

/** The state now: what keeps the page from knowing first, then the twin, then alarms, then how far to trust it. */
export function stateNow(store: Store, system: System): State {
  if (!store.connected) {
    return {
      level: 4,
      word: "NO SERVER",
      sentence: "The page has lost its server and tries again. All values are old.",
    };
  }
  const status = store.status;
  if (!status) return { level: 4, word: "NO DATA", sentence: "Nothing heard of a twin yet." };
  if (store.silent) {
    const age = lapse(store.age("twin/status") / 1e3);
    return { level: 4, word: "TWIN SILENT", sentence: `Last heard of the twin ${age} ago. All values are old.` };
  }
  if (status.state === TwinStatus.FAILED) {
    return {
      level: 3,
      word: "MODEL FAILED",
      sentence: `The model stands still: ${status.last_rejection_cause}. Reset it.`,
    };
  }
  if (status.state === TwinStatus.STARTING) {
    return {
      level: 4,
      word: "STARTING",
      sentence: "The tool is being brought to rest under gravity and weight on bit.",
    };
  }
  if (status.state === TwinStatus.PAUSED) {
    return { level: 1, word: "PAUSED", sentence: "The model is paused by request; values stand still." };
  }
  const alarm = store.alarms?.alarms.find((one) => one.priority > 0 && one.state >= 1 && one.state <= 2);
  if (alarm && store.alarms) {
    const more = store.alarms.alarms.filter((one) => one.state >= 1 && one.state <= 2).length - 1;
    const place = alarmPlace(alarm, system);
    const others = more > 0 ? ` (+${more} more)` : "";
    const name = alarm.name.charAt(0).toUpperCase() + alarm.name.slice(1);
    return {
      level: alarm.priority,
      word: CALLS[alarm.priority] ?? "WATCH",
      sentence: `${name}${place ? `, ${place}` : ""}: ${alarm.what_to_do || alarm.evidence}${others}`,
    };
  }
  if (status.model_quality !== TwinStatus.QUALITY_GOOD) {
    const quality = word(QUALITY, status.model_quality).toLowerCase();
    return { level: 1, word: "DOUBTFUL", sentence: `Model quality is ${quality}: ${status.model_quality_cause}` };
  }
  const unacknowledged = store.alarms?.unacknowledged ?? 0;
  const speed = status.input_applied[0] ?? NaN;
  const weight = status.input_applied[1] ?? NaN;
  const doing =
    Math.abs(speed) < 0.1
      ? "The drive stands"
      : `Turning with ${digits(speed, "speed", system)} r/min, ${withUnit(weight, "weight", system)} on the bit`;
  const returned = unacknowledged > 0 ? `; ${unacknowledged} returned alarm(s) to acknowledge` : "; nothing to do";
  return { level: 0, word: "NORMAL", sentence: doing + returned + "." };
}

/** Where an alarm is worst, in words; empty where it has no place. */
export function alarmPlace(alarm: Alarm, system: System): string {
  if (alarm.body === Alarm.NOWHERE || !Number.isFinite(alarm.measured_depth)) return "";
  const body = alarm.body === Alarm.GUIDE ? "guide" : "pipe";
  const inclination = number((alarm.inclination * 180) / Math.PI, 0);
  return `${body} at ${withUnit(alarm.measured_depth, "depth", system)} (${inclination}°)`;
}

export class StateLine implements View {
  readonly element: HTMLElement;
  private readonly shape = h("span", { class: "shape", "aria-hidden": "true" });
  private readonly word = h("strong", { id: "state-word", role: "status" });
  private readonly sentence = h("span", { class: "sentence", id: "state-sentence" });
  private readonly line: HTMLElement;
  private readonly clock = h("b", { id: "clock" });
  private readonly age = h("b", { id: "age" });
  private readonly quality = h("b", { id: "quality" });
  private readonly pace = new Pace(200);

  constructor(private readonly context: Context) {
    this.line = h("div", { class: "state" }, this.shape, this.word, this.sentence);
    const fact = (label: string, value: HTMLElement) => h("div", { class: "fact" }, h("span", {}, label), value);
    const units = h("button", { type: "button", id: "units", onclick: () => this.switchUnits() });
    const theme = h("button", { type: "button", id: "theme", onclick: () => this.switchTheme() });
    const label = () => {
      const field = context.settings.units === "field";
      setText(units, field ? "field units" : "SI units");
      setAttribute(units, "aria-label", `Units: ${field ? "field" : "SI"}; press to switch`);
      setText(theme, context.theme);
      setAttribute(theme, "aria-label", `Colours: ${context.theme}; press to switch`);
    };
    label();
    context.onChange(label);
    this.element = h(
      "header",
      { class: "top" },
      this.line,
      h(
        "div",
        { class: "facts" },
        fact("rig's clock", this.clock),
        fact("age of data", this.age),
        fact("model quality", this.quality),
        units,
        theme,
      ),
    );
  }

  private switchUnits(): void {
    this.context.change({ units: this.context.settings.units === "si" ? "field" : "si" });
  }

  private switchTheme(): void {
    this.context.change({ theme: this.context.theme === "day" ? "night" : "day" });
  }

  draw(now: number): void {
    if (!this.pace.due(now, this.context.revision)) return;
    const { store, settings } = this.context;
    const state = stateNow(store, settings.units);
    this.line.dataset.level = String(state.level);
    setText(this.shape, state.level === 4 ? "✕" : PRIORITY_SHAPE[state.level] || "✓");
    setText(this.word, state.word);
    setText(this.sentence, state.sentence);
    setText(this.clock, clock(store.now));
    const age = store.isBag ? NaN : store.age("twin/status") / 1e3;
    setText(this.age, store.isBag ? "recorded" : lapse(age));
    setText(this.quality, store.status ? word(QUALITY, store.status.model_quality) : "–");
    document.body.classList.toggle("silent", store.silent && store.cursor === null);
    document.body.classList.toggle("past", store.cursor !== null);
    document.title = `${state.level > 0 ? `${PRIORITY_SHAPE[state.level] || "✕"} ` : ""}${state.word} – flexdrill`;
  }
}
