// Units of the page that need no browser: decoders against bytes of the twin's own encoder, spectrum, rings, units,
// configuration, colours, history.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { parseHistory } from "../src/api";
import { CdrReader } from "../src/cdr";
import { configured } from "../src/configuration";
import { DECODERS } from "../src/messages";
import { fullSpectrum } from "../src/spectrum";
import { Layout } from "../src/store/layout";
import { Ring } from "../src/store/ring";
import { roundUp } from "../src/ticks";
import { contrast, PALETTES } from "../src/theme";
import { bounds, convert, counted, digits, lapse, number, withUnit } from "../src/units";
import { Camera, project } from "../src/scene/matrix";

interface Reference {
  schema: keyof typeof DECODERS;
  bytes: string;
  message: unknown;
}

const references = JSON.parse(readFileSync("test/reference.json", "utf8")) as Reference[];

function view(hex: string): DataView {
  // Behind something else, as in a frame of the connection, so that alignment is that of the message.
  const bytes = Buffer.concat([Buffer.alloc(13), Buffer.from(hex, "hex")]);
  const copy = new Uint8Array(bytes);
  return new DataView(copy.buffer, 13);
}

/** Typed arrays as lists and numbers that JSON does not know as null, as the reference has them. */
function plain(value: unknown): unknown {
  if (ArrayBuffer.isView(value)) return Array.from(value as unknown as ArrayLike<number>, plain);
  if (Array.isArray(value)) return value.map(plain);
  if (typeof value === "number") return Number.isFinite(value) ? value : null;
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([name, inner]) => [name, plain(inner)]));
}

test("every reference message is decoded as the twin encoded it", () => {
  assert.deepEqual(new Set(references.map(({ schema }) => schema)), new Set(Object.keys(DECODERS)));
  for (const { schema, bytes, message } of references) {
    assert.deepEqual(plain(DECODERS[schema](new CdrReader(view(bytes)))), message, schema);
  }
});

test("a message of an older version, without its last fields, has zeros there", () => {
  const reference = references.find(({ schema }) => schema === "flexdrill/msg/TwinStatus");
  assert.ok(reference);
  // Its last fields are a number of eight bytes, a list of texts (its length, and each text with its length and its end), and
  // three counts of eight bytes.
  const whole = DECODERS["flexdrill/msg/TwinStatus"](new CdrReader(view(reference.bytes)));
  const list = whole.changed_parameter.reduce(
    (end, text) => 4 * Math.ceil(end / 4) + 4 + Buffer.byteLength(text) + 1,
    4,
  );
  const cut = reference.bytes.slice(0, -2 * (8 + 8 * Math.ceil(list / 8) + 24));
  const status = DECODERS["flexdrill/msg/TwinStatus"](new CdrReader(view(cut)));
  assert.deepEqual(status.changed_parameter, []);
  assert.equal(status.steps_stood_still, 0);
  assert.equal(status.surveys_waiting, 0);
  assert.ok(status.sequence > 0 && status.pace_factor !== 0);
});

test("bytes that end within a field are refused, whatever the length", () => {
  for (const { schema, bytes } of references) {
    for (let length = 0; length < bytes.length / 2; length += 7) {
      const cut = view(bytes.slice(0, 2 * length));
      try {
        DECODERS[schema](new CdrReader(cut));
      } catch (error) {
        assert.ok(error instanceof Error && !(error instanceof TypeError), `${schema} cut to ${length}: ${error}`);
      }
    }
  }
  assert.throws(() => new CdrReader(view("00000000")), /little endian/);
  // A sequence that claims to be longer than its message.
  assert.throws(() => DECODERS["flexdrill/msg/AlarmList"](new CdrReader(view("00010000" + "ff".repeat(40)))));
});

