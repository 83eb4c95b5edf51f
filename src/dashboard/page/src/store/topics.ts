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
] as const;
export type Topic = (typeof TOPICS)[number];

/** A header's time (s). */
export function stamp(header: Header): number {
  return header.stamp.sec + header.stamp.nanosec * 1e-9;
}
