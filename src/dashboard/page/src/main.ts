// The rig-side page: one store, views that read it, one picture loop.

import "uplot/dist/uPlot.min.css";
import "./page.css";
import * as api from "./api";
import { Connection } from "./connection";
import { h, setAttribute, setText, show } from "./dom";
import { Store } from "./store/store";
import { TOPICS } from "./store/topics";
import { Context, type View } from "./view";
import { Alarms } from "./views/alarms";
import { HeatMap } from "./views/heatmap";
import { Numbers } from "./views/numbers";
import { PlaceView } from "./views/place";
import { Scene } from "./views/scene";
import { StateLine } from "./views/state";
import { Steer } from "./views/steer";
import { TimeLine } from "./views/timeline";

/** How often the server is asked for what it did not know yet (ms). */
const ASK = 1000;

/** Session, hour and journal are asked for anew with every connection: the server may be another one. */
let sessionTaken = false;
let historyTaken = false;
let journalTaken = false;

const store = new Store();
const context = new Context(store);
api.token();

/** Panels beside the picture, one of them shown. */
class Panels implements View {
  readonly element: HTMLElement;
  private readonly tabs: { name: string; tab: HTMLButtonElement; panel: HTMLElement; view: View }[] = [];
  private place: unknown = null;

  constructor(private readonly steer: Steer) {
    const bar = h("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
    const holder = h("div", { class: "panels" });
    for (const [name, view] of [
      ["Alarms", new Alarms(context)],
      ["Place", new PlaceView(context)],
      ["Steer", steer],
    ] as const) {
      const id = name.toLowerCase();
      const tab = h(
        "button",
        {
          type: "button",
          role: "tab",
          id: `tab-${id}`,
          "aria-controls": `panel-${id}`,
          onclick: () => this.open(name),
        },
        name,
      );
      tab.addEventListener("keydown", (event) => {
        const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
        if (by === 0) return;
        const at = this.tabs.findIndex((entry) => entry.tab === tab);
        const next = this.tabs[(at + by + this.tabs.length) % this.tabs.length];
        this.open(next.name);
        next.tab.focus();
      });
      const panel = h(
        "div",
        { role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}`, class: "panel" },
        view.element,
      );
      bar.append(tab);
      holder.append(panel);
      this.tabs.push({ name, tab, panel, view });
    }
    this.element = h("aside", { class: "side" }, bar, holder);
    this.open("Alarms");
    context.onChange(() => {
      if (context.place !== null && context.place !== this.place) this.open("Place");
      this.place = context.place;
    });
  }

  open(name: string): void {
    for (const entry of this.tabs) {
      const on = entry.name === name;
      show(entry.panel, on);
      setAttribute(entry.tab, "aria-selected", String(on));
      setAttribute(entry.tab, "tabindex", on ? "0" : "-1");
    }
  }

  draw(now: number): void {
    const count = store.alarms?.unacknowledged ?? 0;
    setText(this.tabs[0].tab, count > 0 ? `Alarms (${count})` : "Alarms");
    const driving = this.steer.driving;
    setText(this.tabs[2].tab, driving ? `Steer: ${driving.by ?? "on"}` : "Steer");
    this.tabs[2].tab.classList.toggle("driving", driving !== null);
    for (const { view } of this.tabs) view.draw(now);
  }
}

const scene = new Scene(context);
const maps = [
  new HeatMap(context, "Pipe on guide", "pipe_guide_normal_peak"),
  new HeatMap(context, "Guide on wall", "guide_wall_normal_peak"),
];
const state = new StateLine(context);
const numbers = new Numbers(context);
const panels = new Panels(new Steer(context));
const time = new TimeLine(context);
const views: View[] = [state, numbers, scene, ...maps, panels, time];

document
  .getElementById("root")
  ?.append(
    state.element,
    h(
      "main",
      {},
      numbers.element,
      h("div", { class: "centre" }, scene.element, h("div", { class: "maps" }, ...maps.map((map) => map.element))),
      panels.element,
    ),
    time.element,
  );

async function ask(): Promise<void> {
  if (store.connected) {
    const { session } = store;
    const changed = session?.config_hash !== undefined && store.status?.config_hash !== session.config_hash;
    if (!sessionTaken || !session?.limits || !session.tool || changed || (session.bag && !session.bag.ready)) {
      const answer = await api.session();
      sessionTaken = answer !== null;
      store.session = answer ?? session;
    }
    if (!historyTaken && store.layout) {
      const history = await api.history();
      if (history) {
        store.takeHistory(history);
        historyTaken = history.head.complete !== false;
      }
    }
    if (!journalTaken && store.layout) {
      const events = await api.journal();
      if (events) {
        store.takeJournal(events);
        journalTaken = true;
      }
    }
  }
  setTimeout(() => void ask(), ASK);
}

const connect = () => {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  store.connection = new Connection(`${scheme}://${location.host}/live`, TOPICS, {
    onConnected(connected) {
      store.connected = connected;
      if (!connected) sessionTaken = historyTaken = journalTaken = false;
    },
    onMessage: (topic, schema, time, data) => store.take(topic, schema, time, data),
    onPlayback: (playback) => store.takePlayback(playback),
  });
};

// Which mode the server is in decides how times are taken, so it is asked before the first message.
void api.session().then((session) => {
  store.session = session;
  connect();
  void ask();
});

const frame = (now: number) => {
  for (const view of views) view.draw(now);
  requestAnimationFrame(frame);
};
requestAnimationFrame(frame);

// For measurements and tests: pictures of the scene drawn so far, and what the page knows.
Object.assign(window, { flexdrill: { store, context, scene } });