test("a circle has one line, forward at positive frequencies", () => {
  const rate = 50;
  const radius = 0.004;
  for (const sense of [1, -1]) {
    const line = (8 * rate) / 512;
    const angle = (index: number) => (2 * Math.PI * sense * line * index) / rate;
    const y = Float64Array.from({ length: 512 }, (_, index) => 0.002 + radius * Math.cos(angle(index)));
    const z = Float64Array.from({ length: 512 }, (_, index) => radius * Math.sin(angle(index)));
    const found = fullSpectrum(y, z, rate);
    assert.ok(found);
    const highest = found.amplitude.indexOf(Math.max(...found.amplitude));
    assert.equal(found.frequency[highest], sense * line);
    // An exact line of the window gives its radius, less what rounding takes.
    assert.ok(Math.abs(found.amplitude[highest] - radius) < 1e-12);
  }
  assert.equal(fullSpectrum([1, 2], [1, 2], 50), null);
});

test("a ring keeps the newest rows and finds them by time", () => {
  const ring = new Ring(4, 2);
  assert.equal(ring.before(1), -1);
  for (let time = 1; time <= 6; time++) ring.push(time).set([time, 10 * time]);
  assert.equal(ring.length, 4);
  assert.deepEqual([ring.time(0), ring.time(3)], [3, 6]);
  assert.deepEqual([...ring.row(1)], [4, 40]);
  assert.equal(ring.value(3, 1), 60);
  assert.deepEqual([ring.before(2.9), ring.before(3), ring.before(4.5), ring.before(99)], [-1, 0, 1, 3]);
});

test("a layout has every column once, end to end", () => {
  const layout = new Layout({ stations: 5, joints: 3, watched: 4 });
  const row = Float32Array.from({ length: layout.stride }, (_, index) => index);
  assert.equal(layout.scalar(row, "time"), 0);
  assert.equal(layout.vector(row, "pipe_y").length, 5);
  assert.equal(layout.vector(row, "joint_bend_angle").length, 3);
  const last = layout.vector(row, "contact_duty");
  assert.equal(last[last.length - 1], layout.stride - 1);
});

test("units", () => {
  assert.equal(withUnit(4.2, "speed", "si"), "40.1 r/min");
  assert.equal(withUnit(10e3, "weight", "si"), "10.0 kN");
  // 10 kN are 2.2481 klbf; 92.4 N m are 68.15 ft lbf; 3.2 m are 10.50 ft.
  assert.equal(withUnit(10e3, "weight", "field"), "2.25 klbf");
  assert.ok(Math.abs(convert(92.4, "torque", "field") - 68.1507) < 1e-3);
  assert.equal(digits(3.2, "depth", "field"), "10.50");
  assert.equal(number(-0.001, 1), "0.0");
  assert.equal(number(NaN, 1), "–");
  assert.equal(lapse(2.34), "2.3 s");
  assert.equal(lapse(3725), "62 min 05 s");
});

test("numbers of the configuration by their path", () => {
  const yaml = [
    "other:",
    "  levels:",
    "    watch: 9",
    "inputs:",
    "  rotary_speed:",
    "    max_rpm: 120.0",
    "  weight_on_bit:",
    "    max_kn: 60.0",
    "stick_slip:",
    "  levels:",
    "    watch: 0.5",
    "    warning: 8.0e-1",
    "  title: words",
  ].join("\n");
  assert.equal(configured(yaml, "inputs.rotary_speed.max_rpm"), 120);
  assert.equal(configured(yaml, "inputs.weight_on_bit.max_kn"), 60);
  assert.equal(configured(yaml, "stick_slip.levels.warning"), 0.8);
  for (const path of ["inputs.max_rpm", "stick_slip.title", "levels.watch", "inputs.weight_on_bit.max_rpm", ""]) {
    assert.ok(Number.isNaN(configured(yaml, path)), path);
  }
});

