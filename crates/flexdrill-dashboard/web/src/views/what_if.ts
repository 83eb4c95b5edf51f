// What if: speeds and weights that the twin tries in runs ahead of time, and what came of them.

import * as api from "../api";
import { h, setText, show } from "../dom";
import { bounds, convert, counted, number, quantity, type System } from "../units";
import { type Context, Pace, type View } from "../view";
import { alarmRows } from "./forecast";
import { percent } from "./transfer";

/** How often an answer that is coming is asked for, and one that may come from another page (ms). */
const SOON = 1000;
const LATER = 5000;
/** Most candidates of a question here: the node takes 16, a table of more is not read. */
const MOST = 8;
/** Bounds of the form; the node's own are wider. */
const HORIZON = [10, 120] as const;
const MEMBERS = [1, 50] as const;

/** A candidate's chance of any alarm as words. */
export function verdict(answer: api.WhatIfAnswer): string {
  const ended = answer.members - answer.failed;
  const unknown = answer.failed > 0 ? `; ${answer.failed} unknown` : "";
  if (answer.any_alarm === null || ended <= 0) {
    return answer.failure === "" ? "no run has ended yet" : `unknown: ${answer.failure}`;
  }
  const seen = Math.round(answer.any_alarm * ended);
  const interval = `${percent(answer.any_alarm_lower ?? 0)} to ${percent(answer.any_alarm_upper ?? 1)}`;
  const what = seen === 0 ? "no alarm in" : `alarms in ${seen} of`;
  const tools = answer.tools ?? 0;
  const runs =
    tools === 0
      ? counted(ended, "run")
      : tools === answer.members
        ? counted(ended, "plausible tool")
        : `${counted(ended, "run")} of ${counted(tools, "plausible tool")}`;
  return `${what} ${runs} (${interval})${unknown}`;
}

/** A row of another friction: its words, and whether a run saw an alarm, or failed, so that it is not known to be calm. */
export interface FrictionRow {
  words: string;
  alarm: boolean;
}

/** What would come with another friction, a row for each factor; none before the result. */
export function frictionRows(answer: api.WhatIfAnswer): FrictionRow[] {
  return (answer.friction_factors ?? []).map((factor, at) => {
    const members = answer.friction_members?.[at] ?? 0;
    const failed = answer.friction_failed?.[at] ?? 0;
    const seen = answer.friction_any_alarm?.[at] ?? 0;
    const ended = members - failed;
    const tenths = Math.round(10 * factor);
    const change =
      tenths === 8 ? "a fifth lower" : tenths === 12 ? "a fifth higher" : `${number(factor, 2)} of the present`;
    const found =
      ended <= 0
        ? members === 0
          ? "not run"
          : `unknown: ${counted(failed, "run")} failed`
        : seen === 0
          ? `no alarm in ${counted(ended, "run")}`
          : `alarms in ${seen} of ${counted(ended, "run")}`;
    const unknown = ended > 0 && failed > 0 ? `; ${failed} unknown` : "";
    return { words: `If friction is ${change}: ${found}${unknown}`, alarm: seen > 0 || failed > 0 };
  });
}

/** A number of the answer, which JSON has as null where it is none. */
const known = (value: number | null) => value ?? NaN;

/** The hole under a candidate's weight in words. */
export function holeOf(answer: api.WhatIfAnswer, units: System): string {
  if (!answer.hole_known) return answer.hole_because === "" ? "" : `Hole not known: ${answer.hole_because}.`;
  const length = (value: number | null) => number(convert(known(value), "depth", units), 2);
  const { unit } = quantity("depth", units);
  // JSON has null for the radius of a straight hole too.
  const radius =
    answer.hole_radius === null
      ? "straight over the next metre"
      : `radius ${length(answer.hole_radius)} ${unit} over the next metre`;
  const [low, high] = [answer.hole_radius_low, answer.hole_radius_high].map((end) =>
    end === null ? "straight" : length(end),
  );
  const plan =
    answer.hole_plan_distance === null
      ? ""
      : `; ${length(answer.hole_plan_distance)} ${unit} from the plan after ${length(answer.hole_plan_ahead)} ${unit}`;
  return `Hole: ${radius} (${low} to ${high})${plan}.`;
}

