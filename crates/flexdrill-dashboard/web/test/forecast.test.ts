// Looking ahead: bands of several forecasts in one strip, chances in words, unknown never as safe.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { WhatIfAnswer } from "../src/api";
import {
  type AlarmChance,
  type AppliedInputs,
  type Forecast,
  type ForecastBand,
  SafeWindow,
  TwinStatus,
} from "../src/messages";
import { Ring } from "../src/store/ring";
import { Store } from "../src/store/store";
import {
  alarms,
  alarmWords,
  bandOf,
  chance,
  type Present,
  presentOf,
  rows,
  summary,
  uncalibrated,
  withdrawn,
} from "../src/views/forecast";
import { frictionRows, holeOf, verdict } from "../src/views/what_if";
import { cellAt, edges, members, sentence } from "../src/views/window";

function forecast(from: number, values: number[], more: Partial<Forecast> = {}): Forecast {
  const low = Float64Array.from(values);
  const band: Partial<ForecastBand> = {
    name: "bit_torque",
    p5: low,
    p50: low.map((v) => v + 1),
    p95: low.map((v) => v + 2),
  };
  return {
    bands_from: { sec: from, nanosec: 0 },
    interval: 1,
    bands: [band as ForecastBand],
    members: 4,
    failed: 0,
    failure: "",
    any_alarm: 0,
    any_alarm_lower: 0,
    any_alarm_upper: 0.49,
    ...more,
  } as Forecast;
}

function alarm(id: string, priority: number, seen: number): AlarmChance {
  return {
    id,
    name: id,
    priority,
    seen,
    members: 4,
    probability: seen / 4,
    lower: 0.1,
    upper: 0.9,
    time_to_first: 7,
  } as AlarmChance;
}

test("a second has the band of the newest forecast that knows it, and unknown seconds have none", () => {
  const band = bandOf([forecast(100, [10, 10, 10]), forecast(102, [20, NaN])], "bit_torque");
  assert.deepEqual(
    band.map(({ time, low, high }) => [time, low, high]),
    [
      [100.5, 10, 12],
      [101.5, 10, 12],
      [102.5, 20, 22],
    ],
  );
  assert.deepEqual(bandOf([forecast(100, [1])], "weight_on_bit"), []);
});

test("band and line are columns over the same times, and end where data are missing", () => {
  const hour = new Ring(10, 1);
  for (const [time, value] of [
    [99, 5],
    [100, 11],
    [101, 12],
    [120, 13],
  ])
    hour.push(time)[0] = value;
  const [times, came, low, high] = rows([forecast(100, [10, 10, 10])], "bit_torque", hour, 0, 100);
  assert.equal(times[0], 100);
  const at = (time: number, column: (number | null)[]) => column[times.indexOf(time)];
  assert.equal(at(101, came), 12);
  assert.equal(at(100.5, low), 10);
  assert.equal(at(100.5, high), 12);
  // The band goes on over the line's rows and ends after its last second.
  assert.equal(at(101, low), 10);
  assert.equal(at(120, low), null);
  assert.equal(at(120, came), 13);
});

