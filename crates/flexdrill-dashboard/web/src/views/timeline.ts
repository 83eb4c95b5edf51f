// The time line: the hour or the bag at a glance, dragged back through; the player of a bag.

import { fit, h, setAttribute, setText, show } from "../dom";
import { timeTicks } from "../ticks";
import { clock, dateAndClock, lapse, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";

const SPEEDS = ["0.25", "0.5", "1", "2", "5", "10"];
const WINDOWS: [string, string][] = [
  ["600", "10 min"],
  ["1800", "30 min"],
  ["3600", "1 h"],
];

export class TimeLine implements View {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly live = h("button", { type: "button", id: "live", onclick: () => this.context.store.lookAt(null) });
  private readonly play = h("button", { type: "button", id: "play", onclick: () => this.toggle() });
  private readonly before = h(
    "button",
    { type: "button", id: "incident-before", onclick: () => this.jump(-1) },
    "◂ incident",
  );
  private readonly after = h(
    "button",
    { type: "button", id: "incident-after", onclick: () => this.jump(1) },
    "incident ▸",
  );
  private readonly speed: HTMLSelectElement;
  private readonly time = h("output", { class: "shown-time", id: "shown-time" });
  private readonly incident = h("span", { class: "incident", role: "status" });
  private readonly legendSpeed = h("span", {}, h("i", { class: "swatch speed" }));
  private readonly legendText = h("span");
  private readonly pace = new Pace(100);
  private drawn = "";
  private dragging = false;

  constructor(private readonly context: Context) {
    this.canvas = h("canvas", {
      id: "timeline",
      tabindex: "0",
      role: "slider",
      "aria-label":
        "Time shown. Arrow keys step one second, with shift ten; page keys step one minute; Escape returns to live.",
    });
    this.speed = h(
      "select",
      { id: "speed", "aria-label": "Speed", onchange: () => this.sendPlay(this.playing) },
      ...SPEEDS.map((value) => h("option", { value, selected: value === "1" }, `×${value}`)),
    );
    const window_ = h(
      "select",
      {
        id: "window",
        "aria-label": "Length of strips and maps",
        onchange: () => this.context.change({ window: Number(window_.value) }),
      },
      ...WINDOWS.map(([value, text]) =>
        h("option", { value, selected: Number(value) === context.settings.window }, text),
      ),
    );
    this.element = h(
      "footer",
      { class: "time", "aria-label": "Time" },
      h("div", { class: "time-tools" }, this.live, this.play, this.speed, this.before, this.after, this.time, window_),
      h("div", { class: "time-line" }, this.legend(), this.canvas),
      this.incident,
    );
    this.listen();
  }

  /** What the bars and the marks of the time line mean. */
  private legend(): HTMLElement {
    const mark = (level: number, letter: string, text: string) =>
      h("span", {}, h("i", { class: "swatch", "data-level": String(level) }, letter), text);
    this.legendSpeed.append(this.legendText);
    return h(
      "p",
      { class: "time-legend" },
      this.legendSpeed,
      h("span", {}, h("i", { class: "swatch window" }), "time of strips and maps"),
      h("span", {}, "alarms raised:"),
      mark(3, "H", "high"),
      mark(2, "M", "medium"),
      mark(1, "L", "low"),
    );
  }

  private get playing(): boolean {
    return this.context.store.playback?.playing === true;
  }

  private toggle(): void {
    const { store } = this.context;
    // At its end a recording restarts; a player that was moved there has not "ended".
    const [, end] = store.span;
    const over = store.playback?.ended === true || (!this.playing && store.now > end - 0.5);
    const again = over ? BigInt(store.session?.bag?.start_ns ?? "0") : null;
    store.connection?.play(!this.playing, Number(this.speed.value), again);
  }

  private sendPlay(playing: boolean): void {
    this.context.store.connection?.play(playing, Number(this.speed.value), null);
  }

  private jump(by: number): void {
    const { store } = this.context;
    const times = this.incidents().map(({ time }) => time);
    const now = store.isBag ? store.now : store.shown;
    // A second of grace, or going back would stick to the one that has just been reached.
    const next = by > 0 ? times.find((time) => time > now + 0.5) : times.reverse().find((time) => time < now - 1.5);
    if (next !== undefined) store.lookAt(next);
  }

  /** Incidents of the bag, or what the alarms' journal has of the hour, in time. */
  private incidents(): { time: number; level: number; text: string }[] {
    const { store } = this.context;
    const bag = store.session?.bag;
    const found = bag
      ? bag.incidents.map((one) => ({
          time: Number(BigInt(one.time_ns)) / 1e9,
          level: one.severity,
          text: one.text || one.alarm,
        }))
      : store.journal
          .filter((event) => event.change === 0 || event.change === 1)
          .map((event) => ({ time: Number(BigInt(event.stamp_ns)) / 1e9, level: event.priority, text: event.name }));
    return found.sort((a, b) => a.time - b.time);
  }

  private at(event: PointerEvent): number {
    const [from, to] = this.context.store.span;
    const share = Math.min(Math.max(event.offsetX / this.canvas.clientWidth, 0), 1);
    return from + share * (to - from);
  }

  private listen(): void {
    const { canvas, context } = this;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.dragging = true;
      context.store.lookAt(this.at(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.dragging) context.store.lookAt(this.at(event));
    });
    for (const name of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(name, () => (this.dragging = false));
    }
    window.addEventListener("keydown", (event) => {
      const inField = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
      if (event.key === "Escape") return context.store.lookAt(null);
      if (inField) return;
      const { store } = context;
      if (event.key === "n") return this.jump(1);
      if (event.key === "p") return this.jump(-1);
      if (event.key === " " && store.isBag && !(event.target instanceof HTMLButtonElement)) {
        event.preventDefault();
        return this.toggle();
      }
      if (event.target !== canvas) return;
      const step = event.shiftKey ? 10 : 1;
      const steps: Record<string, number> = { ArrowLeft: -step, ArrowRight: step, PageUp: -60, PageDown: 60 };
      const [first, last] = store.span;
      const shown = store.isBag ? store.now : store.shown;
      if (event.key in steps) store.lookAt(shown + steps[event.key]);
      else if (event.key === "Home") store.lookAt(first);
      else if (event.key === "End") store.lookAt(store.isBag ? last : null);
      else return;
      event.preventDefault();
    });
  }

  draw(now: number): void {
    const { context } = this;
    if (!this.pace.due(now, context.revision)) return;
    const { store } = context;
    const bag = store.isBag;
    for (const element of [this.play, this.speed]) show(element, bag);
    show(this.live, !bag);
    setText(this.play, this.playing ? "❚❚ pause" : "▶ play");
    setText(this.live, store.cursor !== null ? "back to live (Esc)" : store.isLive ? "● LIVE" : "○ NOT LIVE");
    this.live.classList.toggle("on", store.isLive);
    const shown = bag ? store.now : store.shown;
    const [from, to] = store.span;
    const back = to - shown;
    setText(
      this.time,
      bag
        ? `${dateAndClock(shown)} · ${lapse(shown - from)} of ${lapse(to - from)}`
        : store.cursor === null
          ? clock(shown)
          : `${clock(shown)} · ${lapse(back)} ago`,
    );
    const size = fit(this.canvas);
    const key = [
      store.hourRevision,
      store.journalRevision,
      context.revision,
      shown.toFixed(1),
      context.range[0].toFixed(0),
      `${size.width}x${size.height}`,
    ].join(" ");
    if (key === this.drawn || !(to > from)) return;
    this.drawn = key;
    setAttribute(this.canvas, "aria-valuemin", String(Math.round(from)));
    setAttribute(this.canvas, "aria-valuemax", String(Math.round(to)));
    setAttribute(this.canvas, "aria-valuenow", String(Math.round(shown)));
    setAttribute(this.canvas, "aria-valuetext", this.time.textContent ?? "");
    this.paint(from, to, shown, size);
  }

  private paint(
    from: number,
    to: number,
    shown: number,
    { width, height, ratio }: { width: number; height: number; ratio: number },
  ): void {
    const { store, palette } = this.context;
    const { layout, hour } = store;
    const pencil = this.canvas.getContext("2d");
    if (!pencil || !layout) return;
    const x = (time: number) => ((time - from) / (to - from)) * width;
    pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
    pencil.clearRect(0, 0, width, height);
    const [left, right] = this.context.range;
    pencil.fillStyle = palette.panel;
    pencil.fillRect(x(Math.max(left, from)), 0, x(Math.min(right, to)) - x(Math.max(left, from)), height - 14);
    // The outline of the rotary speed distinguishes connections from drilling.
    const speed = layout.offset("rotary_speed_applied");
    let known = NaN;
    for (let index = 0; index < hour.length; index++) {
      const value = hour.value(index, speed);
      if (!(known >= value) && !Number.isNaN(value)) known = value;
    }
    // The scale of a tool at standstill; a speed that was never received has no scale at all.
    const most = Math.max(1, known || 0);
    const scale = Number.isNaN(known) ? "no data" : `0 to ${withUnit(most, "speed", this.context.settings.units)}`;
    setText(this.legendText, `rotary speed, ${scale}`);
    pencil.fillStyle = `${palette.trace}59`;
    const wide = Math.max(1, (width * store.period) / (to - from) + 0.5);
    for (let index = 0; index < hour.length; index++) {
      const tall = ((hour.value(index, speed) || 0) / most) * (height - 22);
      pencil.fillRect(x(hour.time(index)) - wide, height - 14 - tall, wide, tall);
    }
    const colours = [palette.trace, palette.low, palette.medium, palette.high];
    const inks = [palette.ink, palette.lowInk, palette.mediumInk, palette.highInk];
    for (const { time, level } of this.incidents()) {
      if (time < from || time > to) continue;
      const at = Math.min(Math.max(x(time), 7), width - 7);
      pencil.fillStyle = colours[level] ?? palette.trace;
      pencil.fillRect(at - 6, 0, 12, 12);
      pencil.fillStyle = inks[level] ?? palette.ink;
      pencil.font = "bold 10px system-ui, sans-serif";
      pencil.textAlign = "center";
      pencil.fillText("LMH"[level - 1] ?? "", at, 10);
    }
    pencil.fillStyle = palette.muted;
    pencil.font = "11px system-ui, sans-serif";
    pencil.textAlign = "center";
    for (const { time, label } of timeTicks(from, to, width)) {
      pencil.fillRect(x(time), height - 16, 1, 4);
      const half = pencil.measureText(label).width / 2;
      pencil.fillText(label, Math.min(Math.max(x(time), half), width - half), height - 2);
    }
    pencil.fillStyle = palette.mark;
    const at = Math.min(Math.max(x(shown), 2), width - 2);
    pencil.fillRect(at - 1, 0, 2, height - 12);
    pencil.beginPath();
    pencil.moveTo(at - 6, height - 12);
    pencil.lineTo(at + 6, height - 12);
    pencil.lineTo(at, height - 20);
    pencil.fill();
    const here = this.incidents()
      .reverse()
      .find(({ time }) => time <= shown + 0.5 && time > shown - 10);
    setText(this.incident, (store.cursor !== null || store.isBag) && here ? `alarm raised: ${here.text}` : "");
  }
}
