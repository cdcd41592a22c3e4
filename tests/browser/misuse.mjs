/**
 * Uses the WebGPU host wrongly, and checks that each mistake is an error that says what to do: `node misuse.mjs FOLDER`. The folder has
 * generated plans: `list`, `regions`, `uniforms`, `external`, `boxes`, `module`, and `glsl` without portable WGSL.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { strict as assert } from "node:assert";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";

import { FragmentBuffer, requirements } from "../../backends/run/webgpu/fragbuf.mjs";
import { adapter as open } from "./adapter.mjs";

let unhandled = [];
process.on("unhandledRejection", (error) => unhandled.push(error));

const folder = process.argv[2];
const read = (path) => readFileSync(join(folder, path), "utf8");
const manifest = (plan) => JSON.parse(read(`${plan}/manifest.json`));
const files = (plan) => (path) => read(`${plan}/${path}`);

const adapter = await open();
const device = await adapter.requestDevice();
const uncaptured = [];
device.addEventListener("uncapturederror", ({ error }) => uncaptured.push(error.message));

const size = [8, 6];
const options = { size, format: "rgba8unorm", onLoss: () => {} };
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const texture = (size, format, usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.TEXTURE_BINDING) =>
    device.createTexture({ size, format, usage });
const target = texture(size, "rgba8unorm");
// Two triangles over the whole frame: position and colour.
const corners = [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]];
const vertices = new Float32Array(corners.flatMap(([x, y]) => [x, y, 0.5, 1, 0, 0, 0.5]));
const mesh = device.createBuffer({ size: vertices.byteLength, usage: GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST });
device.queue.writeBuffer(mesh, 0, vertices);
const draw = (pass) => {
    pass.setVertexBuffer(0, mesh);
    pass.draw(6);
};
const call = { target, viewProjection: identity, draw };
const create = (plan, more = {}, file = files(plan)) => FragmentBuffer.create(device, manifest(plan), file, { ...options, ...more });

/** Waits for one turn of the event loop: promises that are settled have run their reactions. */
const turn = () => new Promise((done) => setImmediate(done));

let count = 0;
/** Checks that a call fails with a message that has all of these parts. */
async function fails(run, ...parts) {
    count++;
    let message;
    try {
        await run();
    } catch (error) {
        assert(error instanceof Error);
        message = error.message;
    }
    assert(message !== undefined, `nothing fails: ${run}`);
    for (const part of parts) assert(message.includes(part), `no \`${part}\` in: ${message}`);
}

// Manifests and files.
const changed = (change) => FragmentBuffer.create(device, { ...manifest("list"), ...change }, files("list"), options);
await fails(() => changed({ schema: "fragbuf-manifest/0" }), "fragbuf-manifest/0", "of one version");
await fails(() => FragmentBuffer.create(device, read("list/manifest.json"), files("list"), options), "parsed JSON");
await fails(() => FragmentBuffer.create(device, undefined, files("list"), options), "parsed JSON");
await fails(() => create("glsl"), "--target wgsl");
await fails(() => changed({ files: [], unsupported: { wgsl: "it needs 64-bit atomics" } }), "does not run on WebGPU: it needs 64-bit");
await fails(() => changed({ steps: [{ do: "sort" }] }).then((buffer) => buffer.render(call)), "`sort`", "of its version");
await fails(() => create("list", {}, () => Promise.reject(new Error("404"))), ".wgsl` was not loaded (404)", "beside manifest.json");
await fails(() => create("list", {}, () => undefined), "returned undefined", "return the text");
await fails(() => create("list", {}, () => "fn broken("), "WebGPU rejects", ".wgsl", "1:11");
await fails(() => create("list", {}, () => "@vertex fn other() -> @builtin(position) vec4f { return vec4f(); }"), "the pipeline of the pass");
await fails(() => create("module"), "module form", "`material`");

