// Codes of the messages as words, the same as in the terminal's dashboard.

import { Alarm, AlarmEvent, TwinStatus, WhirlState } from "./messages";

export const RUN_STATE: Record<number, string> = {
  [TwinStatus.STARTING]: "STARTING",
  [TwinStatus.RUNNING]: "RUNNING",
  [TwinStatus.PAUSED]: "PAUSED",
  [TwinStatus.FAILED]: "FAILED",
};

export const INPUT_STATE: Record<number, string> = {
  [TwinStatus.INPUT_NOT_RECEIVED]: "not received",
  [TwinStatus.INPUT_OK]: "good",
  [TwinStatus.INPUT_SLOW]: "slow",
  [TwinStatus.INPUT_STALE]: "STALE",
  [TwinStatus.INPUT_REJECTED]: "REJECTED",
  [TwinStatus.INPUT_ASSUMED]: "assumed",
};

export const QUALITY: Record<number, string> = {
  [TwinStatus.QUALITY_GOOD]: "good",
  [TwinStatus.QUALITY_DEGRADED]: "degraded",
  [TwinStatus.QUALITY_POOR]: "POOR",
};

export const SEVERITY: Record<number, string> = { 0: "ok", 1: "watch", 2: "warning", 3: "critical" };

export const WHIRL_KIND: Record<number, string> = {
  [WhirlState.NONE]: "none",
  [WhirlState.FORWARD]: "forward",
  [WhirlState.BACKWARD]: "backward",
  [WhirlState.CHAOTIC]: "chaotic",
  [WhirlState.JOINT_VIBRATION]: "joint vibration",
};

export const PRIORITY: Record<number, string> = {
  [Alarm.NO_PRIORITY]: "–",
  [Alarm.LOW]: "low",
  [Alarm.MEDIUM]: "medium",
  [Alarm.HIGH]: "high",
};

export const ALARM_STATE: Record<number, string> = {
  [Alarm.NORMAL]: "normal",
  [Alarm.ACTIVE_UNACKNOWLEDGED]: "active, unacknowledged",
  [Alarm.ACTIVE_ACKNOWLEDGED]: "active, acknowledged",
  [Alarm.RETURNED_UNACKNOWLEDGED]: "returned, unacknowledged",
  [Alarm.SHELVED]: "shelved",
  [Alarm.SUPPRESSED_BY_DESIGN]: "suppressed while the drive is at standstill or starting",
  [Alarm.OUT_OF_SERVICE]: "out of service",
};

export const CHANGE: Record<number, string> = {
  [AlarmEvent.ACTIVATED]: "activated",
  [AlarmEvent.RAISED]: "raised",
  [AlarmEvent.LOWERED]: "lowered",
  [AlarmEvent.RETURNED]: "returned",
  [AlarmEvent.ACKNOWLEDGED]: "acknowledged",
  [AlarmEvent.SHELVED]: "shelved",
  [AlarmEvent.UNSHELVED]: "unshelved",
  [AlarmEvent.SUPPRESSED]: "suppressed",
  [AlarmEvent.RELEASED]: "no longer suppressed",
  [AlarmEvent.TAKEN_OUT]: "taken out of service",
  [AlarmEvent.PUT_BACK]: "put back into service",
  [AlarmEvent.ADJUSTED]: "– twin adjusted",
};

/** A word for a code, a question mark for one that this version does not know. */
export function word(words: Record<number, string>, code: number): string {
  return words[code] ?? "?";
}

/** Shape of a priority next to its colour and word: square, triangle, circle. */
export const PRIORITY_SHAPE: Record<number, string> = { 0: "", 1: "●", 2: "▲", 3: "■" };

/**
 * A publisher for an operator: `node @ host (id of its DDS writer)` without the id, which only distinguishes two of one name.
 */
export function publisher(named: string): string {
  return printable(named.replace(/ \((?:id )?[0-9a-f][0-9a-f.:]{7,}\)/gi, ""));
}

/** Marks that act on the text around them: control characters, and those that turn the direction of writing. */
const ACTING = /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g;

/** A text of another program, in which such marks are written out, so that they change nothing of what is around them. */
export function printable(text: string): string {
  return text.replace(ACTING, (mark) => `\\u{${mark.charCodeAt(0).toString(16)}}`);
}

/** What a display adds to an input that its source doubts and that drives the model all the same. */
export function doubt(status: TwinStatus | null, input: number): { text: string; level: number } {
  const doubted = status?.input_suspect[input] === true;
  return doubted ? { text: " · SUSPECT: its source doubts it", level: 1 } : { text: "", level: 0 };
}
