// Joints to inspect: rows, what to do, and the sentence above them.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { JointLife, Life, Session } from "../src/api";
import type { Ageing } from "../src/messages";
import { Store } from "../src/store/store";
import { advice, damage, heading, living, row } from "../src/views/life";

const joint = (more: Partial<JointLife> = {}): JointLife => ({
  serial: "J-0112",
  place: 2,
  hours: 61.24,
  runs: 4,
  part: "link below",
  damage: "0.41 (0.12 to 1.4)",
  other: "0.022 (0.0064 to 0.076)",
  verdict: "A crack is possible: inspect it before the next run.",
  level: 2,
  hours_left: 0,
  ...more,
});

const life = (more: Partial<Life> = {}): Life => ({
  error: null,
  class: "DNVGL-RP-C203 F1",
  environment: "free corrosion",
  runs: 4,
  count: 3,
  joints: [joint()],
  unknown: "",
  ...more,
});

test("a row has joint, damage with its band and part, and where it drilled; foreign text cannot act", () => {
  assert.deepEqual(row(joint()), [
    "J-0112",
    "0.41 (0.12 to 1.4), link below",
    "61.2 h in 4 runs, place 2 from the bit",
  ]);
  const [serial, , drilled] = row(joint({ serial: "\u202eJ", runs: 1, place: null }));
  assert.equal(serial, "\\u{202e}J");
  assert.equal(drilled, "61.2 h in 1 run");
});

test("hours until a crack is possible are named only where there are some", () => {
  assert.equal(advice(joint()), "A crack is possible: inspect it before the next run.");
  assert.equal(
    advice(joint({ verdict: "No inspection is due by fatigue.", hours_left: 12.34 })),
    "No inspection is due by fatigue. At its mean rate a crack is possible after 12.3 h more.",
  );
  assert.equal(advice(joint({ hours_left: null })), "A crack is possible: inspect it before the next run.");
});

test("the heading counts what is to be inspected, and says why there is no table", () => {
  assert.match(heading(life()), /^3 joints in 4 runs, class DNVGL-RP-C203 F1 in free corrosion\. 1 to inspect, 2 more/);
  assert.match(heading(life({ count: 1, joints: [joint({ level: 0 })] })), /None needs an inspection by fatigue\. /);
  assert.match(heading({ error: "joints.csv: no such file", joints: [] }), /cannot be read: joints\.csv/);
});

/** Three joints from the top down; the middle one is the most damaged, by its link. */
const ageing = (more: Partial<Ageing> = {}): Ageing =>
  ({
    header: { stamp: { sec: 100, nanosec: 0 }, frame_id: "tool" },
    joint_serial_number: ["J-3", "J-2", "J-1"],
    stop_life_damage: Float64Array.of(0, 0.02, 1e-6),
    stop_life_damage_low: Float64Array.of(0, 0.005, 2.5e-7),
    stop_life_damage_high: Float64Array.of(0, 0.08, 4e-6),
    stop_life_damage_before: Float64Array.of(0, 0.01, 0),
    link_life_damage: Float64Array.of(0.1, 0.41, NaN),
    link_life_damage_low: Float64Array.of(0.03, 0.12, NaN),
    link_life_damage_high: Float64Array.of(0.33, 1.42, NaN),
    link_life_damage_before: Float64Array.of(0.05, 0.4, NaN),
    ...more,
  }) as Ageing;

test("the joints that drill now are listed by damage, with bands, places from the bit and dashes", () => {
  const list = living(ageing()).map(({ serial, cells }) => [serial, ...cells]);
  assert.deepEqual(list, [
    ["J-2", "2", "0.020 (0.0050 to 0.080)", "0.41 (0.12 to 1.4)", "0.010 and 0.40"],
    ["J-3", "3", "0 (0 to 0)", "0.10 (0.030 to 0.33)", "0 and 0.050"],
    ["J-1", "1", "below 0.0001 (below 0.0001 to below 0.0001)", "–", "0 and –"],
  ]);
  // A twin without a table, one of an older version, and none.
  const older = { ...ageing(), joint_serial_number: undefined } as unknown as Ageing;
  for (const none of [ageing({ joint_serial_number: [] }), older, null]) assert.deepEqual(living(none), []);
  assert.equal(living(ageing({ joint_serial_number: ["\u202eJ"] }))[0].serial, "\\u{202e}J");
});

test("a damage has the digits of the table of lives", () => {
  assert.deepEqual([0, 5e-5, 1e-4, 0.0956, 0.5, 1.44, 12.6, NaN].map(damage), [
    "0",
    "below 0.0001",
    "0.00010",
    "0.096",
    "0.50",
    "1.4",
    "13",
    "–",
  ]);
});

test("lives are those of the present: none while the past is looked at or the twin is silent", () => {
  const store = new Store();
  store.session = { mode: "live" } as Session;
  store.setConnected(true);
  store.accept("twin/ageing", ageing());
  assert.deepEqual([store.ageing?.joint_serial_number.length, store.ageingNow], [3, null]);
  store.session = { mode: "bag" } as Session;
  assert.equal(store.ageingNow?.joint_serial_number.length, 3);
});
