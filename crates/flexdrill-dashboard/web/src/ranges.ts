// Ranges of figures over plausible tools, in words.

import type { Store } from "./store/store";

/** What a range is, where the page has room to say it. */
export const RANGE_HINT = "range of plausible tools, 5 to 95 %, wider by the factor of ensemble.band_factors";

/** The range of a figure at the shown time; empty where it has no band. */
export function rangeOf(store: Store, name: string, digits: (value: number) => string): string {
  const range = store.bands.range(name, store.shown);
  return range ? `(${digits(range.low)} to ${digits(range.high)})` : "";
}
