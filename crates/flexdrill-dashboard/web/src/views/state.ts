// The state of the tool in one word and one line, at the top of the page.

import { alarmLocation, endedAt, engineersAction, headline, isMet, isOfSystem, standing, title } from "../alarms";
import { h, setAttribute, setText } from "../dom";
import { Alarm, TwinStatus } from "../messages";
import { SILENT, type Store } from "../store/store";
import { clock, counted, dateAndClock, digits, lapse, type System, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, QUALITY, word } from "../words";

export interface State {
  /** 0 for no action, 1 to 3 as priorities, 4 for an unknown state, 5 for a recording. */
  level: number;
  word: string;
  sentence: string;
}

const CALLS: Record<number, string> = { 1: "WATCH", 2: "ACT SOON", 3: "ACT NOW" };
const SHAPES: Record<number, string> = { 0: "✓", 4: "✕", 5: "▷" };

/** The present state: a lack of data comes first, then the twin, then alarms, then the quality of the model. */
export function stateNow(store: Store, system: System): State {
  return unknown(store) ?? recorded(store, system) ?? ofTwin(store, system);
}

/** Why the state of the rig is not known; null where it is. */
function unknown(store: Store): State | null {
  const say = (word: string, sentence: string): State => ({ level: 4, word, sentence });
  if (!store.connected) {
    return say("NO SERVER", "The connection to the server is lost; the page is reconnecting. All values are old.");
  }
  if (store.isBag) return null;
  if (store.unconfirmed > 0) {
    const since = lapse(store.unconfirmed / 1e3);
    return say("AGE UNKNOWN", `The server has not answered for ${since}: the age of the values is not known.`);
  }
  const age = store.twinAge;
  if (age === Infinity) return say("NO DATA", "No message has been received from a twin yet.");
  if (age > SILENT) {
    const at = Number.isNaN(store.lastHeard) ? "" : ` at ${clock(store.lastHeard)}`;
    return say("TWIN SILENT", `Last message of the twin${at}, ${lapse(age / 1e3)} ago. All values are old.`);
  }
  const { lag } = store;
  if (lag > 0) {
    const behind = lapse(Math.round(lag / 1e3));
    return say(
      `PAGE BEHIND ${behind.replace(".0", "")}`,
      "The values shown are that old; the twin is running. Browser or network are too slow for this page: close other " +
        "pages and programs, or use another computer.",
    );
  }
  if (!store.status) return say("NO DATA", "The twin is running; its first values have not arrived yet.");
  return null;
}

/** The state at the shown time of a recording, which never looks like that of the rig. */
function recorded(store: Store, system: System): State | null {
  if (!store.isBag) return null;
  const name = store.session?.bag?.name ?? "";
  const alarms = store.alarms?.alarms ?? [];
  const head = headline(alarms);
  const then = head
    ? `Alarm at that time, ${word(PRIORITY, head.level)}: ${named(head.alarm, system)}${more(head.others)}.`
    : store.alarms
      ? `No alarm at that time. ${ended(alarms, system)}`
      : "";
  return { level: 5, word: "RECORDING", sentence: `${name}, ${dateAndClock(store.now)}. Not the rig. ${then}` };
}

function named(alarm: Alarm, system: System): string {
  const location = alarmLocation(alarm, system);
  return `${title(alarm)}${location ? `, ${location}` : ""}`;
}

const more = (others: number): string => (others > 0 ? ` (+${others} more)` : "");

/** The alarms that are only held in case their condition returns, in a sentence; empty where there are none. */
function ended(alarms: readonly Alarm[], system: System): string {
  const held = standing(alarms).drilling.filter((alarm) => !isMet(alarm));
  if (held.length === 0) return "";
  const at = endedAt(held[0]);
  const when = Number.isNaN(at) ? "has ended" : `ended at ${clock(at)}`;
  return `${named(held[0], system)}, ${when}; the twin watches whether it returns${more(held.length - 1)}.`;
}

