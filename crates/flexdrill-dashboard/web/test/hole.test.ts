// The hole ahead: words with ranges, unknown never drawn, the plan laid from the hole, distances to it.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Plan, Session, Tool } from "../src/api";
import type { HoleAhead, TwinStatus } from "../src/messages";
import { distance, laid, type Point } from "../src/plan";
import { Store } from "../src/store/store";
import {
  details,
  drawing,
  drilledOf,
  needs,
  summary,
  surveyCounts,
  surveyed,
  toPlan,
  withheld,
} from "../src/views/hole";

const RADIUS = 3.2;
const radians = (angle: number) => (angle * Math.PI) / 180;

/** A bit at the end of a quarter circle that drills on along it, with a range of a tenth of a metre per metre. */
function hole(more: Partial<HoleAhead> = {}): HoleAhead {
  const depth = Array.from({ length: 21 }, (_, index) => 0.25 * index);
  const arc = (radius: number) => Float64Array.from(depth, (s) => radians(20) + s / radius);
  const numbers = (of: (s: number) => number) => Float64Array.from(depth, of);
  const from = radians(20);
  return {
    header: { stamp: { sec: 100, nanosec: 0 }, frame_id: "tool" },
    known: true,
    because: "",
    measured_depth: 1.117,
    weight_on_bit: 1e4,
    build_rate: 1 / 3.57,
    build_rate_low: 1 / 3.7,
    build_rate_high: 1 / 3.4,
    radius: 3.57,
    radius_low: 3.4,
    radius_high: 3.7,
    steering_number: 8.7,
    free_length: 1.22,
    ripples: false,
    radius_any_bit_low: 2.81,
    radius_any_bit_high: 3.65,
    measured_depths: numbers((s) => 1.117 + s),
    inclinations: arc(RADIUS),
    inclinations_low: arc(3.4),
    inclinations_high: arc(3.0),
    azimuths: numbers(() => 0),
    azimuths_low: numbers(() => -0.1),
    azimuths_high: numbers(() => 0.1),
    position_x: numbers((s) => RADIUS * (1 - Math.cos(from + s / RADIUS))),
    position_y: numbers(() => 0),
    position_z: numbers((s) => RADIUS * Math.sin(from + s / RADIUS)),
    half_width_high: numbers((s) => 0.1 * s),
    half_width_right: numbers((s) => 0.02 * s),
    members: 100,
    failed: 0,
    surveys_used: 0,
    since_survey: NaN,
    ...more,
  } as HoleAhead;
}

/** The tool in a quarter circle down to `end` (m of measured depth). */
function tool(end: number, plan: Plan | null): Tool {
  const stations = Array.from({ length: 101 }, (_, index) => {
    const measured_depth = (end * index) / 100;
    const inclination = measured_depth / RADIUS;
    const position: Point = [RADIUS * (1 - Math.cos(inclination)), 0, RADIUS * Math.sin(inclination)];
    return { measured_depth, inclination, position };
  });
  return { stations, plan } as Tool;
}

const planOf = (azimuth: number, ...stations: [number, number][]): Plan => ({
  target: 0.5,
  file: null,
  stations: stations.map(([measured_depth, inclination]) => ({
    measured_depth,
    inclination: radians(inclination),
    azimuth: radians(azimuth),
  })),
});

test("one sentence has radius and inclination with their ranges", () => {
  assert.equal(
    summary(hole(), "si"),
    "Radius 3.57 m over the next metre (3.40 to 3.70); after 3 m inclination 73.7° (70.6 to 77.3).",
  );
  // 3 m are 9.8 ft, and 3.57 m 11.71 ft.
  assert.match(summary(hole(), "field"), /^Radius 11\.71 ft .* after 9\.8 ft inclination 73\.7°/);
});

