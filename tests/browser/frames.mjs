/**
 * Checks what the page of the playground repeats from frame to frame: `node frames.mjs FOLDER`. The folder has the generated plan `boxes`,
 * which draws boxes of objects. Requests to the server are answered here, and counted.
 */
import { readFileSync } from "node:fs";
import { register } from "node:module";
import { join } from "node:path";
import { strict as assert } from "node:assert";

import { adapter as open } from "./adapter.mjs";

// The server of the page has the host in the folder `webgpu`.
const host = new URL("../../backends/run/webgpu/", import.meta.url);
const hook = `export const resolve = (name, context, next) =>
    next(name.startsWith("./webgpu/") ? "${host}" + name.slice("./webgpu/".length) : name, context);`;
register(`data:text/javascript,${encodeURIComponent(hook)}`);

const folder = join(process.argv[2], "boxes");
const read = (path) => readFileSync(join(folder, path), "utf8");
const manifest = JSON.parse(read("manifest.json"));
const paths = [...new Set(manifest.files.map(({ path }) => path))];

/** Returns the answer of `/api/geometry`: two squares, each an object of six vertices. */
function geometry() {
    const corners = [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]];
    const vertices = [0, 0.5].flatMap((z) => corners.flatMap(([x, y]) => [x, y, z, 1, 0, 0, 0.5]));
    const normals = new Array(12).fill([0, 0, 1]).flat();
    const json = JSON.stringify({ stride: 7, color: 3, vertices: 12, indices: 12, objects: [[0, 6], [6, 12]] });
    const header = Buffer.from(json.padEnd(4 * Math.ceil(json.length / 4)));
    const indices = Uint32Array.from(new Array(12).keys());
    const parts = [Uint32Array.of(header.length), header, Float32Array.from([...vertices, ...normals]), indices];
    return Buffer.concat(parts.map((part) => Buffer.from(part.buffer, part.byteOffset, part.byteLength)));
}

/** The descriptions for which passes were requested. */
const generated = [];
globalThis.fetch = async (path, { body }) => {
    if (path === "/api/geometry") return new Response(geometry());
    assert.equal(path, "/api/generate");
    const { text } = JSON.parse(body);
    generated.push(text);
    if (text === "rejected") return new Response(JSON.stringify({ error: "it is rejected" }), { status: 422 });
    if (text === "offline") return new Response(JSON.stringify({ error: "it is offline" }), { status: 500 });
    const files = paths.map((path) => ({ path, text: text === "broken" ? "fn broken(" : read(path) }));
    return new Response(JSON.stringify({ manifest, files }));
};

// What a browser has.
globalThis.ImageData = class {
    constructor(width, height) {
        Object.assign(this, { width, height, data: new Uint8ClampedArray(4 * width * height) });
    }
};
const adapter = await open();
const labels = [];
const gpu = {
    requestAdapter: async () => ({
        limits: adapter.limits,
        features: adapter.features,
        async requestDevice(descriptor) {
            const device = await adapter.requestDevice(descriptor);
            const { createBuffer } = device;
            device.createBuffer = (descriptor) => {
                labels.push(descriptor.label);
                return createBuffer.call(device, descriptor);
            };
            return device;
        },
    }),
};
Object.defineProperty(globalThis, "navigator", { value: { gpu }, configurable: true });
const { WebGpuFrames } = await import("../../src/cli/playground/page/webgpu_frames.mjs");

const frames = await WebGpuFrames.open();
const draw = (text, azimuth, more) => {
    const camera = { azimuth, elevation: 20, zoom: 1 };
    return frames.draw({ text, scene: "squares", size: [16, 12], k: null, uniforms: {}, camera, ...more });
};
const taken = () => generated.splice(0);

// Boxes are copied to the device once: vertices and indices.
for (const azimuth of [0, 30, 60]) {
    const { image } = await draw("peeled", azimuth);
    const colours = new Set(new Uint32Array(image.data.buffer));
    assert(colours.size > 1, "nothing is drawn");
}
assert.equal(labels.filter((label) => label === "fragbuf boxes").length, 2);
assert.deepEqual(taken(), ["peeled"]);

// Passes that do not compile are compiled once for a description, a size and a k.
const fails = (pattern, ...request) => assert.rejects(draw(...request), pattern);
for (const azimuth of [0, 30, 60]) await fails(/WebGPU rejects/, "broken", azimuth);
assert.deepEqual(taken(), ["broken"]);
await fails(/WebGPU rejects/, "broken", 0, { size: [8, 8] });
assert.deepEqual(taken(), ["broken"]);
// The same for an image that is too large, with a buffer and without one.
await draw("peeled", 0);
for (const azimuth of [0, 30, 60]) await fails(/WebGPU rejects the image/, "peeled", azimuth, { size: [99999, 2] });
assert.deepEqual(taken(), ["peeled"]);
await draw("peeled", 0);
assert.deepEqual(taken(), ["peeled"]);
// A description without passes has none for any size. A server that fails is asked again.
for (const size of [[16, 12], [8, 8]]) await fails(/it is rejected/, "rejected", 0, { size });
for (const azimuth of [0, 30]) await fails(/it is offline/, "offline", azimuth);
assert.deepEqual(taken(), ["rejected", "offline", "offline"]);

console.log("the frames of the page are right");
process.exit(0);
