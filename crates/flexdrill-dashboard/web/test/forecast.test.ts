// Looking ahead: bands of several forecasts in one strip, chances in words, unknown never as safe.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { WhatIfAnswer } from "../src/api";
import { type AlarmChance, type Forecast, type ForecastBand, SafeWindow } from "../src/messages";
import { Ring } from "../src/store/ring";
import { alarms, bandOf, chance, rows, summary } from "../src/views/forecast";
import { verdict } from "../src/views/what_if";
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
});

test("an alarm is listed once, the likeliest first", () => {
  const all = [alarm("shock", 1, 2), alarm("shock", 2, 1), alarm("backward_whirl", 3, 4)];
  assert.deepEqual(
    alarms(all).map(({ id, seen }) => [id, seen]),
    [
      ["backward_whirl", 4],
      ["shock", 2],
    ],
  );
  assert.equal(chance(all[0]), "2 of 4 runs (10.0 % to 90.0 %)");
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
  };
  assert.equal(verdict(answer), "no alarm in 6 runs (0.0 % to 39.0 %)");
  assert.equal(verdict({ ...answer, any_alarm: 0.5 }), "alarms in 3 of 6 runs (0.0 % to 39.0 %)");
  assert.match(verdict({ ...answer, failed: 2 }), /4 runs .*; 2 unknown$/);
  assert.match(verdict({ ...answer, failed: 6, any_alarm: null, failure: "a step failed" }), /^unknown: a step failed/);
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
  assert.match(members(of(0, 0)), /^No run of this map ended/);
});
