// Programs that a browser's test runs against: a twin, a rig that plays a log into it, the server.
import { spawn } from "node:child_process";
import { connect, createServer } from "node:net";
import { mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../../../..");

/** A word behind `--name` on the command line. */
export const option = (name, otherwise) => {
  const at = process.argv.indexOf(`--${name}`);
  return at < 0 ? otherwise : process.argv[at + 1];
};
const flexdrill = option("flexdrill", join(root, "target/release/flexdrill"));
/** A folder for what is written. */
export const work = mkdtempSync(join(tmpdir(), "flexdrill-page-"));
export const PORT = 8080;
const environment = { ...process.env, ROS_LOCALHOST_ONLY: "1", XDG_STATE_HOME: join(work, "state") };

const running = new Map();

/** Starts flexdrill under a name; its words go to a file of that name. */
export function start(name, ...words) {
  const log = openSync(join(work, `${name}.log`), "a");
  const child = spawn(flexdrill, words, { stdio: ["ignore", log, log], env: environment, cwd: root });
  running.set(name, child);
  return child;
}

/** Ends a program and waits for it. */
export async function stop(name, signal = "SIGTERM") {
  const child = running.get(name);
  running.delete(name);
  if (!child || child.exitCode !== null || child.signalCode !== null) return;
  const ended = new Promise((resolve) => child.once("exit", resolve));
  child.kill(signal);
  const timer = setTimeout(() => child.kill("SIGKILL"), 20_000);
  await ended;
  clearTimeout(timer);
}

/** Waits until `what` gives something true; fails with `words` after `seconds`. */
export async function until(words, seconds, what) {
  const end = Date.now() + 1e3 * seconds;
  let last;
  for (;;) {
    try {
      last = await what();
      if (last) return last;
    } catch (error) {
      last = error;
    }
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${words} (last: ${last})`);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
}

/** The default tool, which forecasts. */
const config = join(work, "forecast.yaml");
writeFileSync(
  config,
  `${readFileSync(join(root, "config/default.yaml"), "utf8")}\nlook_ahead: {forecast: true, forecast_members: 2}\n`,
);
export const node = (...more) => start("node", "run", "--config", config, ...more);
export const rig = () =>
  start(
    "rig",
    "rig",
    join(root, "config/field_logs/demo.csv"),
    "--loop",
    "--from",
    "45",
    "--mapping",
    join(root, "config/field_logs/rig_1hz.yaml"),
  );
export const server = (...more) => start("server", "dashboard", "--listen", `127.0.0.1:${PORT}`, ...more);

/** Where the server is reached over a slow line. */
export const SLOW_PORT = 8081;

/**
 * A line to the server that carries so many bytes of live data a second, and all else as it comes: a page behind it is one
 * that does not keep up.
 */
export function slowLine(rate) {
  const line = createServer((viewer) => {
    const server = connect(PORT, "127.0.0.1");
    for (const [one, other] of [
      [viewer, server],
      [server, viewer],
    ]) {
      one.on("error", () => other.destroy());
      one.on("close", () => other.destroy());
    }
    let live = false;
    viewer.on("data", (bytes) => {
      live ||= bytes.subarray(0, 9).toString() === "GET /live";
      server.write(bytes);
    });
    server.on("data", (bytes) => {
      viewer.write(bytes);
      if (!live) return;
      server.pause();
      setTimeout(() => server.resume(), (1e3 * bytes.length) / rate);
    });
  });
  line.listen(SLOW_PORT, "127.0.0.1");
  return line;
}

/** Ends all of them. */
export async function stopAll() {
  for (const name of [...running.keys()]) await stop(name);
}

/** Prints what they said last. */
export function lastWords() {
  for (const name of ["server", "node", "rig"]) {
    try {
      const words = readFileSync(join(work, `${name}.log`), "utf8")
        .split("\n")
        .slice(-12)
        .join("\n");
      console.log(`--- last words of ${name}:\n${words}`);
    } catch {
      // It was never started.
    }
  }
}

/** Removes what was written. */
export const clean = () => rmSync(work, { recursive: true, force: true });
