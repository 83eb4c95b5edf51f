// What an operator reads: the state, whose alarm it is, one colour for one alarm, the words.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { endedAt, isOfSystem, levelOf, standing, worstAt } from "../src/alarms";
import type { History, Pulse, Session } from "../src/api";
import { judge } from "../src/binding";
import { Alarm, type AlarmList, TwinStatus } from "../src/messages";
import { Store } from "../src/store/store";
import { stateNow } from "../src/views/state";
import { publisher } from "../src/words";

const header = (sec: number) => ({ stamp: { sec, nanosec: 0 }, frame_id: "" });

function alarm(id: string, priority: number, state: number = Alarm.ACTIVE_UNACKNOWLEDGED): Alarm {
  const texts = { name: id, evidence: "seen", cause: "", consequence: "", what_to_do: `act on ${id}`, unit: "" };
  const none = { sec: 0, nanosec: 0 };
  const times = {
    since: none,
    worst_at: none,
    ended_at: none,
    less_severe_since: none,
    ended: false,
    what_the_engineer_can_do: "",
  };
  const place = { body: 0, measured_depth: NaN, inclination: NaN };
  return { id, priority, state, active: true, ...times, ...texts, ...place } as Alarm;
}

const list = (...alarms: Alarm[]): AlarmList =>
  ({ header: header(100), sequence: 1, alarms, unacknowledged: alarms.length }) as AlarmList;

const status = (over: Partial<TwinStatus> = {}): TwinStatus =>
  ({
    header: header(100),
    state: 1,
    model_quality: 0,
    input_name: [] as string[],
    input_applied: [4.2, 1e4],
    last_rejection_cause: "",
    ...over,
  }) as unknown as TwinStatus;

const heard = (time: number, age: number): Pulse => ({
  instance: "a",
  time_ns: "0",
  newest: { "twin/status": { time_ns: `${time}000000000`, age_s: age } },
});

/** A page that is connected to a server that hears a twin. */
function live(...alarms: Alarm[]): Store {
  const store = new Store();
  store.session = { mode: "live" } as Session;
  store.setConnected(true);
  store.accept("twin/status", status());
  store.accept("twin/alarms", list(...alarms));
  store.takePulse(heard(100, 0), performance.now());
  return store;
}

test("what keeps the page from knowing goes before every alarm", () => {
  const store = live(alarm("backward_whirl", 3));
  assert.deepEqual([stateNow(store, "si").word, store.isLive], ["ACT NOW", true]);
  store.takePulse(heard(112, 0), performance.now());
  const behind = stateNow(store, "si");
  assert.deepEqual([behind.word, behind.level, store.isLive], ["PAGE BEHIND 12 s", 4, false]);
  // The twin has gone meanwhile: that goes before the page's own trouble.
  store.takePulse(heard(112, 60), performance.now());
  assert.equal(stateNow(store, "si").word, "TWIN SILENT");
  store.setConnected(false);
  assert.equal(stateNow(store, "si").word, "NO SERVER");
});

test("a server that does not answer leaves the age of the data unknown", () => {
  const store = live();
  store.takePulse(heard(100, 0), performance.now() - 5000);
  assert.equal(stateNow(store, "si").word, "AGE UNKNOWN");
  assert.ok(!store.isLive);
});

test("a recording is never in the words or colours of the rig", () => {
  const store = live(alarm("backward_whirl", 3));
  store.session = { mode: "bag", bag: { name: "run.mcap", start_ns: "0", end_ns: "9" } } as unknown as Session;
  const state = stateNow(store, "si");
  assert.deepEqual([state.word, state.level, store.isLive], ["RECORDING", 5, false]);
  assert.match(state.sentence, /run\.mcap.*Not the rig\..*high: Backward_whirl/);
});

