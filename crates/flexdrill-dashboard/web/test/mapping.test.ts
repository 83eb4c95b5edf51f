// What a bridge makes of a rig's line: rows, the doubt in words, and how it can be confirmed.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Mapping } from "../src/api";
import { row, said, way } from "../src/views/mapping";

const mapping = (more: Partial<Mapping> = {}): Mapping => ({
  node: "/flexdrill_bridge_wits",
  source: "10.0.0.7",
  address: "10.0.0.7:4000",
  mapping: "0123456789abcdef",
  file: "site.yaml",
  confirmed: "",
  can_confirm: true,
  not_shown: "",
  items: [],
  ...more,
});

test("a row has item, quantity and the value as sent and as used; foreign text cannot act", () => {
  const read = { item: "0116", quantity: "weight_on_bit", sent: "0.81 kdaN", used: "8.1 kN" };
  assert.deepEqual(row(read), ["0116", "weight on bit", "0.81 kdaN", "8.1 kN"]);
  const unread = { item: "0144", quantity: "", sent: "\u202e1180", used: "" };
  assert.deepEqual(row(unread), ["0144", "not read", "\\u{202e}1180", ""]);
});

test("a mapping that no person has confirmed is named SUSPECT", () => {
  assert.match(said(mapping()), /^SUSPECT: .*10\.0\.0\.7:4000 by site\.yaml/);
  assert.match(said(mapping({ file: "default" })), /the default mapping/);
  const confirmed = mapping({ confirmed: "2026-11-28 19:00:00 UTC by ann" });
  assert.equal(said(confirmed), "10.0.0.7:4000 by site.yaml: confirmed 2026-11-28 19:00:00 UTC by ann.");
});

test("where the button cannot confirm, the page says what does", () => {
  assert.equal(way(mapping(), true), "");
  assert.match(way(mapping({ can_confirm: false }), true), /usual name/);
  assert.match(way(mapping({ can_confirm: false }), false), /--allow-control/);
  assert.equal(way(mapping({ can_confirm: false, confirmed: "now" }), false), "");
});
