// What the page keeps: seconds, the hour, the past, and what it forgets.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { History } from "../src/api";
import type { Session } from "../src/api";
import { Alarm, type AlarmList, type Header, type TwinStatus } from "../src/messages";
import { AlarmBook } from "../src/store/alarms";
import { Store } from "../src/store/store";
import { doubt } from "../src/words";

const STATIONS = 4;
const JOINTS = 2;

function header(time: number): Header {
  const sec = Math.floor(time);
  return { stamp: { sec, nanosec: Math.round((time - sec) * 1e9) }, frame_id: "tool" };
}

const range = (count: number, value: (index: number) => number) =>
  Float64Array.from({ length: count }, (_, i) => value(i));

/** One of each message of a small tool in a quarter circle, at `time`, with forces of `force`. */
function hear(store: Store, time: number, force: number, stations = STATIONS): void {
  const angle = (station: number) => (station * Math.PI) / 2 / (stations - 1);
  const zero = new Float64Array(stations);
  store.accept("twin/contact_forces", {
    header: header(time),
    max_pipe_guide_force: force,
    max_guide_wall_force: force / 2,
    shock_severity: 0,
    measured_depth: range(stations, (i) => i),
    inclination: range(stations, angle),
    state: new Uint8Array(stations),
    pipe_guide_normal_peak: range(stations, (i) => force * i),
    guide_wall_normal_peak: zero,
  });
  store.accept("twin/joint_deflections", {
    header: header(time),
    max_bend_angle: 0.1,
    joints_at_limit: 1,
    measured_depth: range(JOINTS, (i) => i + 1),
    bend_angle: range(JOINTS, () => 0.1),
    limit_angle: range(JOINTS, () => 0.1),
    stop_moment: range(JOINTS, () => 5),
    lateral_y: range(JOINTS, () => 0.001),
    lateral_z: range(JOINTS, () => 0.002),
  });
  store.accept("twin/whirl", {
    header: header(time),
    measured_depth: range(JOINTS, (i) => i + 1),
    body: new Uint8Array(JOINTS),
    kind: new Uint8Array(JOINTS),
    severity: new Uint8Array(JOINTS),
    whirl_ratio: new Float64Array(JOINTS),
    clearance_ratio: new Float64Array(JOINTS),
    contact_duty: new Float64Array(JOINTS),
  });
  // The pipe is drawn ten times as far from the axis as it is: 1 mm to the side and 2 mm to the low side.
  const bore = Array.from({ length: stations }, (_, i) => ({ x: i, y: 0, z: 2 * i }));
  const moved = bore.map((point, i) => ({
    x: point.x - 0.02 * Math.cos(angle(i)),
    y: point.y + 0.01,
    z: point.z + 0.02 * Math.sin(angle(i)),
  }));
  const marker = (ns: string, points: { x: number; y: number; z: number }[]) => ({ header: header(time), ns, points });
  store.accept("twin/tool_shape", {
    markers: [marker("bore", bore), marker("flexible_pipe", moved), marker("guide_pipe", bore)],
  });
  store.accept("twin/bit_state", {
    header: header(time),
    rotary_speed: force,
    torque: 10,
    stick_slip_index: 0.1,
    stick_slip_severity: 0,
  });
}

function drill(store: Store, from: number, to: number, force = (time: number) => time): void {
  for (let time = from; time < to - 1e-9; time += 0.25) hear(store, time, force(time));
}

test("a second keeps its largest force, its mean speed and its newest shape", () => {
  const store = new Store();
  assert.equal(store.moment(), null);
  drill(store, 100, 103.1);
  assert.equal(store.hour.length, 3);
  const layout = store.layout;
  assert.ok(layout);
  const row = store.hour.row(1);
  assert.equal(layout.scalar(row, "max_pipe_guide_force"), 101.75);
  // Of 101, 101.25, 101.5 and 101.75.
  assert.equal(layout.scalar(row, "bit_speed_mean"), 101.375);
  assert.equal(layout.scalar(row, "bit_speed_min"), 101);
  assert.equal(layout.vector(row, "pipe_guide_normal_peak")[3], 3 * 101.75);
  for (let station = 0; station < STATIONS; station++) {
    assert.ok(Math.abs(layout.vector(row, "pipe_y")[station] - 0.001) < 1e-7);
    assert.ok(Math.abs(layout.vector(row, "pipe_z")[station] - 0.002) < 1e-7);
    assert.equal(layout.vector(row, "guide_y")[station], 0);
  }
});