test("an alarm of the computer never fills the driller's line", () => {
  const store = live(alarm("real_time", 2), alarm("shock", 1));
  assert.ok(isOfSystem(alarm("real_time", 2)));
  const state = stateNow(store, "si");
  assert.deepEqual([state.word, state.sentence], ["WATCH", "Shock: act on shock"]);
  assert.ok(isOfSystem({ ...alarm("disk", 2), category: Alarm.SYSTEM }));
  assert.ok(!isOfSystem(alarm("shock", 2)));
  const { drilling, system } = standing(store.alarms?.alarms ?? []);
  assert.deepEqual([drilling.length, system.length], [1, 1]);
  assert.equal(stateNow(live(alarm("recording", 3)), "si").word, "NORMAL");
});

test("an alarm whose condition has ended says so, and since when, and calls for nothing", () => {
  const time = 1_700_000_000;
  const held = { ...alarm("backward_whirl", 3), ended: true, ended_at: { sec: time, nanosec: 0 } };
  const { word, level, sentence } = stateNow(live(held), "si");
  assert.deepEqual([word, level], ["WATCH", 1]);
  assert.match(
    sentence,
    /^No alarm stands now\. Backward_whirl, ended at \d\d:\d\d:\d\d; the twin watches whether it returns\.$/,
  );
  assert.equal(endedAt(held), time);
  assert.ok(Number.isNaN(endedAt(alarm("shock", 1))) && Number.isNaN(worstAt(alarm("shock", 1))));
});

test("no sentence for the driller names a setting of the solver", () => {
  const cause = "energy errors come to 40 % (degraded from 30 %); a smaller solver.time_step is needed";
  for (const state of [TwinStatus.RUNNING, TwinStatus.FAILED]) {
    const store = live();
    const worse = { state, model_quality: TwinStatus.QUALITY_DEGRADED, model_quality_cause: cause };
    store.accept("twin/status", status({ ...worse, header: header(101), last_rejection_cause: "not converged" }));
    const { word, sentence } = stateNow(store, "si");
    assert.notEqual(word, "NORMAL");
    assert.doesNotMatch(sentence, /solver|step|_|[Rr]eset/);
  }
});

test("what belongs to an alarm has the alarm's level", () => {
  const store = live(alarm("rotary_speed_input", 3), alarm("shock", 2, Alarm.SHELVED));
  assert.equal(levelOf(store, ["rotary_speed_input"], 2), 3);
  assert.equal(levelOf(store, ["shock"], 2), 0);
  assert.equal(levelOf(store, ["stick_slip"], 2), 0);
  assert.equal(levelOf(new Store(), ["stick_slip"], 2), 2);
});

test("a page that is opened after the twin has ended shows the server's hour", () => {
  const store = new Store();
  store.setConnected(true);
  const stations = [0, 1, 2, 3].map((depth) => ({ measured_depth: depth, inclination: 0, position: [0, 0, depth] }));
  const joints = [1, 2].map((station) => ({ measured_depth: station, inclination: 0, station }));
  store.session = { mode: "live", tool: { stations, joints, joint_limit: 0.1 } } as unknown as Session;
  const columns = [
    ["time", 1],
    ["rotary_speed_applied", 1],
    ["joint_bend_angle", 2],
    ["contact_state", 4],
    ["whirl_kind", 3],
  ] as const;
  let stride = 0;
  const placed = columns.map(([name, length]) => ({ name, unit: "", offset: (stride += length) - length, length }));
  const history: History = {
    head: {
      base_ns: "1000000000000",
      period_s: 1,
      count: 3,
      stride,
      columns: placed,
      watched_body: [0, 0, 1],
      watched_depth: [1, 2, null],
    },
    values: Float32Array.from({ length: 3 * stride }, (_, at) =>
      at % stride === 0 ? at / stride : at % stride === 1 ? 4 : 0,
    ),
  };
  store.takeHistory(history);
  const moment = store.moment();
  assert.ok(moment && !moment.live);
  assert.equal(moment.time, 1002);
  assert.equal(store.now, 1002);
  assert.equal(moment.layout.scalar(moment.row, "rotary_speed_applied"), 4);
  assert.deepEqual([...(store.geometry?.jointStation ?? [])], [1, 2]);
  assert.deepEqual([...(store.geometry?.watchedDepth ?? [])], [1, 2, NaN]);
  assert.ok(!store.isLive);
});

