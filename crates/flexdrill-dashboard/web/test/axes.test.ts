// Axes: whole times and values, gaps in lines, a spectrum's height, the scale of depth.

import assert from "node:assert/strict";
import { test } from "node:test";
import { ruler } from "../src/scene/ruler";
import { timeStep, timeTicks, valueTicks } from "../src/ticks";
import { fullHeight } from "../src/views/orbit";
import { withGaps } from "../src/views/strip";

// Labels are local times: those of the tests are of one place, a quarter of an hour off the whole ones.
process.env.TZ = "Asia/Kathmandu";

test("marks of time are on whole steps that divide the next larger unit, and have room", () => {
  for (const length of [10, 30, 60, 600, 1800, 3600, 7200, 86_400]) {
    for (const width of [90, 140, 300, 800, 1600]) {
      const from = 1_700_000_123.4;
      const ticks = timeTicks(from, from + length, width);
      const step = timeStep(from, from + length, width);
      const day = 86_400;
      assert.ok(day % step === 0, `${step} s divides a day`);
      assert.ok(ticks.every(({ time }) => time >= from && time <= from + length));
      for (let index = 1; index < ticks.length; index++) {
        assert.equal(ticks[index].time - ticks[index - 1].time, step);
        assert.ok((width * step) / length >= 52, `${length} s in ${width} px: ${step} s apart`);
      }
      // Local whole steps: no -29, -27, -24.
      for (const { time } of ticks) {
        const local = time - new Date(time * 1e3).getTimezoneOffset() * 60;
        assert.ok(Math.abs(local / step - Math.round(local / step)) < 1e-9, `${time} on a step of ${step} s`);
      }
    }
  }
  assert.deepEqual(timeTicks(5, 5, 100), []);
});

test("half a minute in a panel has whole seconds, ten minutes whole minutes", () => {
  const label = (from: number, to: number, width: number) =>
    timeTicks(from, to, width).map((tick) => tick.label.slice(-5));
  assert.deepEqual(label(1_700_000_000, 1_700_000_030, 300), ["58:20", "58:30", "58:40", "58:50"]);
  assert.ok(label(1_700_000_000, 1_700_000_600, 300).every((text) => /^\d\d:\d\d$/.test(text)));
});

test("marks of values are whole multiples of 1, 2 or 5", () => {
  assert.deepEqual(valueTicks(0, 126, 3), [0, 50, 100]);
  assert.deepEqual(valueTicks(0, 0.55, 3), [0, 0.2, 0.4]);
  assert.deepEqual(valueTicks(0, 5.03, 6), [0, 1, 2, 3, 4, 5]);
  assert.deepEqual(valueTicks(0, 0.3, 3), [0, 0.1, 0.2, 0.3]);
  assert.deepEqual(valueTicks(3, 3, 3), []);
  assert.ok(valueTicks(0, 1e9, 4).length <= 5);
});

test("a line ends where nothing came and goes on behind it", () => {
  assert.deepEqual(withGaps([1, 2, 6, 7], [[10, 11, 12, 13]], 2.5), [
    [1, 2, 4, 6, 7],
    [10, 11, null, 12, 13],
  ]);
  assert.deepEqual(withGaps([1, 2, 4], [[1, 2, 3]], 2.5), [
    [1, 2, 4],
    [1, 2, 3],
  ]);
  assert.deepEqual(withGaps([], [[]], 1), [[], []]);
});

test("the spectrum of a tool at rest is flat, that of one that moves fills its height", () => {
  const clearance = 0.0085;
  // What rounding and the solver's tolerance leave of a tool at rest: a millionth of the clearance.
  assert.ok(1e-8 / fullHeight(1e-8, clearance) < 1e-4);
  assert.equal(fullHeight(0, clearance), 0.1 * clearance);
  assert.equal(fullHeight(0.0017, clearance), 0.002);
  assert.equal(fullHeight(0.001, clearance), 0.001);
});

test("the scale of depth goes down beside the tool, in the display's unit", () => {
  const quarter = new Float32Array([0, 0, 0, 1, 0, 2.5, 3.2, 0, 3.2]);
  const metres = ruler(quarter, (depth) => depth);
  assert.deepEqual(
    metres.ticks.map(({ value }) => value),
    [0, 1, 2, 3],
  );
  assert.ok(metres.foot[2] > metres.head[2] && metres.head[0] < 0);
  assert.ok(Math.abs(metres.ticks[3].to[2] - 3) < 1e-6);
  const feet = ruler(quarter, (depth) => depth / 0.3048);
  assert.deepEqual(
    feet.ticks.map(({ value }) => value),
    [0, 2, 4, 6, 8, 10],
  );
  assert.ok(Math.abs(feet.ticks[5].to[2] - 3.048) < 1e-6);
  // A level tool has a scale, and no endless one.
  assert.ok(ruler(new Float32Array([0, 0, 0, 5, 0, 0]), (depth) => depth).ticks.length > 1);
});
