// Plausible tools: ranges only where they are of the shown time, bands of strips by their stamp, chances in words.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Alarm, type AlarmChance, type Bands, type Transfer } from "../src/messages";
import { rangeOf } from "../src/ranges";
import { Store } from "../src/store/store";
import { digits, type System } from "../src/units";
import { alarms, type Expected } from "../src/views/forecast";
import { anyAlarm, chanceWords, notBelieved, standsIn, whyNone, worth } from "../src/views/plausible";
import { withBand, withGaps } from "../src/views/strip";
import { facts, places, type Ranges } from "../src/views/transfer";

const header = (time: number) => {
  const sec = Math.floor(time);
  return { stamp: { sec, nanosec: Math.round((time - sec) * 1e9) }, frame_id: "tool" };
};

/** Bands of figures (low, high) at a time (s). */
function bands(time: number, figures: Record<string, [number, number]>, more: Partial<Bands> = {}): Bands {
  const none = new Float64Array(0);
  return {
    header: header(time),
    begun: { sec: 0, nanosec: 0 },
    members: 12,
    failed: 0,
    prepared: 0,
    effective: 9.4,
    renewals: 0,
    no_bands: "",
    bands: Object.entries(figures).map(([name, [p5, p95]]) => ({ name, unit: "", p5, p50: (p5 + p95) / 2, p95 })),
    measured_depth: none,
    pipe_guide_force_p5: none,
    pipe_guide_force_p50: none,
    pipe_guide_force_p95: none,
    guide_wall_force_p5: none,
    guide_wall_force_p50: none,
    guide_wall_force_p95: none,
    alarms: [],
    any_alarm: 0,
    any_alarm_lower: 0,
    any_alarm_upper: 0.24,
    distrusted: [],
    distrusted_why: [],
    band_factors: none,
    ...more,
  };
}

/** A store whose newest time is `now` (s). */
function at(now: number, ...messages: Bands[]): Store {
  const store = new Store();
  Object.defineProperty(store, "now", { get: () => now });
  for (const message of messages) store.accept("twin/bands", message);
  return store;
}

function chance(id: string, priority: number, seen: number, members = 12): AlarmChance {
  const interval = { probability: seen / members, lower: 0.3, upper: 0.8, time_to_first: NaN };
  return { id, name: id.replace("_", "-"), priority, seen, members, ...interval };
}

test("a figure has its range in the display's unit, and none without a band", () => {
  const store = at(101.5, bands(100, { "transfer/bit_torque": [71.2, 117.6], "bit_state/rotary_speed": [4, 5] }));
  const range = (name: string, kind: "torque" | "speed", system: System) =>
    rangeOf(store, name, (value) => digits(value, kind, system));
  assert.equal(range("transfer/bit_torque", "torque", "si"), "(71 to 118)");
  assert.equal(range("transfer/bit_torque", "torque", "field"), "(53 to 87)");
  assert.equal(range("bit_state/rotary_speed", "speed", "si"), "(38.2 to 47.7)");
  assert.equal(range("bit_state/torque", "torque", "si"), "");
  assert.equal(rangeOf(at(1), "bit_state/torque", String), "");
});

test("a band that is more than ten seconds old, without a value or withdrawn is not shown", () => {
  const of = (now: number, ...messages: Bands[]) => rangeOf(at(now, ...messages), "bit_state/torque", String);
  const message = bands(100, { "bit_state/torque": [1, 2] });
  assert.deepEqual([of(110, message), of(110.1, message), of(99, message)], ["(1 to 2)", "", ""]);
  assert.equal(of(101, bands(100, { "bit_state/torque": [NaN, NaN] })), "");
  // A message without bands ends those before it.
  assert.equal(of(102, message, bands(101, {}, { no_bands: "too few" })), "");
  assert.equal(at(110, message).bands.fresh(110)?.members, 12);
  const { bands: book } = at(111, message);
  assert.deepEqual([book.fresh(111), book.fresh(98.9), at(1).bands.fresh(1)], [null, null, null]);
});

test("plausible tools of a silent twin or of the past are not those of the present", () => {
  const store = at(101, bands(100, {}));
  const members = () => store.plausible?.members ?? 0;
  assert.equal(members(), 0);
  store.setConnected(true);
  store.accept("twin/status", { header: header(101), input_name: [] });
  assert.equal(members(), 12);
  store.lookAt(50);
  assert.equal(members(), 0);
});

