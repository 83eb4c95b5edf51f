// Transfer: rows without a value are not shown, shares are never rounded to nothing or to all.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Transfer, TwinStatus } from "../src/messages";
import { facts, losses, optionalInputs, percent, places, powers } from "../src/views/transfer";

/** Every figure unknown but for those that are given. */
function transfer(known: Partial<Transfer>): Transfer {
  return new Proxy(known, { get: (target, key) => Reflect.get(target, key) ?? NaN }) as Transfer;
}

const labels = (rows: { label: string }[]) => rows.map((row) => row.label);

test("a tool below a string has all places, the paper's tool neither surface nor hook", () => {
  const rig = transfer({
    surface_torque: 180.4,
    kickoff_torque: 170,
    bit_torque: 92,
    torque_efficiency: 0.51,
    surface_weight: 1e4,
    kickoff_weight: 9800,
    bit_weight: 6500,
    hook_load: 8e4,
    depth_of_cut: 1.25e-3,
    rate_of_penetration: 3 / 3600,
  });
  assert.deepEqual(places(rig, "si"), [
    { label: "Surface", values: ["180", "10.0"] },
    { label: "Kick-off", values: ["170", "9.8"] },
    { label: "Bit", values: ["92", "6.5"] },
    { label: "Arrives at the bit", values: ["51.0 %", "65.0 %"] },
  ]);
  assert.deepEqual(
    facts(rig, "si").map((row) => row.values[0]),
    ["80.0 kN", "3.0 m/h", "1.25 mm per turn"],
  );
  const paper = transfer({
    kickoff_torque: 170,
    bit_torque: 92,
    torque_efficiency: 0.54,
    kickoff_weight: 9800,
    bit_weight: 1e4,
    rate_of_penetration: 0,
    pipe_guide_friction_torque: 60,
    pipe_guide_axial_drag: 20,
    joint_friction_torque: 0,
    joint_friction_power: 0,
  });
  assert.deepEqual(labels(places(paper, "si")), ["Kick-off", "Bit", "Arrives at the bit"]);
  assert.equal(places(paper, "si")[2].values[1], "");
  assert.deepEqual(labels(losses(paper, "si")), ["Pipe in guide"]);
  assert.deepEqual(facts(paper, "si"), []);
});

test("a drive at its torque limit is shown, one below it is not", () => {
  const shown = (share: number) => facts(transfer({ drive_at_limit: share }), "si").map((row) => row.values[0]);
  assert.deepEqual(
    [shown(0.4), shown(1), shown(0), shown(NaN)],
    [["40.0 % of the time"], ["100.0 % of the time"], [], []],
  );
});

test("a weight of nothing has no share, whatever the bit has", () => {
  const off = transfer({ surface_weight: 20, bit_weight: 0, surface_torque: 0.2, bit_torque: 0 });
  assert.deepEqual(labels(places(off, "si")), ["Surface", "Bit"]);
});

test("powers have their share of what is put in; what is zero is left out", () => {
  const { putIn, taken } = powers(
    transfer({
      drive_power: 700,
      hoist_power: 6.5,
      feed_power: -6.5,
      load_power: 0,
      bit_power: 350,
      string_power: 0.1,
    }),
  );
  assert.deepEqual(labels(putIn), ["Top drive", "Hoist", "Advance against the wall"]);
  assert.deepEqual(taken, [
    { label: "Rock", values: ["350 W", "50.0 %"] },
    { label: "String", values: ["0.1 W", "< 0.1 %"] },
  ]);
  assert.deepEqual(
    [percent(0), percent(-1e-4), percent(0.99999), percent(1), percent(NaN)],
    ["0.0 %", "> -0.1 %", "> 99.9 %", "100.0 %", ""],
  );
  // Divided by next to nothing.
  assert.deepEqual([percent(46045680857641666), percent(-11), percent(10)], ["> 1000 %", "< -1000 %", "1000.0 %"]);
});

test("optional inputs appear where the twin lists them, with what is assumed", () => {
  const status = {
    input_name: ["rotary_speed", "weight_on_bit", "rate_of_penetration", "standpipe_pressure"],
    input_state: [1, 1, 5, 1],
    input_age: [0.1, 0.1, NaN, 0.5],
    input_suspect: [],
    input_applied: [4, 1e4, 3 / 3600, 5e6],
  } as unknown as TwinStatus;
  assert.deepEqual(optionalInputs(status, 0.5, "si"), [
    { label: "Rate of penetration", values: ["3.0 m/h", "assumed"] },
    { label: "Standpipe pressure", values: ["5.00 MPa", "good, age 1.0 s"] },
  ]);
  const bare = { ...status, input_name: ["rotary_speed", "weight_on_bit"] };
  assert.deepEqual(optionalInputs(bare, 0, "si"), []);
});
