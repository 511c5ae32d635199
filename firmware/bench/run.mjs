// MicroPython with the files of firmware/pico2 and a `machine` that is not there. One JSON order a
// line comes in, one JSON answer a line goes out (see bench.py).
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { createRequire } from "node:module";

const here = dirname(fileURLToPath(import.meta.url));
const require = createRequire(join(process.argv[2] ?? here, "package.json"));
const name = "@micropython/micropython-webassembly-pyscript/micropython.mjs";
const { loadMicroPython } = await import(require.resolve(name));
const micropython = await loadMicroPython({ stdout: (line) => process.stderr.write(`${line}\n`) });
micropython.FS.mkdir("/lib");
for (const folder of [join(here, "..", "pico2"), here]) {
  for (const file of readdirSync(folder).filter((file) => file.endsWith(".py"))) {
    micropython.FS.writeFile(`/lib/${file}`, readFileSync(join(folder, file)));
  }
}
const bench = micropython.pyimport("bench");
process.stdout.write(`"ready"\n`);
for await (const line of createInterface({ input: process.stdin })) {
  process.stdout.write(`${bench.play(line)}\n`);
}