test("what is shown as the newest keeps a peak for at least a second, and no longer than two", () => {
  const store = new Store();
  const force = (store: Store) => {
    const moment = store.moment();
    assert.ok(moment);
    return moment.layout.scalar(moment.row, "max_pipe_guide_force");
  };
  drill(store, 100, 101);
  hear(store, 101.1, 900);
  assert.equal(force(store), 900);
  drill(store, 101.25, 102.9, () => 1);
  assert.equal(force(store), 900);
  drill(store, 103, 103.5, () => 1);
  assert.equal(force(store), 1);
});

test("looking back shows the hour as it was; near the end it is live again", () => {
  const store = new Store();
  drill(store, 1000, 1060);
  store.lookAt(1030.4);
  const past = store.moment();
  assert.ok(past && !past.live);
  assert.equal(past.time, 1030);
  assert.equal(past.layout.scalar(past.row, "max_pipe_guide_force"), 1029.75);
  drill(store, 1060, 1062);
  assert.equal(store.moment()?.time, 1030);
  store.lookAt(5000);
  assert.equal(store.cursor, null);
  assert.ok(store.moment()?.live);
});

test("a twin that was away leaves a gap; a clock that was set back begins anew", () => {
  const store = new Store();
  drill(store, 100, 105.1);
  drill(store, 120, 122.1);
  const layout = store.layout;
  assert.ok(layout);
  const gap = store.hour.before(119);
  assert.ok(Number.isNaN(layout.scalar(store.hour.row(gap), "max_pipe_guide_force")));
  const before = store.hour.length;
  assert.ok(before >= 7);
  // A topic that comes late is none.
  hear(store, 119, 1);
  assert.equal(store.hour.length, before);
  drill(store, 50, 51.1);
  assert.equal(store.hour.length, 1);
  assert.equal(store.now, 51);
});

test("topics that come a minute after another do not begin the hour anew", () => {
  const store = new Store();
  drill(store, 100, 105.1);
  const status = (time: number) => ({ header: header(time), input_name: [] as string[] }) as unknown as TwinStatus;
  for (let time = 105; time <= 165; time++) store.accept("twin/status", status(time));
  const before = store.hour.length;
  drill(store, 105.25, 110);
  assert.equal(store.hour.length, before);
  assert.equal(store.now, 165);
  store.accept("twin/status", status(150));
  assert.equal(store.hour.length, 0);
});

test("a recording that is brought elsewhere shows that time, and forgets the motion of the one before", () => {
  const store = new Store();
  store.session = { mode: "bag" } as Session;
  drill(store, 100, 110);
  // All but the first, which came before the tool was known.
  assert.equal(store.joints.length, 40 - 1);
  for (const there of [103, 150]) {
    hear(store, there, 1);
    assert.equal(store.now, there);
    assert.equal(store.joints.length, 1);
  }
  // Its hour is the server's.
  assert.equal(store.hour.length, 0);
});

test("what was on its way when a recording was brought elsewhere is not shown", () => {
  const store = new Store();
  store.session = { mode: "bag" } as Session;
  store.takePlayback({ playing: false, ended: false, time: 100_000_000_000n, speed: 1, reported: true });
  // Bytes that are no message: those that are looked at are counted.
  const none = new DataView(new ArrayBuffer(3));
  for (const [time, looked] of [
    [100, 1],
    [98, 2],
    [90, 2],
    [104, 2],
  ] as const) {
    store.take("twin/status", "flexdrill/msg/TwinStatus", BigInt(time) * 1_000_000_000n, none);
    assert.equal(store.unreadable, looked, `${time} s`);
  }
  store.take("twin/alarms", "flexdrill/msg/AlarmList", 1n, none);
  assert.equal(store.unreadable, 3);
});

test("another tool is another layout", () => {
  const store = new Store();
  drill(store, 100, 102);
  hear(store, 102, 1, STATIONS + 3);
  hear(store, 102.1, 1, STATIONS + 3);
  assert.equal(store.layout?.counts.stations, STATIONS + 3);
  assert.equal(store.hour.length, 0);
});

