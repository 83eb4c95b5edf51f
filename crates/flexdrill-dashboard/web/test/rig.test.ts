// Rig and twin: band and measurement over the same times, nothing where nothing was judged, causes in words.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Residual, Residuals } from "../src/messages";
import { following, rows, summary, words } from "../src/views/rig";

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
    following: false,
    applied_friction_factor: 1,
    configured_friction_factor: 1,
    applied_torque_tare: 0,
    configured_torque_tare: 0,
    following_held: "calibration.follow is off",
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

test("what follows the rig is shown in force and as configured, with the reason where it is held", () => {
  const off = following(message(0, 310));
  assert.equal(off.state, "Nothing follows the rig: calibration.follow is off.");
  assert.deepEqual(off.rows[0], ["Friction factor", "1.00", "0.80 to 1.20", "1.000", "1.000"]);
  const on = { following: true, applied_friction_factor: 1.234, applied_torque_tare: 3.21 };
  const moving = following(message(0, 310, { ...on, following_held: "" }));
  assert.equal(moving.state, "The twin follows the rig.");
  assert.equal(moving.rows[0][3], "1.234");
  assert.deepEqual(moving.rows[1].slice(3), ["3.2", "0.0"]);
  const held = following(message(0, 310, { ...on, following_held: "the motion is not steady" }));
  assert.equal(held.state, "The twin follows the rig, held now: the motion is not steady.");
});
