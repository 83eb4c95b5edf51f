// Joints to inspect: rows, what to do, and the sentence above them.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { JointLife, Life } from "../src/api";
import { advice, heading, row } from "../src/views/life";

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