test("the server's hour goes before what was heard here, column by column", () => {
  const store = new Store();
  drill(store, 1000, 1005.1);
  const history: History = {
    head: {
      base_ns: "990000000000",
      period_s: 1,
      count: 15,
      stride: 4,
      columns: [
        { name: "max_pipe_guide_force", unit: "N", offset: 1, length: 1 },
        { name: "time", unit: "s", offset: 0, length: 1 },
        { name: "pipe_y", unit: "m", offset: 2, length: 99 },
        { name: "a_newer_column", unit: "", offset: 3, length: 1 },
      ],
    },
    values: Float32Array.from({ length: 60 }, (_, index) => (index % 4 === 0 ? index / 4 : 7)),
  };
  store.takeHistory(history);
  // 990 to 1000 of the server, and of the page's own seconds 1001 to 1005.
  const times = Array.from({ length: store.hour.length }, (_, index) => store.hour.time(index));
  assert.deepEqual(times, [990, 991, 992, 993, 994, 995, 996, 997, 998, 999, 1000, 1001, 1002, 1003, 1004, 1005]);
  const layout = store.layout;
  assert.ok(layout);
  assert.equal(layout.scalar(store.hour.row(0), "max_pipe_guide_force"), 7);
  // A column of another length is of another tool.
  assert.ok(Number.isNaN(layout.vector(store.hour.row(0), "pipe_y")[0]));
});

test("the server's hour fills what the page was away for; what nobody heard stays a gap", () => {
  const store = new Store();
  drill(store, 1000, 1003.1);
  drill(store, 1020, 1023.1);
  const layout = store.layout;
  assert.ok(layout);
  const seconds = [1001, 1002.2, 1003.2, 1004.2, 1005.2, 1012.2, 1013.2, 1021.2];
  store.takeHistory({
    head: {
      base_ns: "1000000000000",
      period_s: 1,
      count: seconds.length,
      stride: 2,
      columns: [
        { name: "time", unit: "s", offset: 0, length: 1 },
        { name: "max_pipe_guide_force", unit: "N", offset: 1, length: 1 },
      ],
    },
    values: Float32Array.from(seconds.flatMap((time) => [time - 1000, 7])),
  });
  const rows = Array.from({ length: store.hour.length }, (_, index) => {
    const value = layout.scalar(store.hour.row(index), "max_pipe_guide_force");
    return [Math.round(10 * store.hour.time(index)) / 10, Number.isNaN(value) ? "gap" : value === 7 ? "server" : "own"];
  });
  assert.deepEqual(rows, [
    [1001, "own"],
    [1002, "own"],
    [1003, "own"],
    // What was heard of the second that broke off.
    [1004, "own"],
    [1005.2, "server"],
    [1006.2, "gap"],
    [1012.2, "server"],
    [1013.2, "server"],
    [1014.2, "gap"],
    [1021, "own"],
    [1022, "own"],
    [1023, "own"],
  ]);
});

test("of alarm lists the highest sequence holds, and the past has those of its time", () => {
  const store = new Store();
  drill(store, 100, 130);
  const list = (sequence: number, time: number): AlarmList => ({
    header: header(time),
    sequence,
    alarms: [],
    unacknowledged: sequence,
    annunciations_last_ten_minutes: 0,
    flood: false,
    annunciations_per_hour: 0,
    flood_share: 0,
  });
  store.accept("twin/alarms", list(5, 110));
  store.accept("twin/alarms", list(3, 105));
  assert.equal(store.alarms?.sequence, 5);
  store.accept("twin/alarms", list(6, 120));
  store.lookAt(115);
  assert.equal(store.alarmsShown()?.sequence, 5);
  store.lookAt(105);
  assert.equal(store.alarmsShown(), null);
  store.lookAt(null);
  assert.equal(store.alarmsShown()?.sequence, 6);
});

test("a list keeps the alarms of the one before that did not change, and nothing of those that did", () => {
  const book = new AlarmBook();
  const alarm = (id: string, value: number): AlarmList["alarms"][number] =>
    ({ id, value, evidence: `${id} is seen`, since: { sec: 7, nanosec: 0 } }) as AlarmList["alarms"][number];
  const list = (sequence: number, alarms: AlarmList["alarms"]): AlarmList =>
    ({ header: header(100 + sequence), sequence, alarms }) as AlarmList;
  book.take(list(1, [alarm("shock", NaN), alarm("pace", 1)]), false);
  const first = book.newest?.alarms ?? [];
  book.take(list(2, [alarm("pace", 2), alarm("shock", NaN), alarm("new", 3)]), false);
  assert.equal(book.newest?.alarms[1], first[0]);
  assert.deepEqual(book.newest?.alarms[0], alarm("pace", 2));
  assert.deepEqual(book.newest?.alarms[2], alarm("new", 3));
  assert.equal(first[1].value, 1);
  assert.equal(book.at(101.5)?.alarms[1].value, 1);
});