test("text has at least the contrast of WCAG AA on what it stands on", () => {
  assert.ok(Math.abs(contrast("#000000", "#ffffff") - 21) < 1e-9);
  for (const [name, p] of Object.entries(PALETTES)) {
    const pairs: [string, string][] = [
      [p.highInk, p.high],
      [p.mediumInk, p.medium],
      [p.lowInk, p.low],
      [p.buttonInk, p.button],
      [p.ground, p.ink],
    ];
    for (const ground of [p.ground, p.panel, p.well]) pairs.push([p.ink, ground], [p.muted, ground]);
    for (const [ink, ground] of pairs) {
      assert.ok(contrast(ink, ground) >= 4.5, `${name}: ${ink} on ${ground} has ${contrast(ink, ground).toFixed(2)}`);
    }
    // Traces, limits and marks are graphics: 3 to 1.
    for (const mark of [p.trace, p.limit, p.mark]) {
      for (const ground of [p.panel, p.well]) assert.ok(contrast(mark, ground) >= 3, `${name}: ${mark} on ${ground}`);
    }
  }
});

test("bounds of a set point are in the display's unit and digits, and are themselves accepted", () => {
  const weight = { min: 0, max: 60 };
  assert.equal(bounds({ min: 0, max: 120 }, "speed", "si"), "0 to 120 r/min");
  assert.equal(bounds(weight, "weight", "si"), "0 to 60 kN");
  assert.equal(bounds(weight, "weight", "field"), "0 to 13.48 klbf");
  assert.equal(bounds({ min: 0.1 + 0.2, max: 100 / 3 }, "weight", "si"), "0.3 to 33.3 kN");
  const [, most] = /to ([0-9.]+)/.exec(bounds(weight, "weight", "field")) ?? [];
  assert.ok(Number(most) / convert(1e3, "weight", "field") <= weight.max);
});

test("a count of one is in the singular", () => {
  assert.deepEqual([counted(0, "run"), counted(1, "run"), counted(2, "run")], ["0 runs", "1 run", "2 runs"]);
  // No text of a view writes a plural behind a number that may be one.
  const plural =
    /\$\{[^{}]*\} (alarms|runs|members|joints|stations|samples|messages|cells|candidates|minutes|points|times)\b/;
  for (const file of readdirSync("src/views")) {
    const text = readFileSync(`src/views/${file}`, "utf8");
    assert.doesNotMatch(text, plural, file);
  }
});

test("the server's hour is taken apart, and nothing else is taken for one", () => {
  const head = {
    base_ns: "1700000000000000000",
    period_s: 1,
    count: 2,
    stride: 3,
    columns: [{ name: "time", unit: "s", offset: 0, length: 1 }],
  };
  let json = JSON.stringify(head);
  while ((4 + json.length) % 8 !== 0) json += " ";
  const bytes = new ArrayBuffer(4 + json.length + 24);
  new DataView(bytes).setUint32(0, json.length, true);
  new Uint8Array(bytes, 4).set(new TextEncoder().encode(json));
  new Float32Array(bytes, 4 + json.length).set([0, 1, 2, 1, 3, 4]);
  const history = parseHistory(bytes);
  assert.ok(history);
  assert.deepEqual(history.head, head);
  assert.deepEqual([...history.values], [0, 1, 2, 1, 3, 4]);
  assert.equal(parseHistory(bytes.slice(0, bytes.byteLength - 4)), null);
  assert.equal(parseHistory(new ArrayBuffer(2)), null);
});

test("scales are of 1, 2 and 5", () => {
  assert.deepEqual([0, 1, 1.1, 2, 3, 7, 1200].map(roundUp), [1, 1, 2, 2, 5, 10, 2000]);
});

test("the camera shows the build to the right and depth downwards", () => {
  const camera = new Camera();
  camera.frame(new Float32Array([0, 0, 0, 3.2, 0, 3.2]), 1.5);
  const matrix = camera.matrix(1.5);
  const top = project(matrix, [0, 0, 0], 600, 400);
  const bit = project(matrix, [3.2, 0, 3.2], 600, 400);
  assert.ok(top && bit);
  assert.ok(bit[0] > top[0] && bit[1] > top[1]);
  for (const [x, y] of [top, bit]) assert.ok(x > 0 && x < 600 && y > 0 && y < 400);
});
