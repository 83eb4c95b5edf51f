// What alarms mean to the views: whose they are, where, and the level that everything of one alarm is coloured by.

import { Alarm, type Time } from "./messages";
import type { Store } from "./store/store";
import { number, type System, withUnit } from "./units";

/** Alarms of the twin's computer and network; recordings of older twins do not say so themselves. */
const OF_THE_SYSTEM = ["real_time", "recording", "network"];

/** Whether an alarm is for whoever runs the computer, not for the driller. */
export function isOfSystem(alarm: Alarm): boolean {
  return alarm.category === Alarm.SYSTEM || OF_THE_SYSTEM.includes(alarm.id);
}

/** What whoever looks after model and computer can do; empty where nothing is said. */
export function engineersAction(alarm: Alarm): string {
  return alarm.what_the_engineer_can_do;
}

/** When what the alarm says was seen (s); NaN where that is not said. */
export function worstAt(alarm: Alarm): number {
  return seconds(alarm.worst_at);
}

/** When the condition was last met (s) of an alarm whose condition has ended; NaN of any other. */
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

/** Where an alarm is worst, in words; empty where it has no place. */
export function alarmPlace(alarm: Alarm, system: System): string {
  if (alarm.body === Alarm.NOWHERE || !Number.isFinite(alarm.measured_depth)) return "";
  const body = alarm.body === Alarm.GUIDE ? "guide" : "pipe";
  const inclination = number((alarm.inclination * 180) / Math.PI, 0);
  return `${body} at ${withUnit(alarm.measured_depth, "depth", system)} (${inclination}°)`;
}

/** Its name as a sentence begins. */
export const title = (alarm: Alarm): string => alarm.name.charAt(0).toUpperCase() + alarm.name.slice(1);
