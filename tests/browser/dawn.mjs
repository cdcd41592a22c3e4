// Draws the jobs of a folder with Dawn, Chromium's WebGPU, in Node: `node dawn.mjs FOLDER` writes FOLDER/results.json.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { adapter } from "./adapter.mjs";
import { drawAll } from "./draw.mjs";

const folder = process.argv[2];
const load = (path, kind) => {
    const bytes = readFileSync(join(folder, path));
    return kind === "text" ? bytes.toString() : bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const jobs = JSON.parse(load("jobs.json", "text"));
writeFileSync(join(folder, "results.json"), JSON.stringify(await drawAll(await adapter(), jobs, load)));
process.exit(0);
