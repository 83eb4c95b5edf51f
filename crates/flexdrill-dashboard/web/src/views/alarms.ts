// The alarms by priority, with cause, consequence and what to do; requests of an operator; the journal.

import { alarmLocation, endedAt, engineersAction, inOrder, isOfSystem, title, worstAt } from "../alarms";
import * as api from "../api";
import { h, setText, show } from "../dom";
import { Alarm, AlarmEvent, type AlarmList } from "../messages";
import { stamp } from "../store/topics";
import { clock, counted, dateAndClock, lapse, number } from "../units";
import { type Context, Pace, type View } from "../view";
import { ALARM_STATE, CHANGE, PRIORITY, PRIORITY_SHAPE, word } from "../words";
import { nearest } from "../store/geometry";
import { standsIn } from "./plausible";

/** Entries of the journal that are shown. */
const SHOWN = 100;

export class Alarms implements View {
  readonly element: HTMLElement;
  private readonly list = h("ul", { class: "alarm-list", id: "alarm-list" });
  private readonly systemTitle = h("h2", {}, "System");
  private readonly systemList = h("ul", { class: "alarm-list", id: "system-list" });
  private readonly notLive = h("p", { class: "not-live", id: "alarms-not-live" });
  private readonly quiet = h("ul", { class: "alarm-list" });
  private readonly quietTitle = h("summary");
  private readonly figures = h("p", { class: "hint" });
  private readonly answer = h("p", { class: "answer", role: "status", id: "alarm-answer" });
  private readonly journal = h("ol", { class: "journal", id: "journal" });
  private readonly operator: HTMLInputElement;
  private readonly reason = h("input", { type: "text", id: "alarm-reason", maxlength: "200", placeholder: "reason" });
  private readonly duration = h(
    "select",
    { id: "shelve-duration", "aria-label": "Shelve for" },
    ...[
      ["300", "5 min"],
      ["900", "15 min"],
      ["3600", "1 h"],
      ["once", "until it returns to normal"],
    ].map(([value, text]) => h("option", { value }, text)),
  );
  private readonly every = h("input", {
    type: "checkbox",
    id: "journal-every",
    onchange: () => (this.journalKey = ""),
  });
  private readonly control = h("div", { class: "control" });
  private readonly locked = h("p", { class: "hint" });
  private readonly pace = new Pace(250);
  /** Details that the operator has opened or closed, by alarm. */
  private readonly open = new Map<string, boolean>();
  /** Texts of how long an alarm has stood, with its begin (s). */
  private readonly ages: { element: HTMLElement; since: number }[] = [];
  /** Lines on plausible tools, with their alarm: they change each second, and the list does not. */
  private readonly plausible: { element: HTMLElement; alarm: Alarm }[] = [];
  /** A button is held down: the list does not change meanwhile, so that the click reaches its button. */
  private pressed = false;
  private key = "";
  private journalKey = "";

  constructor(private readonly context: Context) {
    this.operator = h("input", {
      type: "text",
      id: "operator",
      maxlength: "60",
      autocomplete: "name",
      value: context.settings.operator,
      onchange: () => context.change({ operator: this.operator.value.trim() }),
    });
    this.control.append(
      h("label", {}, "operator", this.operator),
      h("label", {}, "reason", this.reason),
      h("label", {}, "shelve for", this.duration),
      h(
        "button",
        { type: "button", id: "acknowledge-all", onclick: () => this.request("acknowledge", "all") },
        "Acknowledge all",
      ),
    );
    for (const name of ["pointerup", "pointercancel"]) {
      window.addEventListener(name, () => setTimeout(() => (this.pressed = false), 100));
    }
    this.element = h(
      "section",
      { class: "alarms", "aria-label": "Alarms" },
      this.notLive,
      this.list,
      this.systemTitle,
      this.systemList,
      this.locked,
      this.control,
      this.answer,
      h("details", {}, this.quietTitle, this.quiet),
      this.figures,
      h(
        "div",
        { class: "row" },
        h("h2", {}, "Journal"),
        h("label", { class: "hint" }, this.every, " show suppression"),
      ),
      this.journal,
    );
    this.element.addEventListener("pointerdown", () => (this.pressed = true));
  }

  private async request(what: "acknowledge" | "shelve" | "unshelve", id: string): Promise<void> {
    setText(this.answer, "");
    const operator = this.operator.value.trim();
    if (operator === "") {
      this.say(false, "Enter your name: the journal keeps it.");
      this.operator.focus();
      return;
    }
    const reason = this.reason.value.trim();
    if (what === "shelve" && reason === "") {
      this.say(false, "Enter a reason for shelving: the journal keeps it.");
      this.reason.focus();
      return;
    }
    this.context.change({ operator });
    const duration = this.duration.value === "once" ? null : Number(this.duration.value);
    const body = what === "shelve" ? { operator, id, reason, duration_s: duration } : { operator, id, reason };
    const { ok, message } = await api.request(what, body);
    this.say(ok, message || (ok ? "done" : "refused"));
    if (ok) this.reason.value = "";
  }

