// The headline: it leads with a condition that is met and with an action, whatever list the twin publishes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { endedAt, hasAction, headline, inOrder, isActive, isMet, isOfSystem, levelNow } from "../src/alarms";
import type { Pulse, Session } from "../src/api";
import { Alarm, type AlarmList, TwinStatus } from "../src/messages";
import { Store } from "../src/store/store";
import { stateNow } from "../src/views/state";

const OVER = "No further action: the alarm clears by itself unless the motion returns.";
const NAMES = ["backward whirl", "forward whirl", "lateral shock", "stick-slip", "chaotic whirl", "joint load"];
const NOW = { stamp: { sec: 1_700_000_100, nanosec: 0 }, frame_id: "" };
const WORDS = ["", "WATCH", "ACT SOON", "ACT NOW"];

function alarm(name: string, over: Partial<Alarm> = {}): Alarm {
  const none = { sec: 0, nanosec: 0 };
  return {
    id: name.replace(/[ -]/g, "_"),
    name,
    priority: Alarm.HIGH,
    state: Alarm.ACTIVE_UNACKNOWLEDGED,
    active: true,
    since: none,
    worst_at: none,
    ended: false,
    ended_at: none,
    less_severe_since: none,
    evidence: `${name} was seen.`,
    cause: "",
    consequence: "",
    what_to_do: `Lower the speed because of ${name}.`,
    what_the_engineer_can_do: "",
    unit: "",
    body: Alarm.NOWHERE,
    measured_depth: NaN,
    inclination: NaN,
    ...over,
  } as Alarm;
}

const ended = (name: string, over: Partial<Alarm> = {}): Alarm =>
  alarm(name, {
    ended: true,
    ended_at: { sec: 1_700_000_090, nanosec: 0 },
    evidence: `${name} was seen. Worst at 07:08:30; ended at 07:08:34, being watched.`,
    what_to_do: OVER,
    ...over,
  });

const follows = (name: string, leading: string, over: Partial<Alarm> = {}): Alarm =>
  alarm(name, { what_to_do: `Follow the advice for ${leading} first, then check this alarm again.`, ...over });

/** A running twin with this list of alarms, on a page that hears it. */
function live(alarms: Alarm[]): Store {
  const store = new Store();
  store.session = { mode: "live" } as Session;
  store.setConnected(true);
  const status = {
    header: NOW,
    state: TwinStatus.RUNNING,
    model_quality: 0,
    input_name: [],
    input_applied: [4.2, 1e4],
  };
  store.accept("twin/status", status);
  const list = { header: NOW, sequence: 1, alarms, unacknowledged: 0 } as unknown as AlarmList;
  store.accept("twin/alarms", list);
  const newest = { "twin/status": { time_ns: `${NOW.stamp.sec}000000000`, age_s: 0 } };
  store.takePulse({ instance: "a", time_ns: "0", newest } as Pulse, performance.now());
  return store;
}

