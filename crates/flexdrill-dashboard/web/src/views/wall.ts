// State, five numbers and the alarms in type that is read from two metres, for a screen on a wall or a phone on a stand.

import { alarmLocation, hasAction, headline, isMet, levelNow, standing, title } from "../alarms";
import { h, setAttribute, setText } from "../dom";
import { type Context, Pace, type View } from "../view";
import { PRIORITY, PRIORITY_SHAPE, word } from "../words";
import { type Numbers, rangeOfTile, readTile } from "./numbers";

/** The numbers that it shows, by their tiles. */
const SHOWN = ["rpm", "wob", "bit-speed", "torque", "joints"];
/** Most alarms that have room. */
const MOST = 3;

export class Wall implements View {
  readonly element: HTMLElement;
  private readonly alarms = h("ul", { class: "wall-alarms", id: "wall-alarms" });
  private readonly fields: {
    id: string;
    root: HTMLElement;
    value: HTMLElement;
    unit: HTMLElement;
    range: HTMLElement;
    mark: HTMLElement;
  }[];
  private readonly pace = new Pace(250);
  private key = "";

  constructor(
    private readonly context: Context,
    private readonly numbers: Numbers,
  ) {
    this.fields = numbers.tiles
      .filter((tile) => SHOWN.includes(tile.id))
      .map((tile) => {
        const [mark, unit] = [h("span", { class: "mark" }), h("span", { class: "unit" })];
        const value = h("output", { class: "value", id: `wall-${tile.id}` });
        const range = h("span", { class: "range" });
        const root = h("article", { class: "wall-number" }, h("h2", {}, tile.label, mark), value, unit, range);
        return { id: tile.id, root, value, unit, range, mark };
      });
    const numbersRow = h("div", { class: "wall-numbers" }, ...this.fields.map(({ root }) => root));
    this.element = h("section", { class: "wall-view", "aria-label": "Large type" }, numbersRow, this.alarms);
  }

  draw(now: number): void {
    const { context } = this;
    if (!context.wall || !this.pace.due(now, context.revision)) return;
    const { store, settings } = context;
    const moment = store.moment();
    for (const { id, root, value, unit, range, mark } of this.fields) {
      const tile = this.numbers.tiles.find((one) => one.id === id);
      if (!tile) continue;
      const reading = readTile(tile, moment, store);
      setText(value, reading.value);
      setText(unit, tile.unit());
      setText(range, moment ? rangeOfTile(tile, store) : "");
      setText(mark, reading.level > 0 ? ` ${PRIORITY_SHAPE[reading.level] ?? ""}` : "");
      setAttribute(root, "data-level", String(reading.level));
      root.classList.toggle("held", reading.held === true || reading.value === "–");
    }
    const alarms = store.alarmsShown()?.alarms ?? [];
    const { drilling } = standing(alarms);
    const head = headline(alarms);
    const { isLive } = store;
    const key = JSON.stringify([
      isLive,
      settings.units,
      drilling.map((one) => [one.id, one.priority, one.what_to_do, isMet(one)]),
    ]);
    if (key === this.key) return;
    this.key = key;
    this.alarms.classList.toggle("old", !isLive);
    this.alarms.replaceChildren(
      ...drilling.slice(0, MOST).map((alarm) => {
        const location = alarmLocation(alarm, settings.units);
        return h(
          "li",
          { class: "wall-alarm", "data-level": String(levelNow(alarm)) },
          h("strong", {}, `${PRIORITY_SHAPE[alarm.priority]} ${title(alarm)}`),
          h("span", {}, `${word(PRIORITY, alarm.priority)}${location ? `, ${location}` : ""}`),
          // The top line has the leading action; a reference to it would only take the room of the alarms below.
          hasAction(alarm) && alarm !== head?.alarm ? h("p", {}, alarm.what_to_do) : null,
          isMet(alarm) ? null : h("p", {}, "The condition has ended; the twin watches whether it returns."),
        );
      }),
      ...(drilling.length > MOST ? [h("li", {}, `and ${drilling.length - MOST} more`)] : []),
      ...(drilling.length === 0 ? [h("li", { class: "none" }, isLive ? "No alarm." : "")] : []),
    );
  }
}
