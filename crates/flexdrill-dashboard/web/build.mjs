// Builds the page: `node build.mjs` writes dist/, `--check` holds dist/ to what would be written, `--tests` bundles the
// unit tests into .test/.
import { build } from "esbuild";
import { mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync } from "node:zlib";

const root = dirname(fileURLToPath(import.meta.url));
const target = ["chrome109", "firefox115", "safari16.4"];

async function files() {
  // The licence of what is bundled asks to go with it.
  const licence = await readFile(join(root, "node_modules/uplot/LICENSE"), "utf8");
  const bundle = await build({
    absWorkingDir: root,
    entryPoints: { page: "src/main.ts" },
    bundle: true,
    minify: true,
    format: "iife",
    target,
    charset: "utf8",
    footer: { js: `/* With uPlot (https://github.com/leeoniya/uPlot):\n${licence.trim()}\n*/` },
    outdir: "dist",
    write: false,
  });
  const outputs = new Map(
    bundle.outputFiles.map((file) => [file.path.slice(file.path.lastIndexOf("/") + 1), file.text]),
  );
  outputs.set("index.html", await readFile(join(root, "src/index.html"), "utf8"));
  return outputs;
}

async function check(outputs) {
  const old = [];
  for (const [name, text] of outputs) {
    const there = await readFile(join(root, "dist", name), "utf8").catch(() => "");
    if (there !== text) old.push(name);
  }
  if (old.length > 0) {
    console.error(
      `dist/ is old (${old.join(", ")}): run \`npm ci && npm run build\` in crates/flexdrill-dashboard/web`,
    );
    process.exit(1);
  }
  console.log(`dist/ is what the sources give: ${[...outputs.keys()].join(", ")}`);
}

async function write(outputs) {
  await mkdir(join(root, "dist"), { recursive: true });
  let all = 0;
  for (const [name, text] of outputs) {
    await writeFile(join(root, "dist", name), text);
    const compressed = brotliCompressSync(Buffer.from(text)).length;
    all += compressed;
    console.log(`dist/${name}: ${Buffer.byteLength(text)} bytes, ${compressed} with brotli`);
  }
  console.log(`all: ${all} bytes with brotli`);
}

async function tests() {
  await rm(join(root, ".test"), { recursive: true, force: true });
  const names = (await readdir(join(root, "test"))).filter((name) => name.endsWith(".test.ts"));
  await build({
    absWorkingDir: root,
    entryPoints: names.map((name) => `test/${name}`),
    bundle: true,
    platform: "node",
    format: "esm",
    outdir: ".test",
    outExtension: { ".js": ".mjs" },
  });
}

if (process.argv.includes("--tests")) await tests();
else if (process.argv.includes("--check")) await check(await files());
else await write(await files());
