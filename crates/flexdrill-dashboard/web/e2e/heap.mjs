// Whether the page's memory stays what it is: hours beside a rig, a location open, the twin at its full rates.
//
// `node e2e/heap.mjs --flexdrill FILE [--minutes N] [--dist FOLDER]`, in a network of its own (launch_scripts/page_test.sh --heap makes
// one). With --dist the page comes from that folder instead of out of the program. A small window: what the page keeps
// does not depend on its pixels. The last line sums up.
import assert from "node:assert/strict";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { clean, lastWords, node, option, PORT, rig, server, stopAll, until } from "./programs.mjs";

const dist = option("dist", "");
const minutes = Number(option("minutes", "60"));
/** Minutes until the rings of a minute and the browser's own tables are full. */
const WARM = 10;
/**
 * Most that script and arrays may grow after that (MB): 500 alarm lists and 2000 events of the journal, which are bounded,
 * still come in at some kB each.
 */
const MOST = 3;

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    ...(dist === "" ? [] : ["--disable-features=LocalNetworkAccessChecks"]),
  ],
});
const page = await browser.newPage({ viewport: { width: 640, height: 400 } });
if (dist !== "") {
  const pieces = { "/": "index.html", "/page.js": "page.js", "/page.css": "page.css" };
  await page.route("**/*", (route) => {
    const piece = pieces[new URL(route.request().url()).pathname];
    return piece ? route.fulfill({ path: join(dist, piece) }) : route.continue();
  });
}
const troubles = [];
page.on("pageerror", (error) => troubles.push(String(error)));

let failed = null;
const rows = [];
try {
  server();
  node();
  rig();
  await until("the server answers", 30, () => page.goto(`http://127.0.0.1:${PORT}/`).then(() => true));
  await until("the tool", 60, () => page.evaluate(() => window.flexdrill.store.layout !== null));
  await page.evaluate(() => {
    const { context, store } = window.flexdrill;
    context.choose({ joint: 0, station: store.geometry.jointStation[0] });
  });
  const tools = await page.context().newCDPSession(page);
  await tools.send("HeapProfiler.enable");
  for (let minute = 0; minute <= minutes; minute++) {
    if (minute > 0) await page.waitForTimeout(60_000);
    await tools.send("HeapProfiler.collectGarbage");
    const { usedSize, backingStorageSize } = await tools.send("Runtime.getHeapUsage");
    const { nodes } = await tools.send("Memory.getDOMCounters");
    const { seconds, journal } = await page.evaluate(() => {
      const { store } = window.flexdrill;
      return { seconds: store.hour.length, journal: store.journal.length };
    });
    rows.push({ heap: usedSize / 1e6, arrays: backingStorageSize / 1e6 });
    console.log(
      `minute ${minute}: heap ${(usedSize / 1e6).toFixed(2)} MB, arrays ${(backingStorageSize / 1e6).toFixed(2)} MB, ` +
        `${nodes} nodes, ${seconds} seconds of the hour, ${journal} events`,
    );
  }
  assert.deepEqual(troubles, [], "errors of the page");
  for (const kind of ["heap", "arrays"]) {
    const [then, ...later] = rows.slice(Math.min(WARM, rows.length - 1)).map((row) => row[kind]);
    const grown = Math.max(then, ...later.slice(-5)) - then;
    assert.ok(grown <= MOST, `${kind} grew by ${grown.toFixed(2)} MB after minute ${WARM}, more than ${MOST} MB`);
  }
} catch (error) {
  failed = error;
} finally {
  await browser.close();
  await stopAll();
}
if (failed) {
  console.log(`not ok ${failed.stack ?? failed}`);
  lastWords();
}
clean();
const of = (kind) => rows.slice(Math.min(WARM, rows.length - 1)).map((row) => row[kind]);
const span = (kind) => `${Math.min(...of(kind)).toFixed(2)} to ${Math.max(...of(kind)).toFixed(2)} MB`;
console.log(`heap: ${failed ? "FAILED, " : ""}after minute ${WARM} script ${span("heap")}, arrays ${span("arrays")}`);
process.exit(failed ? 1 : 0);