export class WhatIfView implements View {
  readonly element: HTMLElement;
  /** The newest question and its answers, for the map too. */
  asked: api.WhatIf | null = null;
  private readonly locked = h("p", { class: "hint", id: "what-if-locked" });
  private readonly form: HTMLElement;
  private readonly list = h("div", { class: "candidates" });
  private readonly operator: HTMLInputElement;
  private readonly token: HTMLInputElement;
  private readonly horizon: HTMLInputElement;
  private readonly members: HTMLInputElement;
  private readonly add: HTMLButtonElement;
  private readonly go: HTMLButtonElement;
  private readonly stop: HTMLButtonElement;
  private readonly answer = h("p", { class: "answer", role: "status", id: "what-if-answer" });
  private readonly progress = h("progress", { max: "1", id: "what-if-progress", "aria-label": "Runs that have ended" });
  private readonly result = h("div", { class: "results", id: "what-if-results" });
  private readonly pace = new Pace(250);
  private polled = -Infinity;
  private drawn = "";
  private filled = false;

  constructor(private readonly context: Context) {
    this.operator = h("input", {
      type: "text",
      id: "what-if-operator",
      maxlength: "60",
      value: context.settings.operator,
    });
    this.token = h("input", { type: "password", id: "what-if-token", autocomplete: "off", value: api.token() });
    this.horizon = this.field("what-if-horizon", "30");
    this.members = this.field("what-if-members", "10");
    this.add = h(
      "button",
      { type: "button", id: "what-if-add", onclick: () => this.addCandidate() },
      "Add a candidate",
    );
    this.go = h("button", { type: "button", id: "what-if-ask", onclick: () => void this.ask() }, "Look ahead");
    this.stop = h("button", { type: "button", id: "what-if-cancel", onclick: () => void this.cancel() }, "Cancel");
    this.form = h(
      "div",
      {},
      this.list,
      h("div", { class: "buttons" }, this.add),
      h(
        "div",
        { class: "control" },
        h("label", {}, `judged over, ${HORIZON[0]} to ${HORIZON[1]} s`, this.horizon),
        h("label", {}, `runs each, at most, ${MEMBERS[0]} to ${MEMBERS[1]}`, this.members),
        h("label", {}, "operator", this.operator),
        h("label", {}, "token", this.token),
        this.go,
        this.stop,
      ),
    );
    this.element = h(
      "section",
      { class: "what-if", "aria-label": "What if" },
      h("h2", {}, "What if"),
      h(
        "p",
        { class: "hint" },
        "The twin tries speeds and weights in runs from its present state. Nothing that runs is changed.",
      ),
      this.locked,
      this.form,
      this.answer,
      this.progress,
      this.result,
    );
    this.addCandidate();
  }

  private field(id: string, value = ""): HTMLInputElement {
    return h("input", { type: "number", id, inputmode: "decimal", step: "any", required: true, value });
  }

  private get factor(): number {
    return convert(1e3, "weight", this.context.settings.units);
  }

  private addCandidate(rpm = "", weight = ""): void {
    if (this.list.children.length >= MOST) return;
    const number = this.list.children.length + 1;
    const row = h(
      "div",
      { class: "candidate" },
      h("label", {}, h("span", { class: "speed-label" }, "r/min"), this.field(`what-if-rpm-${number}`, rpm)),
      h("label", {}, h("span", { class: "weight-label" }, "kN"), this.field(`what-if-wob-${number}`, weight)),
      h("button", { type: "button", "aria-label": "Remove this candidate", onclick: () => this.remove(row) }, "✕"),
    );
    this.list.append(row);
  }

  private remove(row: HTMLElement): void {
    if (this.list.children.length > 1) row.remove();
  }

  private get rows(): [HTMLInputElement, HTMLInputElement][] {
    return [...this.list.children].map((row) => {
      const [speed, weight] = row.querySelectorAll("input");
      return [speed, weight];
    });
  }

  /** Takes a point of the map: into an empty candidate, or as a further one. In r/min and kN. */
  fill(rpm: number, kilonewton: number): void {
    const weight = number(kilonewton * this.factor, 1);
    this.filled = true;
    const empty = this.rows.find(([speed, load]) => speed.value === "" && load.value === "");
    if (empty) [empty[0].value, empty[1].value] = [number(rpm, 0), weight];
    else this.addCandidate(number(rpm, 0), weight);
  }

