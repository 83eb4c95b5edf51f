// Alarms as they stand and stood, and the journal of their events.

import type { JournalEntry } from "../api";
import type { Alarm, AlarmEvent, AlarmList } from "../messages";
import { printable } from "../words";
import { stamp } from "./topics";

/** Most entries of the journal, and of alarm lists to drag back through. */
const JOURNAL = 2000;
const LISTS = 500;

export class AlarmBook {
  /** As they stand. */
  newest: AlarmList | null = null;
  journal: JournalEntry[] = [];
  journalRevision = 0;
  private lists: { time: number; list: AlarmList }[] = [];

  /** Takes a list; false where a newer one is known. */
  take(list: AlarmList, isBag: boolean): boolean {
    const last = this.newest;
    // Of a latched topic old samples may come too: the highest sequence holds, then the newest.
    if (last && !isBag && stamp(list.header) < stamp(last.header) && list.sequence <= last.sequence) return false;
    if (last) share(list, last);
    this.newest = list;
    if (!last || last.sequence !== list.sequence) {
      this.lists.push({ time: stamp(list.header), list });
      if (this.lists.length > LISTS) this.lists.shift();
    }
    return true;
  }

  takeEvent(event: AlarmEvent): void {
    const { sec, nanosec } = event.header.stamp;
    const { sequence, id, name, change, priority, annunciates, operator_name, reason, evidence } = event;
    const stamp_ns = (BigInt(sec) * 1_000_000_000n + BigInt(nanosec)).toString();
    const heard = { stamp_ns, sequence, id, name, change, priority, annunciates, operator_name, reason, evidence };
    const entry = shown(heard);
    if (this.journal.some((known) => identity(known) === identity(entry))) return;
    this.journal.push(entry);
    if (this.journal.length > JOURNAL) this.journal.shift();
    this.journalRevision++;
  }

  /** Takes the server's journal, older than what has been heard here. */
  takeJournal(events: JournalEntry[]): void {
    const known = new Set(events.map(identity));
    this.journal = [...events.map(shown), ...this.journal.filter((event) => !known.has(identity(event)))].slice(
      -JOURNAL,
    );
    this.journalRevision++;
  }

  /** As they stood at a time (s); null when that is not known. */
  at(time: number): AlarmList | null {
    let found: AlarmList | null = null;
    for (const entry of this.lists) {
      if (entry.time > time) break;
      found = entry.list;
    }
    return found;
  }

  /** What stood is of another time or tool. */
  forgetPast(): void {
    this.lists = [];
  }
}

/** Two twins that follow each other under one name may both count from one. */
const identity = (entry: JournalEntry): string => `${entry.sequence} ${entry.id} ${entry.stamp_ns}`;

/**
 * Takes from the list before what is the same: a list has all alarms with all their texts, and hardly one changes. 500 of them
 * would be megabytes otherwise.
 */
function share(list: AlarmList, before: AlarmList): void {
  const known = new Map(before.alarms.map((alarm) => [alarm.id, alarm]));
  list.alarms = list.alarms.map((alarm) => {
    const old = known.get(alarm.id);
    if (!old) return alarm;
    if (same(alarm, old)) return old;
    const texts = Object.entries(old).filter(
      ([key, text]) => typeof text === "string" && alarm[key as keyof Alarm] === text,
    );
    return { ...alarm, ...Object.fromEntries(texts) };
  });
}

function same(a: Alarm, b: Alarm): boolean {
  return (Object.keys(a) as (keyof Alarm)[]).every((key) => {
    const [x, y] = [a[key], b[key]];
    if (typeof x !== "object" || typeof y !== "object") return Object.is(x, y);
    return x.sec === y.sec && x.nanosec === y.nanosec;
  });
}

/** An entry as it is shown: any program of the network can send one, and its texts must not act on those around them. */
function shown(entry: JournalEntry): JournalEntry {
  const [name, operator_name, reason, evidence] = [entry.name, entry.operator_name, entry.reason, entry.evidence].map(
    printable,
  );
  return { ...entry, name, operator_name, reason, evidence };
}