// Arguments of `create`.
await fails(() => FragmentBuffer.create({}, manifest("list"), files("list"), options), "no GPUDevice");
await fails(() => FragmentBuffer.create(device, manifest("list"), "list/", options), "`loadFile` is no function");
await fails(() => FragmentBuffer.create(device, manifest("list"), files("list")), "`format` is missing");
for (const wrong of [undefined, [0, 4], [4.5, 4], [4], "8x6", { width: 4, height: 4 }]) await fails(() => create("list", { size: wrong }), "size: [width, height]");
await fails(() => create("list", { readback: "never" }), "all, lag, loops, none");
await fails(() => create("list", { perPixel: 0 }), "`perPixel`");
await fails(() => create("list", { rows: 0 }), "`rows`");
await fails(() => create("list", { perPixels: 1 }), "no option `perPixels`", "perPixel");
await fails(() => create("list", { format: "r32uint" }), "the pipeline of the pass `resolve`", "not blendable");
await fails(() => create("list", { symbols: { fragment: 5 } }), "no symbol `fragment`", "`fragments`");
await fails(() => create("uniforms", { symbols: { k: 99 } }), "`k` is 99", "from 1 to 8");
await fails(() => create("list", { symbols: { fragments: 2 ** 31 } }), "links", "`rows`");
await fails(() => create("list", { memory: 100 }), "budget `memory` is 100");
await fails(() => create("list", { size: [9000, 2] }), "maxTextureDimension2D", "9000", "requirements");

// What adapters lack.
const poor = (limits, features = []) => ({ limits: { ...adapter.limits, ...limits }, features: new Set(features) });
const all = Object.fromEntries(Object.keys(Object.getPrototypeOf(adapter.limits)).map((name) => [name, adapter.limits[name]]));
const asked = (plan, limits, more = {}) => requirements(manifest(plan), poor({ ...all, ...limits }), { size, ...more });
await fails(() => asked("list", { maxStorageBuffersPerShaderStage: 1, maxBindGroups: 0 }), "maxStorageBuffersPerShaderStage", "has 1", "maxBindGroups");
await fails(() => asked("list", {}, { format: "rgba32float" }), "the feature `float32-blendable` is missing");
const request = asked("list", {}, { format: "rgba16float", size: [4096, 4096] });
assert.deepEqual(request.requiredFeatures, []);
assert.equal(request.requiredLimits.maxStorageBufferBindingSize, Math.min(all.maxStorageBufferBindingSize, 4096 * 4096 * 8 * 8));

// Arguments of `render`.
const list = await create("list");
await fails(() => list.render(), "`draw` is no function");
await fails(() => list.render({ ...call, draw: undefined }), "`draw` is no function");
await fails(() => list.render({ ...call, draw: async () => {} }), "`draw` is asynchronous");
await fails(() => list.render({ ...call, uniform: {} }), "no argument of a frame `uniform`", "uniforms");
for (const clear of ["white", [0, 0, 0], { r: 0, g: 0, b: 0 }, null]) await fails(() => list.render({ ...call, clear }), "`clear` is", "four numbers");
await fails(() => list.render({ ...call, target: undefined }), "`target` is missing");
await fails(() => list.render({ ...call, target: texture([4, 4], "rgba8unorm") }), "`target` is 4 × 4", "`resize`");
await fails(() => list.render({ ...call, target: texture(size, "rgba16float") }), "`rgba16float`");
await fails(() => list.render({ ...call, viewProjection: identity.slice(1) }), "16 numbers", "identity");
await fails(() => list.render({ ...call, viewProjection: identity.map(() => NaN) }), "16 numbers");
await fails(() => list.render({ ...call, uniforms: { time: 1 } }), "no uniform `time`", "none");
await fails(() => list.render({ ...call, textures: { opaque: target } }), "no external texture `opaque`");
await fails(() => list.render({ ...call, symbols: { k: 0 } }), "`k` is 0");
await fails(() => list.render({ ...call, draw: () => { throw new Error("mesh not loaded"); } }), "mesh not loaded");
await fails(() => list.render({ ...call, draw: (pass) => pass.draw(6) }), "WebGPU rejects the frame");
await fails(() => list.resize([0, 1]), "size: [width, height]");
await fails(() => list.setSymbols({ fragments: -1 }), "`fragments` is -1");
await fails(() => list.encode(device.createCommandEncoder(), call), "`readback: \"none\"`");

