// What all views share: the store, the settings, and which part of the time is shown.

import type { Store } from "./store/store";
import { PALETTES, type Palette, type ThemeName } from "./theme";
import type { System } from "./units";

const SETTINGS = "flexdrill-settings";
/** Fragment of the address that opens the view in large type. */
const WALL = "#wall";

interface Settings {
  units: System;
  theme: ThemeName | "auto";
  /** Length of the strips and maps (s). */
  window: number;
  /** Factor on displacements from the bore's axis. */
  exaggeration: number;
  /** Name of the operator in requests. */
  operator: string;
}

/** The selected location: a station, and its joint where it has one. */
export interface ToolLocation {
  station: number;
  joint: number | null;
}

export class Context {
  settings: Settings;
  palette: Palette;
  location: ToolLocation | null = null;
  /** Counts changes of settings, so that views that keep colours or units refresh. */
  revision = 0;
  private listeners: (() => void)[] = [];

  constructor(readonly store: Store) {
    const defaults: Settings = { units: "si", theme: "auto", window: 600, exaggeration: 10, operator: "" };
    let kept: Partial<Settings> = {};
    try {
      kept = JSON.parse(localStorage.getItem(SETTINGS) ?? "{}") as Partial<Settings>;
    } catch {
      // Damaged settings are replaced by the defaults.
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
    // Replacing the history entry does not load the page again.
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

  choose(location: ToolLocation | null): void {
    this.location = location;
    this.changed();
  }

  /** Calls `listener` after each change of settings or location. */
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

/** A part of the page. `draw` is called before each frame, and does nothing when nothing has changed. */
export interface View {
  draw(now: number): void;
}

/** Limits how often a view is drawn. */
export class Pace {
  private last = -Infinity;
  private revision = -1;

  constructor(private readonly interval: number) {}

  /** Whether the interval has passed (ms), or settings or location have changed. */
  due(now: number, revision: number): boolean {
    if (now - this.last < this.interval && revision === this.revision) return false;
    this.last = now;
    this.revision = revision;
    return true;
  }
}
