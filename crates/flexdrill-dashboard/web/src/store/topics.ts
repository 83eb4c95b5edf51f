// Topics that the page listens to, and the time of their messages.

import type { Header } from "../messages";

/** Topics that the page listens to, without namespace. */
export const TOPICS = [
  "twin/status",
  "twin/session",
  "twin/alarms",
  "twin/alarm_events",
  "twin/bit_state",
  "twin/contact_forces",
  "twin/joint_deflections",
  "twin/whirl",
  "twin/tool_shape",
  "twin/transfer",
  "twin/applied_inputs",
  "twin/forecast",
  "twin/bands",
  "twin/safe_window",
  "twin/residuals",
  "twin/hole_ahead",
  "twin/ageing",
] as const;
export type Topic = (typeof TOPICS)[number];

/** A header's time (s). */
export function stamp(header: Header): number {
  return header.stamp.sec + header.stamp.nanosec * 1e-9;
}

/** Topics that come all the time, of which the newest counts: what the page's lag is judged by. */
export const MOTION: readonly Topic[] = [
  "twin/status",
  "twin/bit_state",
  "twin/contact_forces",
  "twin/joint_deflections",
  "twin/whirl",
  "twin/tool_shape",
];
/** Topics of which every message counts. */
export const EVERY: readonly Topic[] = ["twin/alarm_events"];

/** A message's time (ns since 1970); 0 where it has none. */
export function instant(message: unknown): bigint {
  const { header, markers } = message as { header?: Header; markers?: { header: Header }[] };
  const time = (header ?? markers?.[0]?.header)?.stamp;
  return time ? BigInt(time.sec) * 1_000_000_000n + BigInt(time.nanosec) : 0n;
}