test("a player that is brought back has the bands of that time, and a message that came twice counts once", () => {
  const store = at(101);
  const of = (time: number) => store.bands.rows("bit_state/torque", 0, time);
  for (const [time, low] of [
    [100, 1],
    [101, 2],
    [102, 3],
    [102, 3],
  ])
    store.accept("twin/bands", bands(time, { "bit_state/torque": [low, low + 5] }));
  assert.deepEqual(of(200), [
    [100, 101, 102],
    [1, 2, 3],
    [6, 7, 8],
  ]);
  assert.equal(rangeOf(store, "bit_state/torque", String), "(2 to 7)");
  store.accept("twin/bands", bands(101, { "bit_state/torque": [9, 10] }));
  assert.deepEqual(of(200)[1], [1, 9]);
});

test("the band of a strip has its own times, and breaks the line nowhere", () => {
  const lines = withGaps([100, 101, 102], [[5, null, 7]], 2.5);
  const band = withGaps(
    [99.5, 100.5, 106],
    [
      [1, 2, 3],
      [4, 5, 6],
    ],
    3,
  );
  const [times, low, high, line] = withBand(lines, band);
  assert.deepEqual(times, [99.5, 100, 100.5, 101, 102, 103.25, 106]);
  // Undefined leaves a line as it is, null ends it.
  assert.deepEqual(low, [1, undefined, 2, undefined, undefined, null, 3]);
  assert.deepEqual(high, [4, undefined, 5, undefined, undefined, null, 6]);
  assert.deepEqual(line, [undefined, 5, undefined, null, 7, undefined, undefined]);
  assert.deepEqual(
    withBand(
      [
        [1, 2],
        [3, 4],
      ],
      [[], [], []],
    ),
    [
      [1, 2],
      [null, null],
      [null, null],
      [3, 4],
    ],
  );
});

test("a station has the band of its depth, and none where plausible tools have no station near", () => {
  const profile = (...forces: number[]) => Float64Array.from(forces);
  const message = bands(
    100,
    {},
    {
      measured_depth: profile(0, 0.2, 0.4),
      pipe_guide_force_p5: profile(1, 2, 3),
      pipe_guide_force_p95: profile(10, 20, 30),
      guide_wall_force_p5: profile(4, 5, 6),
      guide_wall_force_p95: profile(40, 50, 60),
    },
  );
  const { bands: book } = at(101, message);
  assert.deepEqual(book.stationRows("pipe_guide", 0.02, 90, 110), [[100], [1], [10]]);
  assert.deepEqual(book.stationRows("guide_wall", 0.39, 90, 110), [[100], [6], [60]]);
  assert.deepEqual(book.stationRows("guide_wall", 0.6, 90, 110), [[], [], []]);
  assert.deepEqual(book.stationRows("guide_wall", 0.4, 101, 110)[0], [100]);
  assert.deepEqual(book.stationRows("guide_wall", 0.4, 90, 99)[0], []);
});

test("rows of the transfer have ranges where there are any", () => {
  const known = { bit_torque: 92, bit_weight: 6500, rate_of_penetration: 3 / 3600, depth_of_cut: 1e-3 };
  const transfer = new Proxy(known, { get: (target, key) => Reflect.get(target, key) ?? NaN }) as unknown as Transfer;
  const store = at(
    100,
    bands(100, {
      "transfer/bit_torque": [71, 118],
      "transfer/rate_of_penetration": [2 / 3600, 4.4 / 3600],
      "transfer/hook_load": [1, 2],
    }),
  );
  const ranges: Ranges = (field, text) => rangeOf(store, `transfer/${field}`, text);
  assert.deepEqual(places(transfer, "si", ranges), [
    { label: "Bit", values: ["92", "6.5"], ranges: ["(71 to 118)", ""] },
  ]);
  assert.deepEqual(
    facts(transfer, "field", ranges).map(({ values, ranges }) => [values[0], ranges?.[0]]),
    [
      ["9.8 ft/h", "(6.6 to 14.4)"],
      ["0.0394 in per turn", undefined],
    ],
  );
});

test("plausible tools say how many they are, what they are worth, and what is unknown", () => {
  assert.equal(worth(bands(0, {})), "12 plausible tools, worth 9.4 alike.");
  assert.equal(
    worth(bands(0, {}, { failed: 1 })),
    "12 plausible tools, worth 9.4 alike; 1 could not be computed, so what it does is unknown.",
  );
  assert.match(worth(bands(0, {}, { failed: 2 })), /; 2 could not be computed, so what they do is unknown\.$/);
  assert.equal(worth(bands(0, {}, { members: 0, effective: 0 })), "");
  assert.equal(whyNone(bands(0, {})), "");
  assert.equal(whyNone(bands(0, {}, { no_bands: "they have not begun yet" })), "No bands: they have not begun yet.");
});