test("a topic that stops leaves a gap in the hour, not a level line", () => {
  const store = live();
  // The tool is known from the server; then only the status comes.
  const stations = [0, 1].map((depth) => ({ measured_depth: depth, inclination: 0, position: [0, 0, depth] }));
  store.session = { mode: "live", tool: { stations, joints: [], joint_limit: 0.1 } } as unknown as Session;
  const columns = [
    { name: "time", unit: "s", offset: 0, length: 1 },
    { name: "contact_state", unit: "", offset: 1, length: 2 },
  ];
  const head = { base_ns: "90000000000", period_s: 1, count: 1, stride: 3, columns };
  store.takeHistory({ head, values: new Float32Array(3) });
  const bit = { header: header(101), rotary_speed: 4, torque: 9, stick_slip_index: 0, stick_slip_severity: 0 };
  store.accept("twin/bit_state", bit);
  for (let time = 101; time < 106; time++) store.accept("twin/status", status({ header: header(time) }));
  const layout = store.layout;
  assert.ok(layout);
  const torque = (time: number) => layout.scalar(store.hour.row(store.hour.before(time)), "bit_torque_mean");
  assert.equal(torque(102), 9);
  assert.ok(Number.isNaN(torque(104)));
  // As the newest value it stands, with its age beside it.
  const moment = store.moment();
  assert.equal(moment && layout.scalar(moment.row, "bit_torque_mean"), 9);
});

test("a page keeps to what it was opened on", () => {
  const session = (instance: string, over: object = {}): Session =>
    ({
      version: "1",
      instance,
      mode: "live",
      namespace: "/",
      node: "/flexdrill",
      start_ns: "7",
      bag: null,
      ...over,
    }) as Session;
  const known = session("a");
  assert.equal(judge(null, session("a"), 0, true), "keep");
  assert.equal(
    judge(known, session("a", { start_ns: "8" }), 0, false),
    "keep",
    "the twin was restarted, not the server",
  );
  assert.equal(judge(known, session("b"), 0, false), "keep", "another server of the same run");
  assert.equal(judge(known, session("b", { start_ns: "8" }), 0, false), "reload", "another run");
  assert.equal(judge(known, session("b", { namespace: "/rig_8" }), 0, false), "reload", "another twin");
  assert.equal(judge(known, session("b", { version: "2" }), 0, false), "reload");
  assert.equal(
    judge(known, session("b", { mode: "bag", bag: { name: "x", start_ns: "1", end_ns: "2" } }), 0, false),
    "reload",
  );
  assert.equal(judge(known, session("b", { start_ns: null }), 1000, false), "wait");
  assert.equal(judge(known, session("b", { start_ns: null }), 6000, false), "reload");
  assert.equal(judge(session("a", { start_ns: null }), session("b"), 0, true), "keep", "nothing is shown yet");
});

test("publishers are named without the id of their writer", () => {
  assert.equal(publisher("/rig/top_drive @ rig7 (01:0f:a2:b3:c4:d5:e6:f7.00000103)"), "/rig/top_drive @ rig7");
  assert.equal(publisher("/a @ h (010fa2b3c4d5e6f700000000.00000103), /b @ h (ab0fa2b3c4d5e6f7.01)"), "/a @ h, /b @ h");
  assert.equal(
    publisher("asked by node /a at 10.0.2.7 (id 0112be9d9ce50d8027da13d900001e03)"),
    "asked by node /a at 10.0.2.7",
  );
  assert.equal(publisher("no publisher (yet)"), "no publisher (yet)");
});

test("no text of the page has the words that no driller says", () => {
  const foreign = /"Else"|root scale|In the way|◆ stop|\bnobody\b|\bsomebody\b|Say who you are|nothing to do/;
  const folder = join("src", "views");
  for (const file of readdirSync(folder)) {
    // Comments are not read by operators.
    const text = readFileSync(join(folder, file), "utf8").replace(/\/\*[^]*?\*\/|\/\/.*$/gm, "");
    assert.doesNotMatch(text, foreign, file);
  }
});