test("events of the journal come once, whether heard or asked for", () => {
  const store = new Store();
  const event = (sequence: number) => ({
    header: header(100 + sequence),
    sequence,
    id: "shock",
    name: "shock",
    change: 0,
    operator_name: "",
    reason: "",
    evidence: "",
  });
  for (const sequence of [7, 8, 8]) store.accept("twin/alarm_events", event(sequence));
  const asked = [5, 6, 7].map((sequence) => ({
    stamp_ns: `${100 + sequence}000000000`,
    sequence,
    id: "shock",
    name: "shock",
    change: 0,
    priority: Alarm.LOW,
    annunciates: true,
    operator_name: "",
    reason: "",
    evidence: "",
  }));
  store.takeJournal(asked);
  assert.deepEqual(
    store.journal.map(({ sequence }) => sequence),
    [5, 6, 7, 8],
  );
});

test("an entry of another program does not turn the direction of what is around it", () => {
  const store = new Store();
  const entry = {
    stamp_ns: "1",
    sequence: 1,
    id: "shock",
    name: "shock\u202e",
    change: 0,
    priority: Alarm.LOW,
    annunciates: true,
    operator_name: "\u2067ann\u0007",
    reason: "",
    evidence: "",
  };
  store.takeJournal([entry]);
  assert.deepEqual(
    store.journal.map(({ name, operator_name }) => [name, operator_name]),
    [["shock\\u{202e}", "\\u{2067}ann\\u{7}"]],
  );
});

test("an input that its source doubts says so", () => {
  const status = { input_suspect: [false, true] } as unknown as TwinStatus;
  assert.deepEqual(
    [0, 1, 2].map((input) => doubt(status, input).level),
    [0, 1, 0],
  );
  assert.match(doubt(status, 1).text, /SUSPECT/);
  assert.equal(doubt(null, 0).text, "");
});

test("a twin is silent without a connection or a heartbeat, a recording never is", () => {
  const store = new Store();
  assert.ok(store.silent);
  store.setConnected(true);
  assert.ok(store.silent);
  store.accept("twin/status", { header: header(100), input_name: [] as string[] } as unknown as TwinStatus);
  assert.ok(!store.silent);
  store.setConnected(false);
  assert.ok(store.silent);
  store.session = { mode: "bag" } as Session;
  assert.ok(!store.silent);
});

test("bytes that are no message are counted and change nothing", () => {
  const store = new Store();
  store.take(
    "twin/status",
    "flexdrill/msg/TwinStatus",
    0n,
    new DataView(new Uint8Array([0, 1, 0, 0, 1, 2, 3, 4, 5, 6]).buffer),
  );
  store.take("twin/status", "other/msg/Type", 0n, new DataView(new ArrayBuffer(8)));
  assert.equal(store.unreadable, 1);
  assert.equal(store.status, null);
});

test("optional inputs of the status do not stand in the place of the weight", () => {
  const store = new Store();
  hear(store, 10, 1);
  const status = {
    header: header(10.1),
    state: 1,
    real_time_factor: 1,
    model_quality: 0,
    input_name: ["rotary_speed", "weight_on_bit", "rate_of_penetration", "standpipe_pressure"],
    input_state: [1, 1, 5, 5],
    input_received: [4.2, 9.9e3, NaN, NaN],
    input_applied: [4.1, 1e4, 0, 0],
  };
  store.accept("twin/status", status as unknown as TwinStatus);
  const moment = store.moment();
  assert.ok(moment);
  const shown = (name: "weight_on_bit_applied" | "weight_on_bit_received" | "weight_on_bit_state") =>
    moment.layout.scalar(moment.row, name);
  assert.ok(Math.abs(shown("weight_on_bit_applied") - 1e4) < 1);
  assert.ok(Math.abs(shown("weight_on_bit_received") - 9.9e3) < 1);
  assert.equal(shown("weight_on_bit_state"), 1);
});