// Objects: without queries of boxes, any number of them draws everything.
const boxes = await create("boxes");
const many = Array.from({ length: 5000 }, () => ({ least: [-1, -1, 0], greatest: [1, 1, 1] }));
await fails(() => boxes.render({ ...call, objects: many }), "more than 4096 queries", "group");
await fails(() => boxes.render({ ...call, objects: [{ min: [0, 0, 0], max: [1, 1, 1] }] }), "least", "greatest");
await list.render({ ...call, objects: many, draw: (pass, { objects }) => { assert.equal(objects, null); draw(pass); } });

// Calls while another one waits.
const first = list.render(call);
await fails(() => list.render(call), "a frame is still being drawn", "await `render`");
await fails(() => list.resize([4, 4]), "await `render`");
await fails(() => list.setSymbols({ fragments: 9 }), "await `render`");
await first;
const resized = list.resize([4, 4]);
await fails(() => list.render(call), "memory is still being allocated", "await `resize`");
await fails(() => list.resize([16, 12]), "await `resize`");
await fails(() => list.setSymbols({ fragments: 9 }), "await `resize`");
await resized;
await list.render({ ...call, target: texture([4, 4], "rgba8unorm") });
await list.resize(size);
const set = list.setSymbols({ fragments: 480 });
await fails(() => list.render(call), "await `setSymbols`");
await fails(() => list.resize([4, 4]), "await `setSymbols`");
await set;
assert.equal(list.symbol("fragments"), 480);
// After all these errors it works.
await list.render(call);
assert.deepEqual((await list.counters()).lost, 0);

// `texture` has another name in the text, where languages reserve it.
const uniforms = await create("uniforms");
const values = { cut: 0.5, eye: [0, 0, 1], steps: 3, offset: -1, texture: [1, 1], tint: [1, 1, 1, 1] };
await fails(() => uniforms.render({ ...call, uniforms: { ...values, tint: undefined } }), "the uniform `tint`", "4 numbers");
await fails(() => uniforms.render({ ...call, uniforms: { ...values, eye: [1, 2] } }), "3 numbers", "vec3");
await fails(() => uniforms.render({ ...call, uniforms: { ...values, cut: "0.5" } }), "a number");
const { tint, ...others } = values;
await fails(async () => (await create("uniforms")).render({ ...call, uniforms: others }), "`tint` has no value", "vec4");

const external = await create("external");
await fails(() => external.render(call), "`opaque`", "textures: { opaque");
await fails(() => external.render({ ...call, textures: { opaque: texture([4, 4], "depth32float") } }), "must be 8 × 6");
await fails(() => external.render({ ...call, textures: { opaque: texture(size, "depth16unorm") } }), "of `depth32float`");

// Losses are reported.
const reports = [];
const small = await create("list", { symbols: { fragments: 5 }, onLoss: (counters) => reports.push(counters) });
await small.render(call);
assert.equal((await small.counters()).lost, 8 * 6 - 5);
await turn();
assert.equal(reports.length, 1);
assert.equal(reports[0].counts.pool_exhausted, 8 * 6 - 5);
const warnings = [];
console.warn = (...parts) => warnings.push(parts.join(" "));
const quiet = await create("list", { symbols: { fragments: 5 }, onLoss: undefined });
for (let frame = 0; frame < 3; frame++) {
    await quiet.render(call);
    // The counters that the frame itself reads arrive before these.
    await quiet.counters();
    await turn();
}
assert.equal(warnings.length, 1);
assert.match(warnings[0], /43 fragments are missing/);
// More memory mends it.
await quiet.setSymbols({ fragments: 48 });
await quiet.render(call);
assert.equal((await quiet.counters()).lost, 0);

// A host step that counts, without and with enough memory.
const regions = await create("regions");
await regions.render(call);
assert.equal(regions.symbol("fragments"), 48);
// Too little for the whole frame is enough for slices, and less is an error.
const sliced = await create("regions", { memory: 600 });
assert.equal(sliced.slices, 1);
await sliced.render(call);
assert.equal(sliced.slices, 2);
assert.equal((await sliced.counters()).lost, 0);
await fails(async () => (await create("regions", { memory: 150 })).render(call), "budget `memory` is 150", "1 rows");