test("a forecast says what its runs saw, and what is unknown is said to be so", () => {
  assert.equal(summary(forecast(0, [])), "No alarm in 4 runs (chance 0.0 % to 49.0 %).");
  const some = forecast(0, [], { any_alarm: 0.5, any_alarm_lower: 0.15, any_alarm_upper: 0.85, failed: 1 });
  assert.match(summary(some), /^An alarm in 2 of 4 runs .* 1 more could not be computed to the end/);
  const none = forecast(0, [], { members: 0, failed: 4, failure: "a step failed", any_alarm: NaN });
  assert.equal(summary(none), "The next minute is unknown: a step failed.");
  const one = forecast(0, [], { members: 1, any_alarm: 1, any_alarm_lower: 0.2, any_alarm_upper: 1 });
  assert.match(summary(one), /^An alarm in 1 of 1 run \(/);
  assert.match(chance({ ...alarm("shock", 1, 1), members: 1 }), /^1 of 1 run \(/);
});

test("an alarm is listed once, at the highest priority that a run saw, with the count of that priority", () => {
  const all = [
    alarm("shock", 1, 3),
    alarm("shock", 2, 1),
    alarm("forward_whirl", 2, 4),
    alarm("stick_slip", 1, 2),
    alarm("stick_slip", 2, 2),
    alarm("stick_slip", 3, 2),
  ];
  assert.deepEqual(
    alarms(all).map(({ id, priority, seen, any }) => [id, priority, seen, any?.seen ?? null]),
    [
      ["stick_slip", 3, 2, null],
      ["forward_whirl", 2, 4, null],
      ["shock", 2, 1, 3],
    ],
  );
  const [stickSlip, , shock] = alarms(all).map(alarmWords);
  assert.equal(stickSlip, "stick_slip, high: 2 of 4 runs (10.0 % to 90.0 %), first after 7 s");
  // That it comes in three runs of four at a lower priority is not hidden by the one run of the higher.
  assert.equal(shock, "shock, medium: 1 of 4 runs (10.0 % to 90.0 %), first after 7 s; low or higher: 3 of 4");
  // The order of the message does not count, and a priority that no run saw is none.
  assert.deepEqual(
    alarms([...all].reverse()).map(({ priority }) => priority),
    [3, 2, 2],
  );
  assert.deepEqual(
    alarms([alarm("shock", 1, 2), alarm("shock", 3, 0)]).map(({ priority }) => priority),
    [1],
  );
  assert.equal(chance(all[0]), "3 of 4 runs (10.0 % to 90.0 %)");
});

/** What is asked for at a time (s): r/min and kN. */
function applied(time: number, rpm: number, kilonewton: number, more: Partial<AppliedInputs> = {}): AppliedInputs {
  return {
    header: { stamp: { sec: time, nanosec: 0 }, frame_id: "tool" },
    step: 2000 * time,
    rotary_speed: (rpm * Math.PI) / 30,
    weight_on_bit: 1e3 * kilonewton,
    ...more,
  } as AppliedInputs;
}

test("a forecast is shown only while it is one of the next minute at the present speed and weight", () => {
  const { header, step, rotary_speed, weight_on_bit } = applied(100, 120, 10);
  const made = forecast(101, new Array<number>(60).fill(1), { header, from_step: step, rotary_speed, weight_on_bit });
  const present: Present = {
    now: 110,
    silent: false,
    state: TwinStatus.RUNNING,
    applied: applied(110, 120, 10),
    start: 0,
    most: [(150 * Math.PI) / 30, 60e3],
  };
  const why = (more: Partial<Present>, of = made) => withdrawn(of, { ...present, ...more }, "si");
  assert.equal(why({}), null);
  // A drive wavers by some turns per minute, a weight by a kilonewton.
  assert.equal(why({ applied: applied(110, 116, 11) }), null);
  const was = "It was made for 120.0 r/min and 10.0 kN.";
  for (const [rpm, kilonewton] of [
    [80, 10],
    [120, 13],
  ]) {
    assert.equal(
      why({ applied: applied(110, rpm, kilonewton) }),
      `Withdrawn: it was made for 120.0 r/min and 10.0 kN, and ${rpm}.0 r/min and ${kilonewton}.0 kN are asked for ` +
        "now. The next one follows.",
    );
  }
  assert.equal(why({ silent: true }), `Withdrawn: the twin is silent. ${was}`);
  for (const state of [TwinStatus.PAUSED, TwinStatus.FAILED]) {
    assert.equal(why({ state }), `Withdrawn: the model stands still. ${was}`);
  }
  assert.equal(why({ start: 105 }), `Withdrawn: it is of an earlier run of the twin. ${was}`);
  assert.equal(why({ applied: applied(110, 120, 10, { step: 20 }) }), `Withdrawn: the model was reset since. ${was}`);
  assert.match(why({ applied: null }) ?? "", /not known/);
  assert.equal(why({ now: 160.9 }), null);
  assert.match(why({ now: 161 }) ?? "", /its minute is over/);
  assert.match(why({ now: 90 }) ?? "", /later time/);
  // One without any run has no speed and weight, and stands as long.
  const failed = { ...made, bands: [], members: 0, rotary_speed: NaN, weight_on_bit: NaN, failure: "a step failed" };
  assert.equal(why({}, failed), null);
  assert.equal(why({ now: 160 }, failed), "Withdrawn: its minute is over, and no newer one has come.");
});

test("the store knows what a forecast must be of", () => {
  const store = new Store();
  assert.deepEqual([presentOf(store).silent, presentOf(store).applied], [true, null]);
  store.accept("twin/applied_inputs", applied(110, 120, 10));
  assert.equal(presentOf(store).applied?.weight_on_bit, 10e3);
});

test("a band says how far ahead it is not calibrated yet", () => {
  const band = (calibrated: boolean[]) => ({
    lead_until: new Float64Array([10, 30, 60]),
    lead_calibrated: calibrated,
  });
  assert.equal(uncalibrated(band([true, true, true])), "");
  assert.equal(uncalibrated(band([false, true, false])), " Not calibrated yet 0 to 10 s, 30 to 60 s ahead.");
});

test("a candidate without a run that ended is unknown, not safe", () => {
  const answer: WhatIfAnswer = {
    candidate: { rotary_speed: 60, weight_on_bit: 12 },
    run_up: 1,
    members: 6,
    failed: 0,
    failure: "",
    decided: true,
    any_alarm: 0,
    any_alarm_lower: 0,
    any_alarm_upper: 0.39,
    alarms: [],
    figures: [],
    hole_known: true,
    hole_because: "",
    hole_radius: 3.15,
    hole_radius_low: 2.9,
    hole_radius_high: null,
    hole_plan_distance: 0.68,
    hole_plan_ahead: 5,
  };
  assert.equal(
    holeOf(answer, "si"),
    "Hole: radius 3.15 m over the next metre (2.90 to straight); 0.68 m from the plan after 5.00 m.",
  );
  assert.equal(
    holeOf({ ...answer, hole_radius: null, hole_plan_distance: null }, "si"),
    "Hole: straight over the next metre (2.90 to straight).",
  );
  const unknown = { ...answer, hole_known: false, hole_because: "the bit is off bottom" };
  assert.equal(holeOf(unknown, "si"), "Hole not known: the bit is off bottom.");
  assert.equal(verdict(answer), "no alarm in 6 runs (0.0 % to 39.0 %)");
  assert.equal(verdict({ ...answer, any_alarm: 0.5 }), "alarms in 3 of 6 runs (0.0 % to 39.0 %)");
  assert.equal(verdict({ ...answer, tools: 6 }), "no alarm in 6 plausible tools (0.0 % to 39.0 %)");
  assert.equal(verdict({ ...answer, tools: 4 }), "no alarm in 6 runs of 4 plausible tools (0.0 % to 39.0 %)");
  assert.match(verdict({ ...answer, failed: 2 }), /4 runs .*; 2 unknown$/);
  assert.match(verdict({ ...answer, failed: 6, any_alarm: null, failure: "a step failed" }), /^unknown: a step failed/);
});

test("an answer has a row for each other friction, with its counts", () => {
  const answer = {
    friction_factors: [0.8, 1.2],
    friction_members: [2, 2],
    friction_failed: [0, 1],
    friction_any_alarm: [0, 1],
  } as WhatIfAnswer;
  assert.deepEqual(frictionRows(answer), [
    { words: "If friction is a fifth lower: no alarm in 2 runs", alarm: false },
    { words: "If friction is a fifth higher: alarms in 1 of 1 run; 1 unknown", alarm: true },
  ]);
  // What failed is unknown, never safe, and what was not run says so.
  assert.deepEqual(frictionRows({ ...answer, friction_failed: [2, 0], friction_members: [2, 0] }), [
    { words: "If friction is a fifth lower: unknown: 2 runs failed", alarm: true },
    { words: "If friction is a fifth higher: not run", alarm: true },
  ]);
  // Feedback has no rows yet, nor has a twin of an earlier version.
  assert.deepEqual(frictionRows({} as WhatIfAnswer), []);
  assert.deepEqual(frictionRows({ ...answer, friction_factors: [] }), []);
  assert.match(
    frictionRows({ ...answer, friction_factors: [0.7, 1.2] })[0].words,
    /^If friction is 0\.70 of the present: /,
  );
});

function map(): SafeWindow {
  return {
    rotary_speed_rpm: Float64Array.from([40, 60, 80]),
    weight_on_bit_kn: Float64Array.from([5, 10]),
    verdict: Uint8Array.from([SafeWindow.CLEAR, SafeWindow.CLEAR, SafeWindow.ALARM, 3, 2, 1]),
    chance: Float64Array.from([0, 0, 0.8, NaN, 0.6, NaN]),
    alarm: ["", "", "backward_whirl", "", "chaotic_whirl", ""],
    was_run: [true, false, true, true, true, false],
  } as unknown as SafeWindow;
}

test("the map's cells end half-way, and a point has the words of its cell", () => {
  assert.deepEqual(edges([40, 60, 80]), [30, 50, 70, 90]);
  assert.deepEqual(edges([5, 10]), [2.5, 7.5, 12.5]);
  assert.deepEqual(
    [29, 30, 50, 90, 91, NaN].map((value) => cellAt([30, 50, 70, 90], value)),
    [-1, 0, 1, 2, -1, -1],
  );
  assert.equal(sentence(map(), 45, 5), "no alarm expected");
  assert.equal(sentence(map(), 60, 5), "no alarm expected (inferred from cells nearby)");
  assert.equal(sentence(map(), 85, 6), "alarm expected: backward whirl, chance 80.0 %");
  assert.match(sentence(map(), 60, 11), /^an alarm comes or not, depending on the way there: chaotic whirl/);
  assert.match(sentence(map(), 45, 9), /^unknown/);
  assert.equal(sentence(map(), 120, 9), "off the map: not known");
  // What was not run and is not known has its own words, never those of a clear cell.
  const unsure = { ...map(), verdict: Uint8Array.from([4, 0, 2, 3, 2, 1]) } as SafeWindow;
  assert.equal(unsure.verdict[0], SafeWindow.NOT_KNOWN);
  assert.match(sentence(unsure, 45, 5), /^not known: not run here/);
  assert.match(sentence({ ...map(), verdict: Uint8Array.from([9]) } as SafeWindow, 45, 5), /^unknown/);
});

test("the map's runs are those that ended", () => {
  const of = (least_members: number, most_members: number) => ({ ...map(), members: 20, least_members, most_members });
  assert.match(members(of(6, 8)), /: 6 to 8 runs$/);
  assert.match(members(of(20, 20)), /: 20 runs$/);
  assert.match(members(of(1, 1)), /: 1 run$/);
  assert.match(members(of(0, 0)), /^No run of this map ended/);
});
