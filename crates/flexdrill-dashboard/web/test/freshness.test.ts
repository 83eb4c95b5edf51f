// The age of what is shown, by the server's clock; a page that falls behind; what it leaves out to catch up.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Pulse } from "../src/api";
import { Freshness } from "../src/store/freshness";
import { Inbox } from "../src/store/inbox";

const SECOND = 1_000_000_000n;

const pulse = (time: bigint, age: number): Pulse => ({
  instance: "a",
  time_ns: "0",
  newest: { "twin/status": { time_ns: String(time), age_s: age } },
});

test("a message from a queue is as old as the server says, not as young as its processing", () => {
  const freshness = new Freshness();
  freshness.begin(0);
  // Asked at 50 s of the page's clock: the server's newest speaks of 112 s and came 0.1 s ago. The page processes 100 s.
  freshness.hear(pulse(112n * SECOND, 0.1), 50_000, 50_000);
  freshness.take("twin/status", 100n * SECOND, 50_000);
  assert.equal(freshness.age("twin/status", 50_000), 12_100);
  assert.equal(freshness.age("twin/status", 50_400), 12_500);
  assert.equal(freshness.lag(["twin/status"], 50_000), 12_000);
  freshness.take("twin/status", 112n * SECOND, 50_500);
  assert.equal(freshness.lag(["twin/status"], 50_500), 0);
  assert.equal(freshness.age("twin/status", 50_500), 600);
  // Newer than the server's answer: it came to the server after that.
  freshness.take("twin/status", 113n * SECOND, 50_600);
  assert.equal(freshness.age("twin/status", 50_700), 100);
});

test("a twin that has gone is seen by the server's word while the page still works through a queue", () => {
  const freshness = new Freshness();
  freshness.begin(0);
  for (let second = 0; second < 10; second++) {
    const now = 1000 * second;
    // The page is ten seconds behind and processes messages all the time; the server has heard nothing since 0 s.
    freshness.take("twin/status", BigInt(90 + second) * SECOND, now);
    freshness.hear(pulse(100n * SECOND, second), now, now);
    assert.equal(freshness.serverAge("twin/status", now), now);
  }
});

test("a slow answer makes data old, not the page behind", () => {
  const freshness = new Freshness();
  freshness.begin(0);
  freshness.take("twin/status", 100n * SECOND, 4900);
  freshness.hear(pulse(100n * SECOND + SECOND / 5n, 0), 2000, 5000);
  assert.equal(freshness.lag(["twin/status"], 5000), 200);
  assert.equal(freshness.age("twin/status", 5000), 3200);
});

test("what the server heard before a connection is no lag of that connection", () => {
  const freshness = new Freshness();
  freshness.begin(60_000);
  // A twin that ended 30 s before the page was opened: nothing of it comes over the connection.
  freshness.hear(pulse(100n * SECOND, 30), 60_100, 60_100);
  assert.equal(freshness.lag(["twin/status"], 70_000), 0);
  assert.equal(freshness.age("twin/status", 70_000), Infinity);
  // One that runs, and nothing comes for 4 s.
  freshness.hear(pulse(104n * SECOND, 0.1), 64_000, 64_000);
  assert.equal(freshness.lag(["twin/status"], 64_000), 4000);
});

test("without an answer of the server no age is known", () => {
  const freshness = new Freshness();
  freshness.hear(pulse(100n * SECOND, 0), 1000, 1000);
  assert.equal(freshness.unconfirmed(3900), 0);
  assert.equal(freshness.unconfirmed(4500), 3500);
});

/** An inbox with a clock and tasks of the test. */
function inbox() {
  const state = { now: 0, cost: 0, seen: [] as string[], tasks: [] as (() => void)[] };
  const made = new Inbox(
    ["events"],
    ({ topic, time }) => {
      state.seen.push(`${topic} ${time}`);
      state.now += state.cost;
    },
    (task) => state.tasks.push(task),
    () => state.now,
  );
  const put = (topic: string, time: number) =>
    made.put(topic, "schema", BigInt(time), new DataView(new ArrayBuffer(0)));
  const work = (tasks: number) => {
    for (let index = 0; index < tasks; index++) state.tasks.shift()?.();
  };
  return { state, made, put, work };
}

test("a page that keeps up decodes every message in its order", () => {
  const { state, made, put, work } = inbox();
  for (let time = 0; time < 5; time++) put(time % 2 === 0 ? "forces" : "events", time);
  work(10);
  assert.deepEqual(state.seen, ["forces 0", "events 1", "forces 2", "events 3", "forces 4"]);
  assert.equal(made.skipped, 0);
});

test("a page that does not keep up decodes the newest of each topic, and every event", () => {
  const { state, made, put, work } = inbox();
  for (let time = 0; time < 90; time++) put(["forces", "bends", "events"][time % 3], time);
  // The page stood still for a second.
  state.now = 1000;
  work(1);
  assert.equal(made.skipped, 2 * 29);
  assert.deepEqual(
    state.seen.filter((seen) => !seen.startsWith("events")),
    ["forces 87", "bends 88"],
  );
  assert.equal(state.seen.filter((seen) => seen.startsWith("events")).length, 30);
});

test("decoding leaves room for pictures, and ends", () => {
  const { state, put, work } = inbox();
  state.cost = 5;
  for (let time = 0; time < 9; time++) put("forces", time);
  work(1);
  // Three of 5 ms reach the bound of 12 ms.
  assert.equal(state.seen.length, 3);
  work(2);
  assert.equal(state.seen.length, 9);
  assert.equal(state.tasks.length, 0);
});

test("what waits is bounded, whatever is sent while nothing is decoded", () => {
  const { made, put, state, work } = inbox();
  for (let time = 0; time < 50_000; time++) {
    state.now = time / 10;
    put("forces", time);
  }
  assert.ok(made.skipped > 48_000, `${made.skipped}`);
  work(100);
  assert.ok(state.seen.length <= 1000, `${state.seen.length}`);
  assert.equal(state.seen.at(-1), "forces 49999");
});
