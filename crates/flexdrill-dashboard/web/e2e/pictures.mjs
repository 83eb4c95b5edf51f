// The pictures of the documents: a calm overview, a joint that whirls, and a rig that is read over WITS.
//
// `node e2e/pictures.mjs --flexdrill FILE --out FOLDER [--seconds N]`, in a network of its own (launch_scripts/page_test.sh
// --pictures makes one). On a machine that does not keep up with the model the pictures show that.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { clean, lastWords, option, PORT, rig, root, server, start, stop, stopAll, until, work } from "./programs.mjs";

const out = option("out", work);
/** How long the rig drills before the overview is taken (s). */
const seconds = Number(option("seconds", "240"));
const TOKEN = "a-token-of-the-pictures-0123456789";

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 1920, height: 1080 } });
const word = () => page.textContent("#state-word");
const running = () => until("a twin", 60, async () => ["NORMAL", "WATCH", "ACT SOON"].includes(await word()));
const shot = (name) => page.screenshot({ path: join(out, `${name}.png`) });

let failed = null;
try {
  const config = join(root, "config/default.yaml");
  const token = join(work, "token");
  writeFileSync(token, `${TOKEN}\n`, { mode: 0o600 });
  server("--allow-control", "--token-file", token);
  start("node", "run", "--config", config);
  rig();
  await until("the server", 30, () => page.goto(`http://127.0.0.1:${PORT}/#token=${TOKEN}`).then(() => true));
  await running();
  await page.waitForTimeout(1e3 * seconds);
  await until("no alarm", 120, async () => (await word()) === "NORMAL");
  await shot("dashboard_overview");
  await stop("rig");
  await stop("node");
  // Backward whirl needs more friction between pipe and guide than usual (docs/whirl.md).
  const whirling = join(work, "whirling.yaml");
  const text = readFileSync(config, "utf8").replace(/friction_tangential: 0\.2\b/, "friction_tangential: 0.7");
  writeFileSync(whirling, text);
  start("node", "run", "--config", whirling);
  await until("the twin", 60, async () => !["TWIN SILENT", "NO DATA", "STARTING"].includes(await word()));
  // The page reloads itself for the new run of the twin; what was typed before would be lost.
  await page.waitForTimeout(5_000);
  await page.click("#tab-steer");
  for (const [field, value] of [
    ["operator", "ann"],
    ["rpm", "120"],
    ["wob", "10"],
  ]) {
    await page.fill(`#steer-${field}`, value);
  }
  await page.click("#steer-ask");
  await page.click("#steer-ask");
  await until("whirl", 120, async () => (await word()) === "ACT NOW");
  await page.evaluate(() => {
    const { context, store } = window.flexdrill;
    context.choose({ joint: 9, station: store.geometry.jointStation[9] });
  });
  await page.waitForTimeout(20_000);
  await shot("dashboard_place");
  await stop("node");
  // A rig of a log: its WITS line, the bridge that reads it, and the twin. The log is steady, so that its torque can be
  // compared; what its sensor shows is off by a third after two minutes.
  const log = ["t,rpm,wob,torque"];
  for (let second = 0; second < 400; second += 1) {
    const torque = (second < 120 ? 33 : 44) + 6 * Math.sin(2.4 * second);
    log.push(`${second},40,10,${(torque / 1000).toFixed(4)}`);
  }
  writeFileSync(join(work, "rig.csv"), log.join("\n"));
  writeFileSync(
    join(work, "mapping.yaml"),
    "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n" +
      "  weight_on_bit:\n    direct: {column: wob, unit: kN}\n  torque: {column: torque, unit: kN.m}\n",
  );
  start("node", "run", "--config", join(root, "config/rig.yaml"));
  start("rig", "rig", join(work, "rig.csv"), "--mapping", join(work, "mapping.yaml"), "--wits", "127.0.0.1:5555");
  start("bridge", "bridge", "wits", "--connect", "127.0.0.1:5555", "--confirm", "--state-dir", join(work, "state"));
  await until("the rig", 60, async () => ["NORMAL", "WATCH", "ACT SOON"].includes(await word()));
  await page.click("#tab-rig");
  await page.waitForTimeout(190_000);
  await shot("dashboard_rig");
} catch (error) {
  failed = error;
} finally {
  await browser.close();
  await stopAll();
}
if (failed) {
  console.log(`pictures: ${failed.stack ?? failed}`);
  lastWords();
}
clean();
process.exit(failed ? 1 : 0);
