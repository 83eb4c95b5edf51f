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
  return isMet(alarm) ? NaN : seconds(alarm.ended_at);
}

const seconds = (time: Time): number => (time.sec > 0 ? time.sec + time.nanosec * 1e-9 : NaN);

/** It is active, also while only held in case its condition returns, and neither shelved nor suppressed. */
export function isActive(alarm: Alarm): boolean {
  return alarm.state === Alarm.ACTIVE_UNACKNOWLEDGED || alarm.state === Alarm.ACTIVE_ACKNOWLEDGED;
}

/**
 * Whether the condition goes on below the published priority, which stays until it is acknowledged or its off-delay is
 * over. Recordings of twins without the field say it in the evidence.
 */
function isLessSevere(alarm: Alarm): boolean {
  if (alarm.less_severe_since.sec > 0) return true;
  return /\bless severe since\b/i.test(alarm.evidence) && !/\bended at\b/i.test(alarm.evidence);
}

/** Whether the condition is met now, at whatever priority: neither ended nor only held in case it returns. */
export function isMet(alarm: Alarm): boolean {
  return !alarm.ended || isLessSevere(alarm);
}

/**
 * Level of the condition at present (0 to 3). Of a condition that is less severe than the published priority only that
 * is known, so that the next lower priority is its upper bound.
 */
export function levelNow(alarm: Alarm): number {
  if (!isMet(alarm)) return 0;
  return isLessSevere(alarm) ? Math.max(Alarm.LOW, alarm.priority - 1) : alarm.priority;
}

/** Advice that refers to the advice of another alarm, or asks for nothing. */
const NO_ACTION = /^(Follow the advice|The change advised|No further action)/;
/** The alarm that such advice refers to, by its name. */
const REFERS_TO = /^(?:Follow the advice|The change advised) for (.+?) (?:first|covers|does not)\b/;

/** Whether the alarm's advice is itself something to do. */
export function hasAction(alarm: Alarm): boolean {
  return alarm.what_to_do !== "" && !NO_ACTION.test(alarm.what_to_do);
}

/**
 * Alarms in the order in which a driller reads them: the worst present condition first, among equals the one whose
 * advice is an action; conditions that have ended last. Equals keep the order of the list.
 */
export function inOrder(alarms: readonly Alarm[]): Alarm[] {
  const rank = (alarm: Alarm) => 2 * levelNow(alarm) + (hasAction(alarm) ? 1 : 0);
  const met = alarms.filter((alarm) => isActive(alarm) && isMet(alarm)).sort((a, b) => rank(b) - rank(a));
  return [...met, ...alarms.filter((alarm) => !met.includes(alarm))];
}

/** What the top line says of the driller's alarms. */
export interface Headline {
  /** The highest level of the conditions that are met now. */
  level: number;
  /** The alarm that is named; its condition is met. */
  alarm: Alarm;
  /** What to do, never a reference to the advice of another alarm; the evidence where no action is known. */
  text: string;
  /** How many further alarms of the driller stand. */
  others: number;
}

/** The headline of a list; null where no condition of the driller's is met. */
export function headline(alarms: readonly Alarm[]): Headline | null {
  const met = inOrder(standing(alarms).drilling).filter(isMet);
  const worst = met[0];
  if (!worst) return null;
  const say = (alarm: Alarm, text: string) => ({ level: levelNow(worst), alarm, text, others: met.length - 1 });
  if (hasAction(worst)) return say(worst, worst.what_to_do);
  const referred = REFERS_TO.exec(worst.what_to_do)?.[1];
  const source = alarms.find((alarm) => alarm.name === referred && isMet(alarm) && hasAction(alarm));
  // An alarm that is not shown itself, such as one within its on-delay, lends its action to the one that stands.
  if (source) return say(met.includes(source) ? source : worst, source.what_to_do);
  const acting = met.find(hasAction);
  return acting ? say(acting, acting.what_to_do) : say(worst, worst.evidence);
}

/** Active alarms of the driller, those of the system; each in the order in which they are read. */
export function standing(alarms: readonly Alarm[]): { drilling: Alarm[]; system: Alarm[] } {
  const active = inOrder(alarms.filter((alarm) => isActive(alarm) && alarm.priority > 0));
  return { drilling: active.filter((alarm) => !isOfSystem(alarm)), system: active.filter(isOfSystem) };
}

/**
 * Level of what belongs to these alarms (0 to 3): that of the worst present condition, as in the top line. Where the
 * alarms of the shown time are not known, `otherwise`.
 */
export function levelOf(store: Store, ids: readonly string[], otherwise: number): number {
  const list = store.alarmsShown();
  if (!list) return otherwise;
  const own = list.alarms.filter((alarm) => ids.includes(alarm.id) && isActive(alarm));
  return Math.max(0, ...own.map(levelNow));
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