  private say(ok: boolean, message: string): void {
    this.answer.dataset.ok = String(ok);
    setText(this.answer, `${ok ? "✓" : "✕"} ${message}`);
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store, settings } = context;
    const { isLive } = store;
    const allowed = store.session?.control === true && isLive;
    show(this.control, allowed);
    show(this.locked, !allowed && isLive);
    setText(this.locked, "This server accepts no requests. To enable them, start it with --allow-control.");
    const list = store.alarmsShown();
    this.element.classList.toggle("old", !isLive);
    show(this.notLive, !isLive);
    setText(this.notLive, this.whyNotLive(list));
    const seen = list?.alarms.map((one) => [
      ...[one.state, one.priority, one.evidence, one.what_to_do, one.measured_depth],
      ...[engineersAction(one), endedAt(one)],
    ]);
    const key = `${list === null} ${list?.sequence} ${allowed} ${isLive} ${context.revision} ${JSON.stringify(seen)}`;
    if (key !== this.key && !this.pressed) {
      this.key = key;
      this.fill(list?.alarms ?? null, allowed);
      setText(
        this.figures,
        list
          ? `${list.unacknowledged} to acknowledge · ` +
              `${counted(list.annunciations_last_ten_minutes, "alarm")} in ten minutes${list.flood ? " – FLOOD" : ""}` +
              (Number.isFinite(list.annunciations_per_hour)
                ? ` · ${number(list.annunciations_per_hour, 1)} per hour`
                : "")
          : "",
      );
    }
    // The duration is known only for the shown time of the data.
    for (const { element, since } of this.ages) setText(element, lapse(Math.max(0, Math.floor(store.shown - since))));
    for (const { element, alarm } of this.plausible) {
      const text = standsIn(alarm, store.plausible);
      setText(element, text);
      show(element, text !== "");
    }
    const journalKey = `${store.journalRevision} ${settings.units} ${Math.floor(store.cursor ?? 0)}`;
    if (journalKey !== this.journalKey) {
      this.journalKey = journalKey;
      this.fillJournal();
    }
  }

  private fill(alarms: Alarm[] | null, allowed: boolean): void {
    const calls = (alarm: Alarm) => alarm.state >= 1 && alarm.state <= 4;
    const called = inOrder((alarms ?? []).filter(calls));
    const loud = called.filter((alarm) => !isOfSystem(alarm));
    const system = called.filter(isOfSystem);
    const quiet = (alarms ?? []).filter((alarm) => !calls(alarm));
    this.ages.length = this.plausible.length = 0;
    // The button that has the focus keeps it.
    const focused = (document.activeElement as HTMLElement | null)?.dataset.key;
    const unknown =
      this.context.store.cursor === null
        ? "No alarm list received yet."
        : "The alarms of this time are not known; see the journal below.";
    const empty = alarms ? "No alarm." : unknown;
    this.list.replaceChildren(
      ...(loud.length > 0 ? loud.map((alarm) => this.entry(alarm, allowed)) : [h("li", { class: "calm" }, empty)]),
    );
    show(this.systemTitle, system.length > 0);
    this.systemList.replaceChildren(...system.map((alarm) => this.entry(alarm, allowed)));
    setText(this.quietTitle, counted(quiet.length, "inactive alarm"));
    this.quiet.replaceChildren(
      ...quiet.map((alarm) => {
        const shelve = allowed && alarm.state === Alarm.NORMAL ? this.button("shelve", alarm.id, "Shelve") : null;
        return h("li", { class: "quiet" }, h("span", {}, `${alarm.name}: ${word(ALARM_STATE, alarm.state)}`), shelve);
      }),
    );
    if (focused) this.element.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus();
  }

  private button(what: "acknowledge" | "shelve" | "unshelve", id: string, text: string): HTMLElement {
    return h("button", { type: "button", "data-key": `${what} ${id}`, onclick: () => this.request(what, id) }, text);
  }

  private entry(alarm: Alarm, allowed: boolean): HTMLElement {
    const { settings } = this.context;
    const location = alarmLocation(alarm, settings.units);
    const age = h("span", { class: "since" });
    // The alarm began in an earlier run of the node: its duration is not known.
    if (alarm.from_earlier_run) setText(age, "from an earlier run");
    else if (alarm.since.sec > 0) this.ages.push({ element: age, since: alarm.since.sec + alarm.since.nanosec * 1e-9 });
    const unacknowledged = alarm.state === Alarm.ACTIVE_UNACKNOWLEDGED || alarm.state === Alarm.RETURNED_UNACKNOWLEDGED;
    const plausible = h("p", { class: "hint stands-in", hidden: true });
    this.plausible.push({ element: plausible, alarm });
    // Closed until it is opened: open ones would fill the panel and hide the alarms below.
    const details = h("details", { open: this.open.get(alarm.id) ?? false });
    const [worst, ended] = [worstAt(alarm), endedAt(alarm)];
    const forEngineer = isOfSystem(alarm) && engineersAction(alarm) !== "";
    const action = forEngineer ? engineersAction(alarm) : alarm.what_to_do;
    const rows = [
      ["Driller", forEngineer ? alarm.what_to_do : ""],
      [Number.isNaN(worst) ? "Evidence" : `Evidence, ${clock(worst)}`, alarm.evidence],
      ["Cause", alarm.cause],
      ["Consequence", alarm.consequence],
      ["Engineer", forEngineer ? "" : engineersAction(alarm)],
    ].filter(([, text]) => text !== "");
    details.append(
      h(
        "summary",
        { "data-key": `why ${alarm.id}`, onclick: () => this.open.set(alarm.id, !details.open) },
        "evidence and cause",
      ),
      h("dl", {}, ...rows.flatMap(([name, text]) => [h("dt", {}, name), h("dd", {}, text)])),
    );
    const where = location
      ? h("button", { type: "button", class: "link", onclick: () => this.choose(alarm.measured_depth) }, location)
      : null;
    const shelved =
      alarm.state === Alarm.SHELVED
        ? alarm.shelved_one_shot
          ? " until it returns to normal"
          : ` until ${clock(alarm.shelved_until.sec)}`
        : "";
    const watched = alarm.state === Alarm.RETURNED_UNACKNOWLEDGED ? "" : ", being watched";
    const end = Number.isNaN(ended) ? "" : ` · condition ended at ${clock(ended)}${watched}`;
    return h(
      "li",
      {
        class: "alarm",
        "data-level": String(alarm.priority),
        "data-id": alarm.id,
        "data-calls": String(unacknowledged && this.context.store.isLive),
      },
      h(
        "div",
        { class: "alarm-head" },
        h("span", { class: "badge" }, `${PRIORITY_SHAPE[alarm.priority] || "○"} ${word(PRIORITY, alarm.priority)}`),
        h("strong", {}, title(alarm)),
        age,
        h("span", { class: "alarm-state" }, `${word(ALARM_STATE, alarm.state)}${shelved}${end}`),
      ),
      where,
      plausible,
      action === "" ? null : h("p", { class: "action" }, action),
      h(
        "div",
        { class: "alarm-foot" },
        details,
        allowed
          ? h(
              "div",
              { class: "buttons" },
              unacknowledged ? this.button("acknowledge", alarm.id, "Acknowledge") : null,
              alarm.state === Alarm.SHELVED
                ? this.button("unshelve", alarm.id, "Unshelve")
                : this.button("shelve", alarm.id, "Shelve"),
            )
          : null,
      ),
    );
  }

  /** Why the alarms are not the present ones of the rig; empty where they are. */
  private whyNotLive(list: AlarmList | null): string {
    const { store } = this.context;
    if (store.isLive) return "";
    if (store.cursor !== null) return `Alarms at ${clock(store.cursor)}. They cannot be acknowledged from here.`;
    if (store.isBag) return `Alarms in the recording at ${dateAndClock(store.now)}. They are not the rig's now.`;
    const at = list ? clock(stamp(list.header)) : "";
    return list
      ? `Alarms as last received at ${at}. The page has no live data: their present state is not known.`
      : "The page has no live data.";
  }

  private choose(depth: number): void {
    const { geometry } = this.context.store;
    if (!geometry) return;
    const joint = nearest(geometry.jointDepth, depth);
    this.context.choose({ joint, station: geometry.jointStation[joint] });
  }

  private fillJournal(): void {
    const { store } = this.context;
    const cursor = store.cursor ?? Infinity;
    // A drive at standstill suppresses several alarms at once, which the journal shows on request only.
    const matters = (event: api.JournalEntry) =>
      this.every.checked ||
      event.priority > 0 ||
      event.operator_name !== "" ||
      event.annunciates ||
      event.change === AlarmEvent.ADJUSTED;
    const entries = store.journal.filter((event) => matters(event) && Number(BigInt(event.stamp_ns)) / 1e9 <= cursor);
    this.journal.replaceChildren(
      ...entries
        .slice(-SHOWN)
        .reverse()
        .map((event) => {
          const time = Number(BigInt(event.stamp_ns)) / 1e9;
          const who = event.operator_name ? ` by ${event.operator_name}` : "";
          const why = event.reason ? ` (${event.reason})` : "";
          return h(
            "li",
            {},
            h("button", { type: "button", class: "link", onclick: () => store.lookAt(time) }, clock(time)),
            ` ${PRIORITY_SHAPE[event.priority] ?? ""} ${event.name} ${word(CHANGE, event.change)}${who}${why}`,
          );
        }),
    );
    if (entries.length === 0) this.journal.append(h("li", { class: "none" }, "no entries yet"));
  }
}