test("a straight or dropping hole has no largest radius, and a range that is not known no brackets", () => {
  const first = (more: Partial<HoleAhead>) => summary(hole(more), "si").split(";")[0];
  assert.equal(first({ radius: Infinity, build_rate: 0 }), "Straight over the next metre");
  assert.equal(
    first({ build_rate_low: -0.1, radius_high: Infinity }),
    "Radius 3.57 m over the next metre (3.40 m to straight or dropping)",
  );
  assert.equal(first({ build_rate_low: 0 }), "Radius 3.57 m over the next metre (3.40 m to straight)");
  assert.equal(
    first({
      build_rate: -0.1,
      build_rate_low: -0.125,
      build_rate_high: -0.0625,
      radius: 10,
      radius_low: 8,
      radius_high: 16,
    }),
    "Dropping with a radius of 10.00 m over the next metre (8.00 to 16.00)",
  );
  const unknown = { build_rate_low: NaN, build_rate_high: NaN, radius_low: NaN, radius_high: NaN };
  assert.equal(first(unknown), "Radius 3.57 m over the next metre");
  const nan = new Float64Array(21).fill(NaN);
  assert.match(summary(hole({ inclinations_low: nan, inclinations_high: nan }), "si"), /inclination 73\.7°\.$/);
});

test("surveys are named with what they correct, and drawn on the hole near the bit", () => {
  const corrected = hole({ surveys_used: 2, since_survey: 0.25, surveys_learnt: 1, members: 300 });
  assert.match(details(corrected, "si"), /90 % of 300 holes that are as likely as the surveys say\. 2 surveys used/);
  const off = details(hole({ surveys_because: "no survey lies below 3.03 m" }), "si");
  assert.match(off, /No survey is used\. Surveys: no survey lies below 3\.03 m\.$/);
  // On a quarter circle of 3.2 m: the survey 1 m above the bit, and none that is 2 m above it.
  const store = { session: { tool: tool(RADIUS * radians(90), null) } } as unknown as Store;
  const bit = 3.0;
  const depths = Float64Array.from([bit - 1, bit - 2]);
  const [place, ...more] = surveyed(store, hole({ measured_depths: Float64Array.of(bit), survey_depths: depths }));
  assert.equal(more.length, 0);
  // Stations are 50 mm apart: their chords are within 0.1 mm of the circle.
  assert.ok(Math.abs(place[2] - RADIUS * Math.sin((bit - 1) / RADIUS)) < 2e-4, `${place}`);
  assert.deepEqual(surveyed(store, hole()), []);
});

test("what is not known is said with its reason", () => {
  const none = new Float64Array(0);
  const because = "the bit is off bottom";
  assert.equal(
    summary(hole({ known: false, because, measured_depths: none }), "si"),
    "The hole ahead is not known: the bit is off bottom.",
  );
  assert.equal(summary(hole({ known: false, because: "" }), "si"), "The hole ahead is not known.");
  const points: Point[] = [
    [0, 0, 0],
    [1, 0, 0],
  ];
  assert.equal(toPlan(hole({ known: false }), points, planOf(0, [0, 0], [9, 0]), "si"), "");
});

test("ripple, the range of any bit and what the range rests on are said", () => {
  assert.equal(
    details(hole(), "si"),
    "The hole does not ripple. In a long arc at this weight, no bit makes this guide drill a radius outside 2.81 to 3.65 m. " +
      "In brackets and in grey: 90 % of 100 plausible tools. No survey is used.",
  );
  const said = details(hole({ ripples: true, failed: 2, surveys_used: 1, since_survey: 2 }), "si");
  assert.match(said, /^The hole ripples, with a period of about 1\.22 m\. .*; 2 more have no result\. 1 survey used/);
});

