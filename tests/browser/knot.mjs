// Draws the knot of `examples/web` in Node: `node knot.mjs PASSES FILE` writes the pixels of the guide's picture, four bytes each.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { open } from "../../examples/web/knot.mjs";
import { adapter } from "./adapter.mjs";

const [passes, file] = process.argv.slice(2);
const size = [640, 480];
const load = async (path) => readFileSync(join(passes, path), "utf8");
const { device, buffer, draw } = await open(await adapter(), load, size, "rgba8unorm");
const target = device.createTexture({ size, format: "rgba8unorm", usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
await draw(target, 0.4);
const { lost } = await buffer.counters();
const bytesPerRow = 4 * size[0];
const staging = device.createBuffer({ size: bytesPerRow * size[1], usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
const encoder = device.createCommandEncoder();
encoder.copyTextureToBuffer({ texture: target }, { buffer: staging, bytesPerRow }, size);
device.queue.submit([encoder.finish()]);
await staging.mapAsync(GPUMapMode.READ);
writeFileSync(file, Buffer.from(staging.getMappedRange()));
if (lost > 0) throw new Error(`${lost} fragments are lost`);
process.exit(0);
