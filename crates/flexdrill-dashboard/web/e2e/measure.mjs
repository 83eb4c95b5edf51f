// What the page costs: pictures a second while the tool turns, processor time of the browser, memory by the minute.
//
// `node e2e/measure.mjs [URL] [--minutes N] [--dist FOLDER]` against a server that runs. The processor draws everything,
// as on a machine without graphics hardware.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";

const option = (name, otherwise) => {
  const at = process.argv.indexOf(`--${name}`);
  return at < 0 ? otherwise : process.argv[at + 1];
};
const url = process.argv[2]?.startsWith("http") ? process.argv[2] : "http://127.0.0.1:8080/";
const minutes = Number(option("minutes", "5"));
const dist = option("dist", "");

const server = await chromium.launchServer({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    ...(dist === "" ? [] : ["--disable-features=LocalNetworkAccessChecks"]),
  ],
});
const browser = await chromium.connect(server.wsEndpoint());
const page = await browser.newPage({ viewport: { width: 1920, height: 1080 } });
if (dist !== "") {
  const pieces = { "/": "index.html", "/page.js": "page.js", "/page.css": "page.css" };
  await page.route("**/*", (route) => {
    const piece = pieces[new URL(route.request().url()).pathname];
    return piece ? route.fulfill({ path: join(dist, piece) }) : route.continue();
  });
}

/** Processor time of the browser and all its processes so far (ms). */
function processorTime() {
  const rows = execFileSync("ps", ["-eo", "pid,ppid"], { encoding: "utf8" }).trim().split("\n").slice(1);
  const family = new Set([server.process().pid]);
  for (let depth = 0; depth < 6; depth++) {
    for (const row of rows) {
      const [pid, parent] = row.trim().split(/\s+/).map(Number);
      if (family.has(parent)) family.add(pid);
    }
  }
  let ticks = 0;
  for (const pid of family) {
    try {
      const stat = readFileSync(`/proc/${pid}/stat`, "utf8");
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      ticks += Number(fields[11]) + Number(fields[12]);
    } catch {
      // It has ended.
    }
  }
  // A hundred ticks a second, as Linux has told programs on all its machines.
  return 10 * ticks;
}

const pictures = () => page.evaluate(() => window.flexdrill.scene.pictures);
async function cost(name, seconds) {
  const [time, drawn, used] = [Date.now(), await pictures(), processorTime()];
  await page.waitForTimeout(1e3 * seconds);
  const [lapse, count, taken] = [(Date.now() - time) / 1e3, (await pictures()) - drawn, processorTime() - used];
  const each = count > 0 ? `, ${(taken / count).toFixed(0)} ms of processor time each` : "";
  const share = ((100 * taken) / 1e3 / lapse).toFixed(0);
  console.log(`${name}: ${(count / lapse).toFixed(1)} pictures/s${each}; ${share} % of a core in all`);
}

await page.goto(url);
await page.waitForFunction(() => window.flexdrill.scene.pictures > 5, null, { timeout: 60_000 });
console.log("tool:", JSON.stringify(await page.evaluate(() => window.flexdrill.store.layout.counts)));
await page.waitForTimeout(5000);
await cost("looking on", 15);
const turning = await page.evaluateHandle(() => {
  const state = { on: true };
  const turn = () => {
    window.flexdrill.scene.turn(0.01);
    if (state.on) requestAnimationFrame(turn);
  };
  turn();
  return state;
});
await cost("turning", 15);
await turning.evaluate((state) => (state.on = false));

const tools = await page.context().newCDPSession(page);
await tools.send("HeapProfiler.enable");
for (let minute = 0; minute <= minutes; minute++) {
  if (minute > 0) await page.waitForTimeout(60_000);
  await tools.send("HeapProfiler.collectGarbage");
  const { usedSize, backingStorageSize } = await tools.send("Runtime.getHeapUsage");
  const megabytes = (bytes) => (bytes / 1e6).toFixed(1);
  console.log(`minute ${minute}: heap ${megabytes(usedSize)} MB, arrays ${megabytes(backingStorageSize)} MB`);
}
await browser.close();
await server.close();
