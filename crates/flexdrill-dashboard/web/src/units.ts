// Units of the display. Messages are in SI; nothing but the display converts.

/** SI with r/min and kN, or the field's units. */
export type System = "si" | "field";

/** What is shown: its unit in either system, the factor from SI, the digits behind the point. */
interface Quantity {
  unit: string;
  factor: number;
  digits: number;
}

const RPM = 30 / Math.PI;
const POUND_FORCE = 4.4482216152605;
const FOOT = 0.3048;

const QUANTITIES = {
  speed: { si: { unit: "r/min", factor: RPM, digits: 1 }, field: { unit: "r/min", factor: RPM, digits: 1 } },
  weight: {
    si: { unit: "kN", factor: 1e-3, digits: 1 },
    field: { unit: "klbf", factor: 1e-3 / POUND_FORCE, digits: 2 },
  },
  force: {
    si: { unit: "kN", factor: 1e-3, digits: 2 },
    field: { unit: "lbf", factor: 1 / POUND_FORCE, digits: 0 },
  },
  torque: {
    si: { unit: "N m", factor: 1, digits: 0 },
    field: { unit: "ft lbf", factor: 1 / (POUND_FORCE * FOOT), digits: 0 },
  },
  depth: { si: { unit: "m", factor: 1, digits: 2 }, field: { unit: "ft", factor: 1 / FOOT, digits: 2 } },
  gap: { si: { unit: "mm", factor: 1e3, digits: 1 }, field: { unit: "in", factor: 12 / FOOT, digits: 3 } },
  advance: { si: { unit: "m/h", factor: 3600, digits: 1 }, field: { unit: "ft/h", factor: 3600 / FOOT, digits: 1 } },
  pressure: {
    si: { unit: "MPa", factor: 1e-6, digits: 2 },
    field: { unit: "psi", factor: (FOOT / 12) ** 2 / POUND_FORCE, digits: 0 },
  },
  cut: { si: { unit: "mm", factor: 1e3, digits: 2 }, field: { unit: "in", factor: 12 / FOOT, digits: 4 } },
  angle: {
    si: { unit: "°", factor: 180 / Math.PI, digits: 2 },
    field: { unit: "°", factor: 180 / Math.PI, digits: 2 },
  },
} satisfies Record<string, Record<System, Quantity>>;

export type Kind = keyof typeof QUANTITIES;

/** What a kind of value is shown as. */
export function quantity(kind: Kind, system: System): Quantity {
  return QUANTITIES[kind][system];
}

/** Value in the display's unit. */
export function convert(value: number, kind: Kind, system: System): number {
  return value * quantity(kind, system).factor;
}

/** Value as digits, a dash where there is none. */
export function digits(value: number, kind: Kind, system: System): string {
  const { factor, digits } = quantity(kind, system);
  return number(value * factor, digits);
}

/** Value with its unit. */
export function withUnit(value: number, kind: Kind, system: System): string {
  const { unit } = quantity(kind, system);
  return `${digits(value, kind, system)}${unit === "°" ? "" : " "}${unit}`;
}

/** A number with so many digits behind the point, without a negative zero; a dash where there is none. */
export function number(value: number, places: number): string {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(places);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

/**
 * Bounds of a set point, in r/min or kN, as the display has them. They are rounded inwards to the display's digits:
 * what is shown is accepted.
 */
export function bounds(limit: { min: number; max: number }, kind: "speed" | "weight", system: System): string {
  const { unit, digits: places } = quantity(kind, system);
  const scale = (kind === "weight" ? convert(1e3, kind, system) : 1) * 10 ** places;
  // A bound that has just these digits keeps them in spite of rounding.
  const least = Math.ceil(limit.min * scale - 1e-6) / 10 ** places;
  const most = Math.floor(limit.max * scale + 1e-6) / 10 ** places;
  return `${least} to ${most} ${unit}`;
}

/** So many of something, in the singular where it is one. */
export function counted(count: number, one: string): string {
  return `${count} ${one}${count === 1 ? "" : "s"}`;
}

/** A time that has gone by. */
export function lapse(seconds: number): string {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 120) return `${seconds.toFixed(0)} s`;
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min ${String(Math.floor(seconds % 60)).padStart(2, "0")} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.floor((seconds % 3600) / 60)} min`;
}

/** Date and time of day, as the browser's time zone has them. */
export function dateAndClock(seconds: number): string {
  if (!Number.isFinite(seconds)) return "–";
  const date = new Date(seconds * 1e3);
  const part = (value: number) => String(value).padStart(2, "0");
  return `${date.getFullYear()}-${part(date.getMonth() + 1)}-${part(date.getDate())} ${clock(seconds)}`;
}

/** Time of day on the rig's clock, as the browser's time zone has it. */
export function clock(seconds: number): string {
  if (!Number.isFinite(seconds)) return "--:--:--";
  const date = new Date(seconds * 1e3);
  return [date.getHours(), date.getMinutes(), date.getSeconds()].map((part) => String(part).padStart(2, "0")).join(":");
}