// A material of the caller that stores fragments has the image of the program form.
const pixel = async (texture) => {
    const staging = device.createBuffer({ size: 256, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture, origin: [3, 2] }, { buffer: staging }, [1, 1]);
    device.queue.submit([encoder.finish()]);
    await staging.mapAsync(GPUMapMode.READ);
    return [...new Uint8Array(staging.getMappedRange(0, 4))];
};
const copied = texture(size, "rgba8unorm", GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC);
await list.render({ ...call, target: copied, clear: [0, 0, 1, 1] });
assert.deepEqual(await pixel(copied), [128, 0, 127, 255]);
const uniform = device.createBuffer({ size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
device.queue.writeBuffer(uniform, 0, new Float32Array([0, 1, 0, 0.25]));
const tintLayout = device.createBindGroupLayout({ entries: [{ binding: 0, visibility: GPUShaderStage.FRAGMENT, buffer: {} }] });
const tintGroup = device.createBindGroup({ layout: tintLayout, entries: [{ binding: 0, resource: { buffer: uniform } }] });
const material = ({ code, entry }) => ({
    code: `${code}
        @group(1) @binding(0) var<uniform> tint: vec4f;
        @vertex fn corner(@location(0) position: vec3f) -> @builtin(position) vec4f { return vec4f(position, 1.0); }
        @fragment fn glass(@builtin(position) position: vec4f) { ${entry}(position.xy, Fragment(tint, position.z)); }`,
    vertex: "corner",
    fragment: "glass",
    vertexBuffers: [{ arrayStride: 28, attributes: [{ shaderLocation: 0, offset: 0, format: "float32x3" }] }],
    bindGroupLayouts: [undefined, tintLayout],
});
const own = await create("module", { material });
const drawTinted = (pass) => {
    pass.setBindGroup(1, tintGroup);
    draw(pass);
};
await own.render({ ...call, target: copied, clear: [0, 0, 1, 1], viewProjection: undefined, draw: drawTinted });
assert.deepEqual(await pixel(copied), [0, 64, 191, 255]);
await fails(() => create("module", { material: ({ code }) => ({ code, vertex: "none", fragment: "none", vertexBuffers: [] }) }), "the pipeline of the pass");

// A fragment buffer that cannot be created frees what it has created.
const owned = new Set();
const timed = await (await open()).requestDevice({ requiredFeatures: ["timestamp-query"] });
for (const name of ["createBuffer", "createTexture", "createQuerySet"]) {
    const created = timed[name];
    timed[name] = (descriptor) => {
        const object = created.call(timed, descriptor);
        const { destroy } = object;
        object.destroy = () => {
            owned.delete(descriptor.label);
            destroy.call(object);
        };
        owned.add(descriptor.label);
        return object;
    };
}
const createTimed = (more) => FragmentBuffer.create(timed, manifest("list"), files("list"), { ...options, ...more, times: true });
await fails(() => createTimed({ memory: 100 }), "budget `memory` is 100");
assert.deepEqual([...owned], []);
const whole = await createTimed();
assert(owned.size > 3, `the fragment buffer has ${[...owned]}`);
whole.destroy();
assert.deepEqual([...owned], []);

// The device keeps no fragment buffer alive.
setFlagsFromString("--expose-gc");
const collect = runInNewContext("gc");
const dropped = await (async () => new WeakRef(await create("list")))();
for (let attempt = 0; attempt < 20 && dropped.deref(); attempt++) {
    await turn();
    collect();
}
assert.equal(dropped.deref(), undefined);

// The end of a fragment buffer, and of its device.
list.destroy();
await fails(() => list.render(call), "it was destroyed", "Create another");
await fails(() => list.counters(), "it was destroyed");
await fails(() => list.resize([4, 4]), "it was destroyed");
await regions.render(call);
const during = regions.render({ ...call, draw: (pass) => { draw(pass); device.destroy(); } });
await fails(() => during, "the device was lost", "Create another");
await fails(() => regions.render(call), "the device was lost");
await fails(() => uniforms.counters(), "the device was lost");
await fails(() => create("list"), "lost");

await new Promise((done) => setTimeout(done, 50));
assert.deepEqual(unhandled, []);
assert.deepEqual(uncaptured, []);
console.log(`${count} mistakes`);
process.exit(0);