function ofTwin(store: Store, system: System): State {
  const { status } = store;
  if (!status) return { level: 4, word: "NO DATA", sentence: "" };
  if (status.state === TwinStatus.FAILED) {
    const sentence =
      "The model has stopped and its values are frozen. Rely on the rig's own instruments and call the engineer.";
    return { level: 3, word: "MODEL FAILED", sentence };
  }
  if (status.state === TwinStatus.STARTING) {
    const sentence = "The model is computing the tool at rest under gravity and weight on bit.";
    return { level: 4, word: "STARTING", sentence };
  }
  if (status.state === TwinStatus.PAUSED) {
    return { level: 1, word: "PAUSED", sentence: "The model is paused on request; its values do not change." };
  }
  const alarms = store.alarms?.alarms ?? [];
  const head = headline(alarms);
  if (head) {
    const sentence = `${named(head.alarm, system)}: ${head.text}${more(head.others)}`;
    return { level: head.level, word: CALLS[head.level] ?? "WATCH", sentence };
  }
  // A motion that has just ended calls for no action, but the line does not say NORMAL before the alarm has returned.
  const held = ended(alarms, system);
  if (held !== "") return { level: 1, word: "WATCH", sentence: `No alarm stands now. ${held}` };
  if (status.model_quality !== TwinStatus.QUALITY_GOOD) {
    const quality = word(QUALITY, status.model_quality).toLowerCase();
    // The cause names settings of the solver: it is for the engineer, next to the quality.
    const sentence = `Model quality is ${quality}: treat vibration levels and forces as approximate.`;
    return { level: 1, word: "DOUBTFUL", sentence };
  }
  return { level: 0, word: "NORMAL", sentence: doing(store, status, system) };
}

function doing(store: Store, status: TwinStatus, system: System): string {
  const returned = (store.alarms?.alarms ?? []).filter(
    (alarm) => alarm.state === Alarm.RETURNED_UNACKNOWLEDGED && !isOfSystem(alarm),
  ).length;
  const speed = status.input_applied[0] ?? NaN;
  const weight = status.input_applied[1] ?? NaN;
  const motion =
    Math.abs(speed) < 0.1
      ? "Drive at standstill"
      : `Rotating at ${digits(speed, "speed", system)} r/min, ${withUnit(weight, "weight", system)} on bit`;
  const alarms = `${counted(returned, "returned alarm")} to acknowledge`;
  return `${motion}; ${returned > 0 ? alarms : "no action required"}.`;
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
  private readonly system = h("p", { class: "system", id: "system-line", role: "status" });
  private readonly pace = new Pace(200);

  constructor(private readonly context: Context) {
    this.line = h("div", { class: "state" }, this.shape, this.word, this.sentence);
    const fact = (label: string, value: HTMLElement) => h("div", { class: "fact" }, h("span", {}, label), value);
    const units = h("button", { type: "button", id: "units", onclick: () => this.switchUnits() });
    const theme = h("button", { type: "button", id: "theme", onclick: () => this.switchTheme() });
    const wall = h("button", { type: "button", id: "wall", onclick: () => context.showWall(!context.wall) });
    const label = () => {
      const field = context.settings.units === "field";
      setText(units, field ? "field units" : "SI units");
      setAttribute(units, "aria-label", `Units: ${field ? "field" : "SI"}; press to switch`);
      setText(theme, context.theme);
      setAttribute(theme, "aria-label", `Colours: ${context.theme}; press to switch`);
      setText(wall, context.wall ? "all views" : "wall");
      setAttribute(wall, "aria-label", context.wall ? "Show all views" : "Large type, readable from two metres");
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
        fact("rig time", this.clock),
        fact("age of data", this.age),
        fact("model quality", this.quality),
        units,
        theme,
        wall,
      ),
      this.system,
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
    const shape = SHAPES[state.level] ?? PRIORITY_SHAPE[state.level];
    setText(this.shape, shape);
    setText(this.word, state.word);
    setText(this.sentence, state.sentence);
    setText(this.clock, clock(store.now));
    setText(this.age, store.isBag ? "recorded" : lapse(store.age("twin/status") / 1e3));
    setText(this.quality, store.status ? word(QUALITY, store.status.model_quality) : "–");
    setAttribute(this.quality, "title", store.status?.model_quality_cause ?? "");
    setText(this.system, systemLine(store));
    setAttribute(this.system, "title", this.system.textContent ?? "");
    const { classList } = document.body;
    // Colours that call for action are for the present state of the rig only.
    classList.toggle("silent", state.level === 4 && state.word !== "STARTING" && store.cursor === null);
    classList.toggle("recording", store.isBag);
    classList.toggle("past", store.cursor !== null);
    document.title = `${state.level > 0 ? `${shape} ` : ""}${state.word} – flexdrill`;
  }
}

/** The line for the person who runs the computer. It is always present, so that an alarm does not move the page. */
function systemLine(store: Store): string {
  if (store.silent || store.lag > 0 || store.unconfirmed > 0) return "System: not known";
  const { system } = standing(store.alarms?.alarms ?? []);
  if (system.length === 0) return "System: no alarm";
  const names = system.map((alarm) => `${PRIORITY_SHAPE[alarm.priority]} ${title(alarm)}`);
  // One line has room for the advice of one alarm; the alarms have it in full.
  return system.length === 1
    ? `System: ${names[0]}. ${systemAdvice(system[0])}`
    : `System: ${names.join(", ")}. The action of each is under Alarms, System.`;
}

const systemAdvice = (alarm: Alarm): string => engineersAction(alarm) || alarm.what_to_do || alarm.evidence;
