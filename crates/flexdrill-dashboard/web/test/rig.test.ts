// Rig and twin: band and measurement over the same times, nothing where nothing was judged, causes in words.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Residual, Residuals } from "../src/messages";
import { rows, summary, words } from "../src/views/rig";

function residual(name: string, measured: number, predicted: number, band: number): Residual {
  return {
    name,
    unit: "N m",
    sample: measured,
    measured,
    predicted,
    low: predicted - band,
    high: predicted + band,
    ratio: (measured - predicted) / band,
  };
}

function message(time: number, torque: number, more: Partial<Residuals> = {}): Residuals {
  return {
    header: { stamp: { sec: time, nanosec: 0 }, frame_id: "" },
    residuals: [residual("surface_torque", torque, 300, 20), residual("hook_load", NaN, NaN, NaN)],
    steady: true,
    drilling: true,
    bit_depth: NaN,
    friction_factor: 1,
    friction_factor_low: 0.8,
    friction_factor_high: 1.2,
    torque_tare: 0,
    torque_tare_low: -30,
    torque_tare_high: 30,
    estimate_frozen: "",
    likely_causes: [],
    ...more,
  };
}

test("band and measurement are columns over the same times, with gaps where nothing was judged or sent", () => {
  const all = [message(90, 1), message(100, 310), message(101, NaN), message(110, 330)];
  const [times, measured, low, high] = rows(all, "surface_torque", 95);
  assert.deepEqual(times, [100, 101, 105.5, 110]);
  assert.deepEqual(measured, [310, null, null, 330]);
  assert.deepEqual([low[0], high[0], low[2]], [280, 320, null]);
  assert.deepEqual(rows(all, "hook_load", 95)[1], [null, null, null, null]);
  assert.deepEqual(rows(all, "unknown", 95)[1], [null, null, null, null]);
});

test("a quantity that is not judged has no numbers", () => {
  const [torque, hook] = message(0, 331).residuals;
  assert.deepEqual(words(torque, "torque", "si"), ["331", "280 to 320", "1.6"]);
  assert.deepEqual(words(hook, "weight", "si"), ["–", "–", "–"]);
});

test("the sentence says what is judged and what a difference may mean", () => {
  assert.equal(
    summary(message(0, 310, { bit_depth: 1234.4 })),
    "Drilling, bit at 1234 m: no residual is surely beyond its band.",
  );
  const causes = ["friction has risen", "the rock", "the weight", "more"];
  assert.equal(
    summary(message(0, 340, { drilling: false, likely_causes: causes })),
    "Off bottom. Likely friction has risen, or the rock, or the weight.",
  );
  assert.match(summary(message(0, 340, { steady: false })), /^Not judged: /);
  assert.match(summary(message(0, NaN)), /^Not judged yet/);
});
