// Day and night, after ISA-101: a grey ground, colour only for what is abnormal, and never colour alone.

export type ThemeName = "day" | "night";

export interface Palette {
  /** Ground, panels on it, lines between them. */
  ground: string;
  panel: string;
  well: string;
  line: string;
  /** Text, text of less weight, traces of values, lines of limits, marks of the shown time. */
  ink: string;
  muted: string;
  trace: string;
  limit: string;
  mark: string;
  /** What can be pressed, and its text. */
  button: string;
  buttonInk: string;
  /** Priorities and the text on them. */
  high: string;
  highInk: string;
  medium: string;
  mediumInk: string;
  low: string;
  lowInk: string;
}

export const PALETTES: Record<ThemeName, Palette> = {
  day: {
    ground: "#cfd3d6",
    panel: "#e6e8ea",
    well: "#dadde0",
    line: "#b3b9be",
    ink: "#14181b",
    muted: "#434a50",
    trace: "#274b6d",
    limit: "#5f676e",
    mark: "#14181b",
    button: "#c3c9ce",
    buttonInk: "#14181b",
    high: "#b3001b",
    highInk: "#ffffff",
    medium: "#f0a500",
    mediumInk: "#1a1200",
    low: "#66c2e0",
    lowInk: "#04222d",
  },
  night: {
    ground: "#191c1f",
    panel: "#25292d",
    well: "#1e2225",
    line: "#41484e",
    ink: "#e4e7e9",
    muted: "#a7aeb4",
    trace: "#9dbbd6",
    limit: "#8c949b",
    mark: "#f4f6f7",
    button: "#3a4147",
    buttonInk: "#f0f2f3",
    high: "#ff6b6b",
    highInk: "#200000",
    medium: "#ffb52e",
    mediumInk: "#1a1200",
    low: "#6fc7e4",
    lowInk: "#04222d",
  },
};

/** Contrast ratio of two colours, after WCAG 2. */
export function contrast(a: string, b: string): number {
  const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light + 0.05) / (dark + 0.05);
}

function luminance(colour: string): number {
  const [r, g, b] = channels(colour).map((value) =>
    value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4,
  );
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Red, green and blue of `#rrggbb`, 0 to 1. */
export function channels(colour: string): [number, number, number] {
  const at = (index: number) => parseInt(colour.slice(index, index + 2), 16) / 255;
  return [at(1), at(3), at(5)];
}

/** Colours between ground and full, for maps: one hue, darker (by day) or lighter (at night) with the value. */
export function shade(share: number, palette: Palette): [number, number, number] {
  const from = channels(palette.well);
  const to = channels(palette.trace);
  const s = Math.min(Math.max(share, 0), 1);
  return [0, 1, 2].map((index) => from[index] + (to[index] - from[index]) * s) as [number, number, number];
}
