// The server's hour before what the page has heard itself.

import type { History } from "../api";
import type { Layout } from "./layout";
import { Ring } from "./ring";

/**
 * A ring of the server's seconds, as far as they are older than `own`, and then those of `own`. Columns are found by
 * their names; what the server does not have is NaN.
 */
export function merged(history: History, layout: Layout, own: Ring | null, capacity: number): Ring {
  const { head, values } = history;
  const base = Number(BigInt(head.base_ns)) / 1e9;
  const before = own && own.length > 0 ? own.time(0) - 0.5 : Infinity;
  const timeColumn = head.columns.find(({ name }) => name === "time")?.offset ?? 0;
  const ring = new Ring(capacity, layout.stride);
  for (let frame = 0; frame < head.count; frame++) {
    const from = frame * head.stride;
    const time = base + values[from + timeColumn];
    if (!Number.isFinite(time) || time >= before) continue;
    const row = ring.push(time).fill(NaN);
    for (const { name, offset, length } of head.columns) {
      const ours = layout.find(name);
      if (ours?.length === length) row.set(values.subarray(from + offset, from + offset + length), ours.offset);
    }
  }
  for (let index = 0; own && index < own.length; index++) ring.push(own.time(index)).set(own.row(index));
  return ring;
}