/** Numbers from 0 to below 1, the same of every run: Mulberry32. */
function random(seed: number): () => number {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let value = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    value = (value + Math.imul(value ^ (value >>> 7), 61 | value)) ^ value;
    return ((value ^ (value >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** A list as no twin has to publish it: any priority, state and reference, ended or not, in any order. */
function anyList(next: () => number): Alarm[] {
  const one = <T>(of: readonly T[]): T => of[Math.floor(next() * of.length)];
  const names = [...NAMES, "real time"].filter(() => next() < 0.6).sort(() => next() - 0.5);
  return names.map((name) => {
    const over = {
      priority: one([Alarm.LOW, Alarm.MEDIUM, Alarm.HIGH]),
      state: one([1, 1, 1, 2, 2, Alarm.RETURNED_UNACKNOWLEDGED, Alarm.SHELVED, Alarm.SUPPRESSED_BY_DESIGN]),
      category: name === "real time" ? Alarm.SYSTEM : Alarm.DRILLING,
    };
    const kind = next();
    if (kind < 0.3) return ended(name, over);
    // Less severe than its published priority, which messages call ended too.
    const less = { ended: true, evidence: `${name} was seen. Worst at 07:08:30; less severe since 07:08:34.` };
    const rest = kind < 0.4 ? less : {};
    if (kind < 0.6) return follows(name, one(NAMES), { ...over, ...rest });
    if (kind < 0.7) {
      return alarm(name, { ...over, what_to_do: `The change advised for ${one(NAMES)} covers this alarm too.` });
    }
    return kind < 0.75 ? alarm(name, { ...over, what_to_do: "" }) : alarm(name, { ...over, ...rest });
  });
}

test("of any list the headline is an alarm that stands, with the word of the worst that stands and an action", () => {
  const next = random(40);
  let [headed, acted, calm] = [0, 0, 0];
  for (let round = 0; round < 3000; round++) {
    const alarms = anyList(next);
    const words = JSON.stringify(alarms);
    const met = alarms.filter((one) => isActive(one) && !isOfSystem(one) && isMet(one));
    const head = headline(alarms);
    const { word, sentence } = stateNow(live(alarms), "si");
    assert.doesNotMatch(sentence, /(^|: )(Follow|The change advised|No further action)/, words);
    assert.equal(head !== null, met.length > 0, words);
    if (!head) {
      const held = alarms.some((one) => isActive(one) && !isOfSystem(one));
      assert.equal(word, held ? "WATCH" : "NORMAL", words);
      calm++;
      continue;
    }
    headed++;
    assert.ok(met.includes(head.alarm), words);
    assert.equal(head.level, Math.max(...met.map(levelNow)), words);
    assert.equal(word, WORDS[head.level], words);
    assert.ok(sentence.toLowerCase().startsWith(head.alarm.name), words);
    assert.doesNotMatch(sentence, /\bended\b/, words);
    if (met.some(hasAction)) {
      assert.ok(
        alarms.some((one) => isMet(one) && hasAction(one) && one.what_to_do === head.text),
        words,
      );
      acted++;
    }
  }
  // The lists are of all kinds.
  assert.ok(headed > 1000 && acted > 1000 && calm > 100, `${headed} ${acted} ${calm}`);
});

test("an alarm that has ended neither leads nor hides the one that stands", () => {
  const alarms = [ended("backward whirl"), alarm("stick-slip", { priority: Alarm.MEDIUM })];
  const { word, sentence } = stateNow(live(alarms), "si");
  assert.deepEqual([word, sentence], ["ACT SOON", "Stick-slip: Lower the speed because of stick-slip."]);
  assert.deepEqual(
    inOrder(alarms).map(({ name }) => name),
    ["stick-slip", "backward whirl"],
  );
});

test("advice that follows another alarm's is never the headline: the action itself is", () => {
  const leading = alarm("stick-slip", { priority: Alarm.MEDIUM });
  const { level, alarm: named, text, others } = headline([follows("chaotic whirl", "stick-slip"), leading]) ?? {};
  assert.deepEqual([level, named?.name, text, others], [Alarm.HIGH, "stick-slip", leading.what_to_do, 1]);
  // The leading alarm is not active itself: the one that stands is named, with the action.
  const waiting = { ...leading, state: Alarm.NORMAL, priority: Alarm.NO_PRIORITY };
  const lent = headline([follows("chaotic whirl", "stick-slip"), waiting]);
  assert.deepEqual([lent?.alarm.name, lent?.text], ["chaotic whirl", leading.what_to_do]);
  // Nothing in the list says what to do: what was seen.
  assert.equal(headline([follows("chaotic whirl", "stick-slip")])?.text, "chaotic whirl was seen.");
});

test("a condition below its published priority stands, at most at the next lower one", () => {
  const less = alarm("backward whirl", {
    ended: true,
    evidence: "Seen. Worst at 07:08:30; less severe since 07:08:34.",
  });
  assert.deepEqual([isMet(less), levelNow(less)], [true, Alarm.MEDIUM]);
  assert.ok(Number.isNaN(endedAt(less)));
  assert.equal(stateNow(live([less]), "si").word, "ACT SOON");
  assert.equal(levelNow({ ...less, priority: Alarm.LOW }), Alarm.LOW);
  // The field says so, whatever the evidence.
  const field = alarm("backward whirl", { less_severe_since: { sec: 1_700_000_000, nanosec: 0 } });
  assert.deepEqual([isMet(field), levelNow(field)], [true, Alarm.MEDIUM]);
  // First less severe, then over.
  assert.ok(!isMet({ ...less, evidence: "Seen. Less severe since 07:08:34; ended at 07:09:13, being watched." }));
  assert.equal(levelNow(ended("backward whirl")), 0);
});

test("only returned alarms of the driller are named as such in the top line", () => {
  const system = { category: Alarm.SYSTEM, state: Alarm.ACTIVE_UNACKNOWLEDGED };
  const returned = { state: Alarm.RETURNED_UNACKNOWLEDGED };
  const sentence = (...alarms: Alarm[]) => stateNow(live(alarms), "si").sentence;
  assert.match(sentence(alarm("real time", system)), /; no action required\.$/);
  assert.match(
    sentence(alarm("real time", system), ended("stick-slip", returned)),
    /; 1 returned alarm to acknowledge\.$/,
  );
});