test("a sensor that is not believed is named with the reason", () => {
  assert.equal(notBelieved(bands(0, {})), "");
  const distrusted = ["surface_torque", "hook_load"];
  assert.equal(
    notBelieved(bands(0, {}, { distrusted, distrusted_why: ["it is stuck", "its unit"] })),
    "Not believed: surface torque (it is stuck); hook load (its unit).",
  );
  assert.equal(notBelieved(bands(0, {}, { distrusted: ["hook_load"] })), "Not believed: hook load.");
});

test("an alarm has the chance of its highest priority, and never all of it", () => {
  const words = (...all: AlarmChance[]) => alarms(all).map((of: Expected) => chanceWords(of));
  assert.deepEqual(
    words(chance("stick_slip", 1, 7), chance("stick_slip", 2, 7), chance("stick_slip", 3, 7), chance("shock", 1, 12)),
    ["Stick-slip, high: in 7 of 12 plausible tools (58 %)", "Shock, low: in 12 of 12 plausible tools"],
  );
  assert.deepEqual(words(chance("shock", 1, 9), chance("shock", 2, 1)), [
    "Shock, medium: in 1 of 12 plausible tools (8 %); low or higher: in 9 of 12 plausible tools",
  ]);
  // By their weights, some tools count for next to nothing and others for nearly all.
  const weighted = (probability: number) => words({ ...chance("shock", 1, 7), probability })[0];
  assert.equal(weighted(0.004), "Shock, low: in 7 of 12 plausible tools (< 1 %)");
  assert.equal(weighted(0.997), "Shock, low: in 7 of 12 plausible tools (> 99 %)");
  assert.equal(weighted(1), "Shock, low: in 7 of 12 plausible tools (> 99 %)");
  assert.equal(weighted(NaN), "Shock, low: in 7 of 12 plausible tools");
});

test("the chance of any alarm has its interval", () => {
  const any = (any_alarm: number, any_alarm_lower: number, any_alarm_upper: number) =>
    anyAlarm(bands(0, {}, { any_alarm, any_alarm_lower, any_alarm_upper }));
  assert.equal(any(0.58, 0.32, 0.81), "Any alarm: chance 58 % (32 % to 81 %).");
  assert.equal(any(0, 0, 0.243), "No alarm stands in a plausible tool (chance at most 24 %).");
  assert.equal(any(1, 0.757, 1), "An alarm stands in every plausible tool (chance at least 76 %).");
  assert.equal(any(0.98, 0.7, 1), "Any alarm: chance 98 % (at least 70 %).");
  assert.equal(any(NaN, NaN, 1), "");
});

test("a standing alarm says in how many plausible tools it stands", () => {
  const alarm = (id: string, priority = 3, more: Partial<Alarm> = {}): Alarm =>
    ({
      ...{ id, priority, state: Alarm.ACTIVE_UNACKNOWLEDGED, evidence: "", ended: false },
      ...{ less_severe_since: { sec: 0, nanosec: 0 }, ...more },
    }) as Alarm;
  const some = bands(
    0,
    {},
    { alarms: [chance("stick_slip", 1, 7), chance("stick_slip", 3, 7), chance("shock", 1, 5)] },
  );
  assert.equal(standsIn(alarm("stick_slip"), some), "stands in 7 of 12 plausible tools");
  assert.equal(standsIn(alarm("shock"), some), "stands in 5 of 12 plausible tools, as high in none");
  assert.equal(standsIn(alarm("backward_whirl"), some), "stands in none of 12 plausible tools");
  assert.equal(standsIn(alarm("backward_whirl"), { ...some, failed: 2 }), "stands in none of 10 plausible tools");
  // Plausible tools have no inputs or computers that could fail.
  assert.equal(standsIn(alarm("real_time"), some), "");
  assert.equal(standsIn(alarm("rotary_speed_input"), some), "");
  for (const none of [null, { ...some, no_bands: "too few" }, { ...some, alarms: [], failed: 12 }]) {
    assert.equal(standsIn(alarm("stick_slip"), none), "");
  }
  assert.equal(standsIn(alarm("stick_slip", 3, { ended: true }), some), "");
  assert.equal(standsIn(alarm("stick_slip", 3, { state: Alarm.SHELVED }), some), "");
});

test("the hour of bands is bounded, and goes with what it is of", () => {
  const store = at(9000);
  for (let time = 0; time < 4000; time++) store.accept("twin/bands", bands(time, { "bit_state/torque": [0, 1] }));
  const [times] = store.bands.rows("bit_state/torque", 0, 9000);
  assert.ok(times.length >= 3600 && times.length < 3700 && times[times.length - 1] === 3999);
  store.bands.clear();
  assert.deepEqual([store.bands.newest, store.bands.rows("bit_state/torque", 0, 9000)[0]], [null, []]);
});