test("a plan is a circle between two stations, in the plane that it has at the bit", () => {
  const bit = radians(20) * RADIUS;
  for (const azimuth of [0, 350, 120]) {
    const points = laid(tool(bit, planOf(azimuth, [0, 0], [RADIUS * (Math.PI / 2), 90])), bit, 20);
    const end = points[points.length - 1];
    // Chords of 50 mm: the sum of their directions is a circle's within a step squared over 24 radii squared.
    [RADIUS, 0, RADIUS].forEach((part, axis) => assert.ok(Math.abs(end[axis] - part) < 1e-3, `${azimuth}: ${end}`));
  }
  // One that turns by 10 degrees to the right leaves the plane to the right.
  const turning = planOf(30, [0, 60], [4, 60], [8, 60]);
  turning.stations[2].azimuth = radians(40);
  const points = laid(tool(4, turning), 3.9, 20);
  assert.ok(Math.abs(points[80][1]) < 1e-9 && points[points.length - 1][1] > 0.2, `${points[points.length - 1]}`);
  // A hole that has left its plan does not begin on it.
  const away = planOf(0, [0, 0], [4, 0]);
  const [begin] = laid(tool(4, { ...away, offset: [0.1, 0.2, 0.3] }), 3.9, 5);
  assert.deepEqual(begin, [0.1, 0.2, 0.3]);
  // The end of what is asked for is in it, and what is no plan is empty.
  assert.equal(laid(tool(4, turning), 3.9, 5).length, 101);
  assert.deepEqual(laid(tool(4, null), 3.9, 5), []);
  assert.deepEqual(laid(tool(4, { target: 0.5, file: "plan.csv", stations: [] }), 3.9, 5), []);
});

test("the distance is that of the nearest point of a line", () => {
  const line: Point[] = [
    [0, 0, 0],
    [2, 0, 0],
  ];
  assert.equal(distance(line, [1, 3, 4]), 5);
  assert.equal(distance(line, [5, 0, 4]), 5);
  assert.ok(Number.isNaN(distance([[0, 0, 0]], [1, 0, 0])));
});

test("the distance to the plan is named at 1, 3 and 5 m, and not beyond its end", () => {
  const bit = hole().measured_depths[0];
  const said = (...stations: [number, number][]) => {
    const plan = planOf(0, [0, 0], ...stations);
    return toPlan(hole(), laid(tool(bit, plan), bit, bit + 5.5), plan, "si");
  };
  // A hole on its plan: 1/3.2 from the kick-off on, within the thickness of the chords.
  assert.equal(
    said([9, (9 / RADIUS) * (180 / Math.PI)]),
    "From the plan: 0.00 m after 1 m; 0.00 m after 3 m; 0.00 m after 5 m (target 0.50 m).",
  );
  // Straight on from the bit: after a way s the circle is R (1 - cos(s/R)) off, 0.155 and 1.306 m. The plan ends before 5 m.
  assert.match(
    said([bit, 20], [bit + 4, 20]),
    /0\.1[56] m after 1 m; 1\.31 m after 3 m, off target \(target 0\.50 m\)\.$/,
  );
  assert.equal(said([bit, 20], [bit + 0.5, 20]), "The plan ends here.");
});

test("one sentence says what the plan needs and which weight helps", () => {
  const bit = hole().measured_depths[0];
  const depth = Array.from({ length: 21 }, (_, index) => 0.25 * index);
  const compared: Partial<HoleAhead> = {
    plan_because: "",
    plan_off: 1.2,
    plan_build_rate: 1 / 3.2,
    plan_inclination: Float64Array.from(depth, (s) => radians(-2 * s)),
    plan_within: Float64Array.from(depth, () => 0.75),
    plan_weight_low: 9.5e3,
    plan_weight_high: 15e3,
    plan_nearest_weight: 15e3,
    plan_nearest_radius: 3.33,
    plan_weight: 15e3,
    plan_no_weight: false,
    plan_no_guide: false,
  };
  const said = (more: Partial<HoleAhead>) => needs(hole({ ...compared, ...more }), "si");
  assert.equal(said({}), "The plan needs 3.20 m: 6.0° behind it after 3 m. At 15.0 kN: 3.33 m.");
  const none = { plan_weight: NaN, plan_no_weight: true };
  assert.match(said(none), /No weight from 9\.5 kN to 15\.0 kN brings it back; at 15\.0 kN: 3\.33 m\.$/);
  assert.match(said({ ...none, plan_no_guide: true }), /cannot drill the plan at any weight; change the guide\.$/);
  // On its plan no weight is searched, and a straight plan has no radius.
  const on = { plan_weight: NaN, plan_nearest_weight: NaN, plan_off: 0.3, plan_build_rate: 0 };
  assert.equal(said(on), "The plan needs a straight hole: 6.0° behind it after 3 m.");
  // A plan that ends 2 m ahead, and one that is passed.
  const short = Float64Array.from(depth, (s) => (s <= 2 ? radians(s) : NaN));
  assert.match(said({ plan_inclination: short }), /: 2\.0° ahead of it after 2 m\./);
  assert.equal(said({ plan_off: NaN }), "");
  assert.equal(said({ known: false }), "");
  assert.match(said({ plan_because: "it ends here.", plan_off: NaN }), /^The plan is not compared: it ends here\.$/);
  // The chance is that of the last metre that is named.
  const plan = planOf(0, [0, 0], [9, (9 / RADIUS) * (180 / Math.PI)]);
  const points = laid(tool(bit, plan), bit, bit + 5.5);
  assert.match(
    toPlan(hole(compared), points, plan, "si"),
    /target 0\.50 m; 75 % of the plausible tools stay on target\)/,
  );
});

