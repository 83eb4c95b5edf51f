// Motion from before the last minute: asked for once, one question at a time, and said where there is none.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Orbit } from "../src/api";
import { PastMotion } from "../src/store/motion";

const orbit = (from: number): Orbit => ({
  from_ns: `${from}000000000`,
  times_s: [0, 0.04],
  y_m: [0.001, 0.002],
  z_m: [0, -0.001],
});

test("motion is asked for once a window, and has the rig's time", async () => {
  const asked: [number, number][] = [];
  const past = new PastMotion(async (joint, time) => {
    asked.push([joint, time]);
    return orbit(107);
  });
  assert.equal(past.at(3, 104), undefined);
  assert.equal(past.at(3, 105), undefined);
  await Promise.resolve();
  const motion = past.at(3, 108);
  assert.deepEqual(motion, { times: [107, 107.04], y: [0.001, 0.002], z: [0, -0.001] });
  assert.deepEqual(asked, [[3, 104]]);
});

test("who drags fast asks one question at a time, and hears of the last one", async () => {
  const waiting: ((orbit: Orbit | null) => void)[] = [];
  const past = new PastMotion(() => new Promise((answer) => waiting.push(answer)));
  for (const time of [100, 200, 300]) assert.equal(past.at(0, time), undefined);
  assert.equal(waiting.length, 1);
  waiting[0](orbit(107));
  await Promise.resolve();
  assert.equal(past.at(0, 300), undefined);
  waiting[1](null);
  await Promise.resolve();
  assert.equal(past.at(0, 300), null);
});
