// What all views share: the store, the settings, and which part of the time is shown.

import type { Store } from "./store/store";
import { PALETTES, type Palette, type ThemeName } from "./theme";
import type { System } from "./units";

const SETTINGS = "flexdrill-settings";
/** Part of the address that opens the view in large type. */
const WALL = "#wall";

interface Settings {
  units: System;
  theme: ThemeName | "auto";
  /** Length of the strips and maps (s). */
  window: number;
  /** Factor on displacements from the bore's axis. */
  exaggeration: number;
  /** Name that goes with requests. */
  operator: string;
}

/** Place that has been chosen: a station, and the joint there is one. */
export interface Place {
  station: number;
  joint: number | null;
}

export class Context {
  settings: Settings;
  palette: Palette;
  place: Place | null = null;
  /** Counts changes of settings: views that keep colours or units look again. */
  revision = 0;
  private listeners: (() => void)[] = [];

  constructor(readonly store: Store) {
    const defaults: Settings = { units: "si", theme: "auto", window: 600, exaggeration: 10, operator: "" };
    let kept: Partial<Settings> = {};
    try {
      kept = JSON.parse(localStorage.getItem(SETTINGS) ?? "{}") as Partial<Settings>;
    } catch {
      // A damaged note is none.
    }
    this.settings = { ...defaults, ...kept };
    this.palette = PALETTES[this.theme];
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.change({}));
    addEventListener("hashchange", () => this.applyWall());
    this.applyTheme();
    this.applyWall();
  }

  /** State, numbers and alarms in large type, instead of all views. */
  get wall(): boolean {
    return location.hash === WALL;
  }

  showWall(shown: boolean): void {
    // An address without a part keeps the place in the history; the page is not loaded again.
    history.replaceState(null, "", location.pathname + location.search + (shown ? WALL : ""));
    this.applyWall();
  }

  private applyWall(): void {
    document.body.classList.toggle("wall", this.wall);
    this.changed();
  }

  get theme(): ThemeName {
    const { theme } = this.settings;
    if (theme !== "auto") return theme;
    return matchMedia("(prefers-color-scheme: dark)").matches ? "night" : "day";
  }

  change(settings: Partial<Settings>): void {
    this.settings = { ...this.settings, ...settings };
    localStorage.setItem(SETTINGS, JSON.stringify(this.settings));
    this.applyTheme();
    this.changed();
  }

  choose(place: Place | null): void {
    this.place = place;
    this.changed();
  }

  /** Calls `listener` after each change of settings or place. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Begin and end of what strips and maps show (s). */
  get range(): [number, number] {
    const { store } = this;
    const [first, last] = store.span;
    if (store.isBag) {
      const length = Math.min(this.settings.window, last - first);
      const end = Math.min(last, Math.max(first + length, store.now + length / 2));
      return [end - length, end];
    }
    const { window } = this.settings;
    const cursor = store.cursor;
    const end = cursor === null || cursor > store.now - window ? store.now : Math.min(store.now, cursor + window / 2);
    return [end - window, end];
  }

  private applyTheme(): void {
    this.palette = PALETTES[this.theme];
    const root = document.documentElement;
    root.dataset.theme = this.theme;
    for (const [name, value] of Object.entries(this.palette)) root.style.setProperty(`--${name}`, value);
  }

  private changed(): void {
    this.revision++;
    for (const listener of this.listeners) listener();
  }
}

/** A part of the page. `draw` is called before each frame; a view does nothing when nothing has changed. */
export interface View {
  draw(now: number): void;
}

/** Lets something through at most so often. */
export class Pace {
  private last = -Infinity;
  private revision = -1;

  constructor(private readonly interval: number) {}

  /** Whether it is time again (ms), or settings or place have changed. */
  due(now: number, revision: number): boolean {
    if (now - this.last < this.interval && revision === this.revision) return false;
    this.last = now;
    this.revision = revision;
    return true;
  }
}
