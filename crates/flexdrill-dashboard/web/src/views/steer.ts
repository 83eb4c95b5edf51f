// Targets for the rig's inputs: with limits, a second confirmation, and a dead man's renewal every second.

import * as api from "../api";
import { h, setText, show } from "../dom";
import { TwinStatus } from "../messages";
import { bounds, convert, number, quantity, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";
import { publisher } from "../words";

/** The request is repeated this often (ms); the server stops three seconds after the last. */
const RENEW = 1000;
/** How long a request waits for its confirmation (ms). */
const CONFIRM = 8000;
/** An answer is of what was asked; later it would be read as one to something else (ms). */
const ANSWERED = 20_000;

export class Steer implements View {
  readonly element: HTMLElement;
  private readonly locked = h("p", { class: "hint", id: "steer-locked" });
  private readonly form: HTMLElement;
  private readonly speed = this.field("steer-rpm");
  private readonly weight = this.field("steer-wob");
  private readonly speedUnit = h("span");
  private readonly weightUnit = h("span");
  private readonly operator: HTMLInputElement;
  private readonly token: HTMLInputElement;
  private readonly ask = h("button", { type: "button", id: "steer-ask", onclick: () => this.confirmFirst() });
  private readonly release = h(
    "button",
    { type: "button", id: "steer-release", onclick: () => void this.end() },
    "Stop steering",
  );
  private readonly pause = h("button", { type: "button", id: "model-pause", onclick: () => void this.holdModel() });
  private readonly reset = h("button", { type: "button", id: "model-reset", onclick: () => void this.resetModel() });
  private readonly model = h("div", { class: "buttons" }, this.pause, this.reset);
  private resetting = 0;
  private answered = -Infinity;
  private readonly answer = h("p", { class: "answer", role: "status", id: "steer-answer" });
  private readonly standing = h("dl", { class: "facts-list", id: "steer-state" });
  private readonly pace = new Pace(250);
  private state: api.ControlState | null = null;
  private polled = -Infinity;
  private confirming = 0;
  /** What this page steers to, in the server's units; null while it does not. */
  private target: { operator: string; rotary_speed_rpm: number; weight_on_bit_kn: number } | null = null;
  private timer: ReturnType<typeof setInterval> | null = null;

  constructor(private readonly context: Context) {
    this.operator = h("input", {
      type: "text",
      id: "steer-operator",
      maxlength: "60",
      value: context.settings.operator,
    });
    this.token = h("input", {
      type: "password",
      id: "steer-token",
      autocomplete: "off",
      value: api.token(),
      onchange: () => api.setToken(this.token.value),
    });
    this.form = h(
      "div",
      { class: "control steer-form" },
      h("label", {}, "operator", this.operator),
      h("label", {}, "token", this.token),
      h("label", {}, this.speedUnit, this.speed),
      h("label", {}, this.weightUnit, this.weight),
      this.ask,
      this.release,
    );
    for (const input of [this.speed, this.weight]) {
      input.addEventListener("input", () => {
        this.confirming = 0;
        this.sayNothing();
      });
    }
    this.element = h(
      "section",
      { class: "steer", "aria-label": "Steer" },
      h(
        "p",
        { class: "hint" },
        "Sends set points of rotary speed and weight on bit to the twin, within its limits and slew rates.",
      ),
      this.locked,
      this.form,
      this.model,
      this.answer,
      h("h2", {}, "Source of the inputs"),
      this.standing,
    );
  }

  private field(id: string): HTMLInputElement {
    return h("input", { type: "number", id, inputmode: "decimal", step: "any", required: true });
  }

  /** The form's values in the server's units, or why they cannot be sent. */
  private read(): { rpm: number; kilonewton: number } | string {
    const limits = this.context.store.session?.limits;
    if (!limits) return "The twin's limits are not known yet.";
    const { units } = this.context.settings;
    const factor = convert(1e3, "weight", units);
    const rpm = this.speed.valueAsNumber;
    const kilonewton = this.weight.valueAsNumber / factor;
    if (Number.isNaN(rpm) || Number.isNaN(kilonewton)) return "Enter a number for both set points.";
    const speed = limits.rotary_speed_rpm;
    const weight = limits.weight_on_bit_kn;
    if (rpm < speed.min || rpm > speed.max) return `Rotary speed must be ${bounds(speed, "speed", units)}.`;
    if (kilonewton < weight.min || kilonewton > weight.max) {
      return `Weight on bit must be ${bounds(weight, "weight", units)}.`;
    }
    if (this.operator.value.trim() === "") return "Enter your name: all clients see who steers.";
    return { rpm, kilonewton };
  }

  private confirmFirst(): void {
    this.sayNothing();
    const wanted = this.read();
    if (typeof wanted === "string") return this.say(false, wanted);
    if (performance.now() > this.confirming) {
      this.confirming = performance.now() + CONFIRM;
      return;
    }
    this.confirming = 0;
    void this.begin(wanted.rpm, wanted.kilonewton);
  }

  private async begin(rpm: number, kilonewton: number): Promise<void> {
    api.setToken(this.token.value);
    const operator = this.operator.value.trim();
    this.context.change({ operator });
    const target = { operator, rotary_speed_rpm: rpm, weight_on_bit_kn: kilonewton };
    const { ok, message } = await api.request("steer", target);
    const weight = withUnit(1e3 * kilonewton, "weight", this.context.settings.units);
    this.say(ok, ok ? `towards ${number(rpm, 1)} r/min and ${weight}` : message || "refused");
    if (!ok) return;
    this.target = target;
    this.polled = -Infinity;
    this.timer ??= setInterval(() => void this.renew(), RENEW);
  }

  private async renew(): Promise<void> {
    if (!this.target) return;
    const { ok, message } = await api.request("steer", this.target);
    // While the server does not answer, the page continues to ask: the server keeps the dead man's time.
    if (!ok && this.target && message !== "the server does not answer") {
      this.stop();
      this.say(false, `Steering ended: ${message}`);
    }
  }

  private async end(): Promise<void> {
    const operator = this.target?.operator ?? this.operator.value.trim();
    this.stop();
    api.setToken(this.token.value);
    const { ok, message } = await api.request("release", { operator });
    this.say(ok, message || (ok ? "released" : "refused"));
    this.polled = -Infinity;
  }

  /** Asks for something of the model itself, in the operator's name. */
  private async askModel(what: "pause" | "reset", body: object): Promise<void> {
    const operator = this.operator.value.trim();
    if (operator === "") return this.say(false, "Enter your name.");
    api.setToken(this.token.value);
    this.context.change({ operator });
    const { ok, message } = await api.request(what, { operator, ...body });
    this.say(ok, message || (ok ? "done" : "refused"));
  }

  private async holdModel(): Promise<void> {
    this.sayNothing();
    await this.askModel("pause", { paused: !this.paused });
  }

  private async resetModel(): Promise<void> {
    this.sayNothing();
    if (performance.now() > this.resetting) {
      this.resetting = performance.now() + CONFIRM;
      return;
    }
    this.resetting = 0;
    await this.askModel("reset", {});
  }

  private get paused(): boolean {
    return this.context.store.status?.state === TwinStatus.PAUSED;
  }

  private stop(): void {
    this.target = null;
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
  }

  private say(ok: boolean, message: string): void {
    this.answer.dataset.ok = String(ok);
    setText(this.answer, `${ok ? "✓" : "✕"} ${publisher(message)}`);
    this.answered = performance.now();
  }

  /** A new request begins: the answer to the last one is not its. */
  private sayNothing(): void {
    setText(this.answer, "");
  }

  /** Whether an operator steers from this server. */
  get driving(): api.ControlState | null {
    return this.state?.driving ? this.state : null;
  }

  draw(now: number): void {
    const { context } = this;
    const { store, settings } = context;
    if (!store.isBag && store.session?.control && now - this.polled > 1000) {
      this.polled = now;
      void api.control().then((state) => (this.state = state));
    }
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    if (now - this.answered > ANSWERED) this.sayNothing();
    // Nothing is asked of a twin that does not answer, or by who sees old values.
    const allowed = store.session?.control === true && !store.isBag && !store.silent;
    for (const button of [this.ask, this.pause, this.reset]) button.disabled = !store.isLive;
    show(this.locked, !allowed);
    show(this.form, allowed);
    show(this.model, allowed);
    setText(this.pause, this.paused ? "Resume the model" : "Pause the model");
    const resetting = performance.now() < this.resetting;
    this.reset.classList.toggle("confirm", resetting);
    setText(this.reset, resetting ? "Confirm: reset to the start" : "Reset the model…");
    setText(
      this.locked,
      store.isBag
        ? "A recording cannot be steered."
        : store.session?.control
          ? "The twin does not answer: nothing can be steered."
          : "Steering is disabled. To enable it, start the server with --allow-control and open the address it prints.",
    );
    const limits = store.session?.limits;
    const unit = quantity("weight", settings.units).unit;
    if (limits) {
      const factor = convert(1e3, "weight", settings.units);
      const { rotary_speed_rpm: speed, weight_on_bit_kn: weight } = limits;
      setText(
        this.speedUnit,
        `rotary speed, ${bounds(speed, "speed", settings.units)}, ${number(speed.slew_per_s, 0)} per s`,
      );
      setText(
        this.weightUnit,
        `weight on bit, ${bounds(weight, "weight", settings.units)}, ` +
          `${number(weight.slew_per_s * factor, 1)} per s`,
      );
    }
    const confirming = performance.now() < this.confirming;
    this.ask.classList.toggle("confirm", confirming);
    setText(
      this.ask,
      confirming
        ? `Confirm: ${this.speed.value} r/min, ${this.weight.value} ${unit}`
        : this.target
          ? "Change the set points…"
          : "Start steering…",
    );
    show(this.release, this.state?.driving === true || this.target !== null);
    this.fill();
  }

  private fill(): void {
    const { store, settings } = this.context;
    const state = this.state;
    const unit = quantity("weight", settings.units).unit;
    const factor = convert(1e3, "weight", settings.units);
    const pair = (rpm: number | null, weight: number | null) =>
      `${number(rpm ?? NaN, 1)} r/min, ${number((weight ?? NaN) * factor, 1)} ${unit}`;
    const drivers = [...new Set(store.status?.input_driver ?? [])].filter((name) => name !== "");
    const rows: [string, string][] = [["Publisher", drivers.map(publisher).join("; ") || "none"]];
    if (state) {
      rows.push(["This server", state.driving ? `steering, operator ${state.by ?? "?"}` : "not steering"]);
      if (state.driving) {
        rows.push(["Set points", pair(state.target_rpm, state.target_wob_kn)]);
        rows.push(["Sent", pair(state.sent_rpm, state.sent_wob_kn)]);
      }
      rows.push(["Applied", pair(state.applied_rpm, state.applied_wob_kn)]);
      if (state.other_driver) rows.push(["Conflicting publisher", publisher(state.other_driver)]);
      if (state.ended) rows.push(["Steering ended", publisher(state.ended)]);
    }
    const key = JSON.stringify(rows);
    if (this.standing.dataset.key === key) return;
    this.standing.dataset.key = key;
    this.standing.replaceChildren(...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
  }
}
