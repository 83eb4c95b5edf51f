// Alarms as the views need them: for whom, where, and the level that colours everything of one alarm.

import { Alarm, type Time } from "./messages";
import type { Store } from "./store/store";
import { number, type System, withUnit } from "./units";

/** Alarms of the twin's computer and network; recordings of older twins have no category. */
const OF_THE_SYSTEM = ["real_time", "recording", "network"];

/** Whether an alarm is for the person who runs the computer, not for the driller. */
export function isOfSystem(alarm: Alarm): boolean {
  return alarm.category === Alarm.SYSTEM || OF_THE_SYSTEM.includes(alarm.id);
}

/** What the engineer can do; empty in recordings of older twins. */
export function engineersAction(alarm: Alarm): string {
  return alarm.what_the_engineer_can_do;
}

/** The time of the alarm's worst moment (s); NaN where it is not known. */
export function worstAt(alarm: Alarm): number {
  return seconds(alarm.worst_at);
}

/** The end of the condition (s); NaN while the condition is met. */
export function endedAt(alarm: Alarm): number {
  return alarm.ended ? seconds(alarm.ended_at) : NaN;
}

const seconds = (time: Time): number => (time.sec > 0 ? time.sec + time.nanosec * 1e-9 : NaN);

/** Its condition stands, and it is neither shelved nor suppressed. */
export function isActive(alarm: Alarm): boolean {
  return alarm.state === Alarm.ACTIVE_UNACKNOWLEDGED || alarm.state === Alarm.ACTIVE_ACKNOWLEDGED;
}

/** Active alarms of the driller, the worst first; those of the system. */
export function standing(alarms: readonly Alarm[]): { drilling: Alarm[]; system: Alarm[] } {
  const active = alarms.filter((alarm) => isActive(alarm) && alarm.priority > 0);
  return { drilling: active.filter((alarm) => !isOfSystem(alarm)), system: active.filter(isOfSystem) };
}

/**
 * Level of what belongs to these alarms (0 to 3): the priority of the worst that is active, so that one alarm has one
 * colour everywhere. Where the alarms of the shown time are not known, `otherwise`.
 */
export function levelOf(store: Store, ids: readonly string[], otherwise: number): number {
  const list = store.alarmsShown();
  if (!list) return otherwise;
  const own = list.alarms.filter((alarm) => ids.includes(alarm.id) && isActive(alarm));
  return Math.max(0, ...own.map((alarm) => alarm.priority));
}

/** The worst location of an alarm as text; empty where it has none. */
export function alarmLocation(alarm: Alarm, system: System): string {
  if (alarm.body === Alarm.NOWHERE || !Number.isFinite(alarm.measured_depth)) return "";
  const body = alarm.body === Alarm.GUIDE ? "guide" : "pipe";
  const inclination = number((alarm.inclination * 180) / Math.PI, 0);
  return `${body} at ${withUnit(alarm.measured_depth, "depth", system)} (${inclination}°)`;
}

/** Its name as a sentence begins. */
export const title = (alarm: Alarm): string => alarm.name.charAt(0).toUpperCase() + alarm.name.slice(1);