  /** The question, or why it cannot be asked. */
  private read(): object | string {
    const limits = this.context.store.session?.limits;
    if (!limits) return "The twin's limits are not known yet.";
    const { rotary_speed_rpm: speed, weight_on_bit_kn: weight } = limits;
    const candidates = [];
    for (const [rpm, load] of this.rows) {
      if (rpm.value === "" && load.value === "" && this.rows.length > 1) continue;
      const point = { rotary_speed_rpm: rpm.valueAsNumber, weight_on_bit_kn: load.valueAsNumber / this.factor };
      if (Number.isNaN(point.rotary_speed_rpm) || Number.isNaN(point.weight_on_bit_kn)) {
        return "Enter speed and weight of each candidate.";
      }
      if (!(point.rotary_speed_rpm >= speed.min && point.rotary_speed_rpm <= speed.max)) {
        return `Rotary speed must be ${bounds(speed, "speed", this.context.settings.units)}.`;
      }
      if (!(point.weight_on_bit_kn >= weight.min && point.weight_on_bit_kn <= weight.max + 1e-9)) {
        return `Weight on bit must be ${bounds(weight, "weight", this.context.settings.units)}.`;
      }
      candidates.push({ ...point, weight_on_bit_kn: Math.min(point.weight_on_bit_kn, weight.max) });
    }
    const horizon = this.horizon.valueAsNumber;
    const members = this.members.valueAsNumber;
    if (!(horizon >= HORIZON[0] && horizon <= HORIZON[1])) {
      return `The time to be judged must be ${HORIZON[0]} to ${HORIZON[1]} s.`;
    }
    if (!(members >= MEMBERS[0] && members <= MEMBERS[1] && Number.isInteger(members))) {
      return `The runs must be a whole number from ${MEMBERS[0]} to ${MEMBERS[1]}.`;
    }
    const operator = this.operator.value.trim();
    if (operator === "") return "Enter your name: all clients see whose question it is.";
    return { operator, candidates, horizon, members };
  }

  private async ask(): Promise<void> {
    this.say(true, "");
    const question = this.read();
    if (typeof question === "string") return this.say(false, question);
    api.setToken(this.token.value);
    this.context.change({ operator: this.operator.value.trim() });
    const { ok, message } = await api.request("what_if", question);
    this.say(ok, ok ? "" : message || "refused");
    this.polled = -Infinity;
  }

  private async cancel(): Promise<void> {
    api.setToken(this.token.value);
    const operator = this.operator.value.trim();
    if (operator === "") return this.say(false, "Enter your name.");
    const { ok, message } = await api.request("cancel_what_if", { operator });
    this.say(ok, ok ? "" : message || "refused");
    this.polled = -Infinity;
  }

  private say(ok: boolean, message: string): void {
    this.answer.dataset.ok = String(ok);
    setText(this.answer, message === "" ? "" : `${ok ? "✓" : "✕"} ${message}`);
  }

  draw(now: number): void {
    const { context } = this;
    const { store, settings } = context;
    if (this.element.clientWidth === 0) return;
    if (!store.isBag && store.session?.control && now - this.polled > (this.asked?.running ? SOON : LATER)) {
      this.polled = now;
      void api.whatIf().then((asked) => {
        if (asked) this.asked = asked;
      });
    }
    if (!this.pace.due(now, context.revision)) return;
    const allowed = store.session?.control === true && !store.isBag && !store.silent;
    show(this.locked, !allowed);
    show(this.form, allowed);
    setText(
      this.locked,
      store.isBag
        ? "A recording cannot be asked."
        : store.session?.control
          ? "The twin does not answer."
          : "Questions need the token: a look-ahead takes computing time from advice and forecast. Start the server with " +
            "--allow-control and open the address it prints.",
    );
    const running = this.asked?.running === true;
    this.go.disabled = running || !store.isLive;
    show(this.stop, running);
    this.add.disabled = this.list.children.length >= MOST;
    const limits = store.session?.limits;
    if (limits) {
      const { rotary_speed_rpm: speed, weight_on_bit_kn: weight } = limits;
      for (const label of this.list.querySelectorAll<HTMLElement>(".speed-label")) {
        setText(label, `speed, ${bounds(speed, "speed", settings.units)}`);
      }
      for (const label of this.list.querySelectorAll<HTMLElement>(".weight-label")) {
        setText(label, `weight, ${bounds(weight, "weight", settings.units)}`);
      }
      this.begin();
    }
    this.show();
  }

