// The panels next to the tool: alarms, location, transfer, rig, look-ahead, hole, joint life, steering; one of them is shown.

import { h, setAttribute, setText, show } from "../dom";
import type { Context, View } from "../view";
import { AheadView } from "./ahead";
import { Alarms } from "./alarms";
import { HoleView } from "./hole";
import { LifeView } from "./life";
import { LocationView } from "./location";
import { RigView } from "./rig";
import type { Steer } from "./steer";
import { TransferView } from "./transfer";

export class Panels implements View {
  readonly element: HTMLElement;
  private readonly tabs: { name: string; tab: HTMLButtonElement; panel: HTMLElement; view: View }[] = [];
  private location: unknown = null;
  private readonly life: LifeView;

  constructor(
    private readonly context: Context,
    private readonly steer: Steer,
  ) {
    this.life = new LifeView(context);
    const bar = h("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
    const holder = h("div", { class: "panels" });
    for (const [name, view] of [
      ["Alarms", new Alarms(context)],
      ["Location", new LocationView(context)],
      ["Transfer", new TransferView(context)],
      ["Rig", new RigView(context)],
      ["Ahead", new AheadView(context)],
      ["Hole", new HoleView(context)],
      ["Life", this.life],
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
      if (context.location !== null && context.location !== this.location) this.open("Location");
      this.location = context.location;
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
    const { store } = this.context;
    // Alarms of a recording or of a twin that has ended need no response.
    const count = store.isBag || store.silent ? 0 : (store.alarms?.unacknowledged ?? 0);
    setText(this.tabs[0].tab, count > 0 ? `Alarms (${count})` : "Alarms");
    const driving = this.steer.driving;
    const { tab } = this.tabs[this.tabs.length - 1];
    setText(tab, driving ? `Steer: ${driving.by ?? "on"}` : "Steer");
    tab.classList.toggle("driving", driving !== null);
    // Only a server or a twin that was started with a table has lives to show.
    for (const { view, tab } of this.tabs) if (view === this.life) show(tab, this.life.offered);
    for (const { view } of this.tabs) view.draw(now);
  }
}