test("the cone is as wide as the message has it, across the hole", () => {
  const none: [Point[], Point[], number] = [[], [], NaN];
  const side = drawing(hole(), ...none, "side");
  assert.equal(side.cone.length, 42);
  // The last of one edge and the first of the other are of the same depth: 1 m apart after 5 m, along the high side.
  const [a, b] = [side.cone[20], side.cone[21]];
  assert.ok(Math.abs(Math.hypot(a[0] - b[0], a[1] - b[1]) - 1) < 1e-9);
  const last = hole().inclinations[20];
  assert.ok(Math.abs(a[0] - b[0] - Math.cos(last)) < 1e-9 && Math.abs(a[1] - b[1] + Math.sin(last)) < 1e-9);
  const above = drawing(hole(), ...none, "above");
  assert.ok(Math.abs(above.cone[20][1] - above.cone[21][1] - 0.2) < 1e-9);
  // Without a range there is none.
  const nan = new Float64Array(21).fill(NaN);
  assert.deepEqual(drawing(hole({ half_width_high: nan }), ...none, "side").cone, []);
});

/** A store of a twin that is heard. */
function heard(now: number): Store {
  const store = new Store();
  Object.defineProperty(store, "now", { get: () => now });
  store.session = { mode: "live", tool: tool(1.117, null) } as Session;
  store.setConnected(true);
  store.accept("twin/status", { header: { stamp: { sec: now, nanosec: 0 }, frame_id: "" }, input_name: [] });
  return store;
}

test("only an answer of the present is drawn", () => {
  const store = heard(105);
  assert.match(withheld(store) ?? "", /publishes no hole ahead, or its first answer/);
  store.accept("twin/hole_ahead", hole());
  assert.deepEqual([withheld(store), store.holeNow?.radius], [null, 3.57]);
  store.lookAt(50);
  assert.deepEqual([withheld(store), store.holeNow], ["The hole ahead is of the present.", null]);
  const late = heard(116);
  late.accept("twin/hole_ahead", hole());
  assert.deepEqual([withheld(late), late.holeNow], ["Withdrawn: no newer answer has come.", null]);
  const silent = new Store();
  silent.accept("twin/hole_ahead", hole());
  assert.equal(withheld(silent), "Withdrawn: the twin is silent.");
});

test("the hole as configured is drawn near the bit", () => {
  const points = drilledOf(heard(105), 1.117);
  assert.equal(points.length, 101);
  assert.ok(Math.abs(points[100][0] - RADIUS * (1 - Math.cos(1.117 / RADIUS))) < 1e-9);
});

test("the counts of surveys have what is used and what waits as accepted, and dashes where the twin says none", () => {
  const counts = { surveys_known: 3, surveys_waiting: 1, surveys_refused: 0 } as TwinStatus;
  assert.deepEqual(surveyCounts(counts), [
    ["accepted", "4"],
    ["used", "3"],
    ["below the bit", "1"],
    ["refused", "0"],
  ]);
  for (const none of [null, {} as TwinStatus]) {
    assert.deepEqual(
      surveyCounts(none).map(([, count]) => count),
      ["–", "–", "–", "–"],
    );
  }
});