  /** The form begins with what acts now. */
  private begin(): void {
    const { store } = this.context;
    const moment = this.filled ? null : store.moment();
    if (!moment || store.isBag) return;
    const rpm = convert(moment.layout.scalar(moment.row, "rotary_speed_applied"), "speed", "si");
    const kilonewton = convert(moment.layout.scalar(moment.row, "weight_on_bit_applied"), "weight", "si");
    if (Number.isFinite(rpm) && Number.isFinite(kilonewton) && rpm > 0) this.fill(rpm, kilonewton);
  }

  private show(): void {
    const { asked } = this;
    show(this.progress, asked?.running === true);
    if (!asked || asked.number === 0) return;
    const total = asked.done + asked.remaining;
    if (total > 0) this.progress.value = asked.done / total;
    else this.progress.removeAttribute("value");
    const { isLive, isBag } = this.context.store;
    const key = `${JSON.stringify(asked)} ${this.context.revision} ${isLive}`;
    if (key === this.drawn) return;
    this.drawn = key;
    const { unit } = quantity("weight", this.context.settings.units);
    const head = asked.running
      ? `Question of ${asked.by}, runs of ${asked.horizon} s: ${asked.done} ended, ${asked.remaining} may follow.`
      : asked.failed
        ? `Question of ${asked.by}: ${asked.message}`
        : `Question of ${asked.by}, judged over ${asked.horizon} s.`;
    this.result.replaceChildren(
      h("p", { class: "hint" }, head),
      isLive || isBag ? "" : h("p", { class: "not-live" }, "The page has no live data. The answers are of earlier."),
      ...asked.answers.map((answer) => {
        const { rotary_speed: rpm, weight_on_bit: kilonewton } = answer.candidate;
        const figures = answer.figures
          .map((figure) => this.figure(figure))
          .filter((text) => text !== "")
          .join(" · ");
        return h(
          "article",
          { class: "result", "data-alarm": String((answer.any_alarm ?? 0) > 0) },
          h("h3", {}, `${number(rpm, 0)} r/min, ${number(kilonewton * this.factor, 1)} ${unit}`),
          h("p", {}, verdict(answer)),
          h("ul", { class: "chances" }, ...alarmRows(answer.alarms.map((of) => ({ ...of, ...numbers(of) })))),
          h(
            "ul",
            { class: "friction", "aria-label": "With another friction" },
            ...frictionRows(answer).map(({ words, alarm }) => h("li", { "data-alarm": String(alarm) }, words)),
          ),
          h("p", { class: "hint" }, figures),
          h("p", { class: "hint" }, holeOf(answer, this.context.settings.units)),
        );
      }),
    );
  }

  /** Those of the figures that a driller asks for, as median and 90 % band. */
  private figure({ name, p5, p50, p95 }: api.FigureBand): string {
    const { units } = this.context.settings;
    const label = { pipe_guide_force: "pipe on guide", guide_wall_force: "guide on wall" }[name];
    if (p50 === null || (label === undefined && name !== "bit_speed_ripple")) return "";
    if (label === undefined) return `bit speed ± ${percent(p50)} (${percent(known(p5))} to ${percent(known(p95))})`;
    const { unit, digits } = quantity("force", units);
    const text = (value: number | null) => number(convert(known(value), "force", units), digits);
    return `${label} ${text(p50)} ${unit} (${text(p5)} to ${text(p95)})`;
  }
}

/** The numbers of a chance, NaN where JSON has null. */
function numbers(of: api.AlarmChance): { probability: number; lower: number; upper: number; time_to_first: number } {
  return {
    probability: known(of.probability),
    lower: known(of.lower),
    upper: known(of.upper),
    time_to_first: known(of.time_to_first),
  };
}
